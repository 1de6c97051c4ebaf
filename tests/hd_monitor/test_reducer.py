"""Geometry: orders, line frequencies and travel, against the paper and by counting."""

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.errors import GeometryError, ParameterError
from hd_monitor.reducer import LinePair, Mount, Reducer

MOUNTS = st.sampled_from(list(Mount))
REDUCERS = st.builds(
    lambda z1, half, mount: Reducer(flexspline_teeth=z1, circular_spline_teeth=z1 + 2 * half, mount=mount),
    st.integers(20, 1000),
    st.integers(1, 5),
    MOUNTS,
)


def test_the_papers_reducer():
    rig = Reducer(flexspline_teeth=160, circular_spline_teeth=162)
    assert rig.mount is Mount.CIRCULAR_SPLINE_FIXED
    assert rig.reduction == 80.0
    assert rig.circular_spline_order == 2.0
    assert rig.flexspline_order == 2.025
    assert rig.output_orders == LinePair(160.0, 162.0)


def test_the_papers_frequencies():
    """Section 3.2: 25 and 25.3125 Hz at 750 rpm."""
    assert Reducer().line_frequencies(750.0) == (25.0, 25.3125)


@pytest.mark.parametrize("k", [1, 2, 3, 4])
@pytest.mark.parametrize("speed", [200.0, 850.0, 3000.0])
def test_line_separation_is_eq_5(speed, k):
    expected = k * speed / 30.0 * (162.0 / 160.0 - 1.0)
    assert Reducer().line_separation(speed, k) == pytest.approx(expected, rel=1e-12)


def test_a_joint_with_the_flexspline_fixed():
    """A UR10e joint: ratio 101 with 200 and 202 teeth; its flexspline's line is at order 2."""
    joint = Reducer(flexspline_teeth=200, circular_spline_teeth=202, mount=Mount.FLEXSPLINE_FIXED)
    assert joint.reduction == 101.0
    assert joint.flexspline_order == 2.0
    assert joint.circular_spline_order == pytest.approx(2.0 * 200 / 202)
    assert joint.output_orders == (200.0, 202.0)


@given(REDUCERS)
def test_the_output_turns_by_the_difference_of_the_teeth(reducer):
    """Counting teeth: a turn of the wave generator moves the splines by the tooth difference against each other."""
    z1, z2 = reducer.flexspline_teeth, reducer.circular_spline_teeth
    turned = z1 if reducer.mount is Mount.CIRCULAR_SPLINE_FIXED else z2
    assert Fraction(reducer.reduction).limit_denominator(20) == Fraction(turned, z2 - z1)


@given(REDUCERS)
def test_each_spline_meets_the_wave_generators_lobes_relative_to_itself(reducer):
    """A spline's defect passes a lobe twice a revolution of the wave generator relative to that spline.

    This is how both mounts get their orders: a fixed spline sees the wave generator turn once per revolution, and the
    output spline one output revolution more or less (it turns backwards when the circular spline is fixed).
    """
    ratio = 1.0 / reducer.reduction
    if reducer.mount is Mount.CIRCULAR_SPLINE_FIXED:
        circular_spline, flexspline = 2.0, 2.0 * (1.0 + ratio)
    else:
        circular_spline, flexspline = 2.0 * (1.0 - ratio), 2.0
    assert reducer.circular_spline_order == pytest.approx(circular_spline, rel=1e-12)
    assert reducer.flexspline_order == pytest.approx(flexspline, rel=1e-12)


@given(REDUCERS, st.integers(1, 8), st.floats(1.0, 5000.0))
def test_the_pair_is_two_cycles_per_output_revolution_apart(reducer, k, speed):
    output_revolutions_per_second = speed / 60.0 / reducer.reduction
    separation = reducer.line_separation(speed, k)
    assert separation == pytest.approx(2 * k * output_revolutions_per_second, rel=1e-6)
    lines = reducer.line_frequencies(speed, k)
    assert lines.circular_spline < lines.flexspline


@given(REDUCERS, st.integers(1, 8), st.floats(-5000.0, 5000.0))
def test_harmonics_are_multiples_and_direction_does_not_matter(reducer, k, speed):
    first, kth = reducer.line_frequencies(speed), reducer.line_frequencies(-speed, k)
    assert kth.circular_spline == pytest.approx(k * first.circular_spline, rel=1e-12)
    assert kth.flexspline == pytest.approx(k * first.flexspline, rel=1e-12)


@given(REDUCERS, st.integers(1, 8), st.floats(10.0, 3000.0))
def test_the_travel_that_separates_a_pair_takes_one_beat(reducer, k, speed):
    """A rectangular window resolves 1/T: after that travel the beat of the pair has gone round once."""
    seconds = reducer.travel_to_separate(k, window="boxcar") * reducer.reduction / (speed * math.tau / 60.0)
    assert seconds * reducer.line_separation(speed, k) == pytest.approx(1.0, rel=1e-6)
    assert reducer.travel_to_separate(k) == pytest.approx(2.0 * reducer.travel_to_separate(k, window="boxcar"))


def test_travel_in_degrees():
    """180°/k, and with a Hann window twice that."""
    assert math.degrees(Reducer().travel_to_separate(1, window="boxcar")) == pytest.approx(180.0)
    assert math.degrees(Reducer().travel_to_separate(3)) == pytest.approx(120.0)


def test_whole_numbers_of_another_type_are_taken():
    assert Reducer(flexspline_teeth=160.0, circular_spline_teeth=162.0) == Reducer()  # type: ignore[arg-type]


def test_a_mount_by_its_word():
    assert Reducer(mount="flexspline_fixed").mount is Mount.FLEXSPLINE_FIXED  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"flexspline_teeth": 162, "circular_spline_teeth": 160}, "swapped"),
        ({"flexspline_teeth": 160, "circular_spline_teeth": 160}, "not above"),
        ({"circular_spline_teeth": 163}, "odd"),
        ({"circular_spline_teeth": 300}, "which none survives"),
        ({"flexspline_teeth": 0, "circular_spline_teeth": 2}, "not a number of teeth"),
        ({"flexspline_teeth": -160}, "not a number of teeth"),
        ({"flexspline_teeth": 160.5}, "whole"),
        ({"flexspline_teeth": math.nan}, "whole"),
        ({"flexspline_teeth": math.inf}, "whole"),
        ({"flexspline_teeth": "many"}, "whole"),
        ({"flexspline_teeth": None}, "whole"),
        ({"flexspline_teeth": True}, "whole"),
        ({"mount": "upside_down"}, "choose one of: circular_spline_fixed, flexspline_fixed"),
    ],
)
def test_impossible_geometry_is_refused_with_the_reason(changes, match):
    with pytest.raises(GeometryError, match=match):
        Reducer(**changes)


@pytest.mark.parametrize("k", [0, -1])
def test_pairs_are_counted_from_1(k):
    with pytest.raises(ParameterError, match="from 1"):
        Reducer().line_frequencies(750.0, k)
    with pytest.raises(ParameterError, match="from 1"):
        Reducer().travel_to_separate(k)


def test_an_unknown_window_is_refused():
    with pytest.raises(ParameterError, match="'hann' or 'boxcar'"):
        Reducer().travel_to_separate(window="flattop")

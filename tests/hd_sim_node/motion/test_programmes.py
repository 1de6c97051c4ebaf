"""The programmes to choose from do what their parameters say."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.errors import ParameterError
from hd_monitor.reducer import Mount, Reducer
from hd_sim_node.motion.programme import RPM
from hd_sim_node.motion.programmes import PROGRAMMES, build_programme
from hd_sim_node.settings import RigSettings

REDUCER = Reducer()


def build(name, cycles=0, reducer=REDUCER, **values):
    return build_programme(name, {f"{name}.{key}": value for key, value in values.items()}, reducer, cycles=cycles)


def held(programme):
    """(speed, duration) of each piece without acceleration."""
    same = programme.speeds[1:] == programme.speeds[:-1]
    return list(zip(programme.speeds[1:][same].tolist(), np.diff(programme.times)[same].tolist(), strict=True))


@pytest.mark.parametrize("name", PROGRAMMES)
@pytest.mark.parametrize("cycles", [0, 1, 2])
def test_defaults_make_a_programme(name, cycles):
    programme = build(name, cycles)
    assert programme.cycle_duration > 0.0
    assert programme.speeds.any()


@pytest.mark.parametrize(("name", "kind"), PROGRAMMES.items())
def test_parameters_are_named_after_their_programme(name, kind):
    assert kind.parameters
    assert all(parameter.name.startswith(f"{name}.") for parameter in kind.parameters)
    assert kind.summary


def test_dwells_at_each_speed_of_the_papers_test():
    programme = build("dwell", cycles=1, time=2.0)
    assert [speed for speed, _ in held(programme)] == [float(rpm) for rpm in range(200, 3001, 100)]
    assert all(duration == pytest.approx(2.0) for _, duration in held(programme))


def test_dwells_are_joined_by_ramps_of_the_rate_given():
    programme = build("dwell", cycles=1, first=200.0, last=400.0, ramp_rate=50.0, time=1.0)
    assert programme.times.tolist() == [0.0, 1.0, 3.0, 4.0, 6.0, 7.0]
    assert programme.acceleration(2.0) == pytest.approx(50.0 * RPM)


def test_dwells_may_go_down_and_repeat():
    programme = build("dwell", first=400.0, last=200.0, ramp_rate=100.0, time=1.0)
    assert [speed for speed, _ in held(programme)] == [400.0, 300.0, 200.0]
    assert programme.times[-1] - programme.times[-2] == pytest.approx(2.0)  # back to 400


def test_a_step_that_does_not_fit_stops_before_the_last_speed():
    assert [speed for speed, _ in held(build("dwell", 1, first=100.0, last=350.0))] == [100.0, 200.0, 300.0]


def test_one_speed_may_be_dwelt_at_alone():
    assert [speed for speed, _ in held(build("dwell", 1, first=700.0, last=700.0))] == [700.0]


def test_fixed_holds_one_speed_without_end():
    programme = build("fixed", speed=-850.0)
    assert programme.duration == math.inf
    assert programme.angle(600.0) == pytest.approx(-850.0 * RPM * 600.0)


def test_fixed_speed_may_be_zero():
    assert build("fixed", speed=0.0).angle(100.0) == 0.0


def test_a_sweep_has_its_rate():
    programme = build("sweep", cycles=1, first=200.0, last=3000.0, rate=70.0)
    assert programme.duration == pytest.approx(40.0)
    assert programme.speed(10.0) == pytest.approx(900.0 * RPM)


def test_a_repeated_sweep_comes_back():
    programme = build("sweep", first=200.0, last=300.0, rate=50.0)
    assert programme.speeds.tolist() == [200.0, 300.0, 200.0]


def test_a_sweep_to_nowhere_is_refused():
    with pytest.raises(ParameterError, match="does not change the speed"):
        build("sweep", first=200.0, last=200.0)


@given(
    st.floats(1.0, 720.0),
    st.floats(50.0, 5000.0),
    st.floats(100.0, 50_000.0),
    st.floats(0.0, 2.0),
    st.sampled_from([REDUCER, Reducer(flexspline_teeth=200, circular_spline_teeth=202, mount=Mount.FLEXSPLINE_FIXED)]),
)
def test_strokes_cover_their_arc_and_come_back(angle, speed, acceleration, pause, reducer):
    programme = build("strokes", reducer=reducer, angle=angle, speed=speed, acceleration=acceleration, pause=pause)
    half = programme.cycle_duration / 2
    there = math.degrees(float(programme.angle(half)) / reducer.reduction)
    assert there == pytest.approx(angle, rel=1e-9)
    assert programme.angle(2 * half) == pytest.approx(0.0, abs=1e-6 * angle * reducer.reduction)
    assert np.abs(programme.speeds).max() <= speed * (1 + 1e-12)
    slopes = np.abs(np.diff(programme.speeds) / np.diff(programme.times))
    assert slopes.max() == pytest.approx(acceleration, rel=1e-6)
    t = np.linspace(0.0, 2 * half, 400)
    turned = np.degrees(programme.angle(t) / reducer.reduction)
    assert turned.min() > -1e-6 * angle
    assert turned.max() < angle * (1 + 1e-6)


def test_a_long_stroke_reaches_its_speed_and_rests_at_its_ends():
    programme = build("strokes", angle=360.0, speed=1200.0, acceleration=2400.0, pause=0.4)
    # 80 revolutions at 20 per second, of which the ramps of 0.5 s take ten in the time of twenty.
    assert held(programme) == [
        (1200.0, pytest.approx(3.5)),
        (0.0, pytest.approx(0.4)),
        (-1200.0, pytest.approx(3.5)),
        (0.0, pytest.approx(0.4)),
    ]


def test_a_short_stroke_brakes_before_its_speed():
    programme = build("strokes", angle=9.0, speed=3000.0, acceleration=600.0, pause=0.0)
    assert np.abs(programme.speeds).max() == pytest.approx(math.sqrt(60.0 * 600.0 * 2.0))
    assert not held(programme)


def test_a_profile_follows_its_corners():
    programme = build("profile", cycles=1, times=(0.0, 1.0, 4.0), speeds=(0.0, 500.0, 100.0))
    assert programme.speed(2.5) == pytest.approx(300.0 * RPM)


def test_a_profile_of_unlike_lists_is_refused():
    with pytest.raises(ParameterError, match="3 times and 2 speeds"):
        build("profile", times=(0.0, 1.0, 4.0), speeds=(0.0, 0.0))


def test_an_unknown_programme_is_refused_with_the_choice():
    with pytest.raises(ParameterError, match="dwell, fixed, sweep, strokes, profile"):
        RigSettings.from_mapping({"programme": "waltz"})

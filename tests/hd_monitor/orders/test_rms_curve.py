import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.orders.rms_curve import RmsAccumulator, SpeedBin, curve_since, pooled_curve, rms_growth


def test_a_sine_has_its_amplitude_over_the_root_of_two():
    accumulator = RmsAccumulator(100.0)
    accumulator.add(np.full(1000, 510.0), 3.0 * np.sin(2 * np.pi * np.arange(1000) / 50.0))
    (only,) = accumulator.curve()
    assert only.rpm == pytest.approx(510.0)
    assert only.rms == pytest.approx(3.0 / np.sqrt(2.0), rel=1e-12)
    assert only.samples == 1000


def test_bins_are_centred_on_multiples_of_the_width_and_rise():
    accumulator = RmsAccumulator(100.0)
    accumulator.add([3000.0, 249.0, 151.0, 260.0], [4.0, 1.0, 3.0, 2.0])
    bins = accumulator.curve()
    assert [(b.rpm, b.rms, b.samples) for b in bins] == [
        (200.0, pytest.approx(np.sqrt(5.0)), 2),
        (260.0, 2.0, 1),
        (3000.0, 4.0, 1),
    ]


def test_both_directions_share_a_bin():
    accumulator = RmsAccumulator(50.0)
    accumulator.add([-400.0, 400.0], [1.0, -1.0])
    assert accumulator.curve() == ((400.0, 1.0, 2),)


def test_nothing_but_nan_leaves_the_curve_empty():
    accumulator = RmsAccumulator(100.0)
    accumulator.add([], [])
    accumulator.add([np.nan, 100.0, np.inf], [1.0, np.nan, 1.0])
    assert accumulator.curve() == ()


@given(
    st.lists(
        st.tuples(st.floats(-4000, 4000), st.one_of(st.floats(-1e3, 1e3), st.just(float("nan")))),
        min_size=1,
        max_size=60,
    ),
    st.lists(st.integers(0, 60), max_size=5),
)
def test_does_not_depend_on_how_the_samples_are_chunked(samples, cuts):
    speed, value = (np.array(column) for column in zip(*samples, strict=True))
    whole, parts = RmsAccumulator(100.0), RmsAccumulator(100.0)
    whole.add(speed, value)
    for index in np.split(np.arange(speed.size), sorted(min(cut, speed.size) for cut in cuts)):
        parts.add(speed[index], value[index])
    expected = [(b.rpm, b.rms, b.samples) for b in whole.curve()]
    found = [(b.rpm, b.rms, b.samples) for b in parts.curve()]
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=1e-9, abs=1e-9)
    assert sum(b.samples for b in whole.curve()) == int(np.isfinite(value).sum())


def curve(*points):
    return tuple(SpeedBin(*point) for point in points)


def test_the_samples_since_an_earlier_state_and_those_before_make_the_whole():
    whole, rng = RmsAccumulator(100.0), np.random.default_rng(1)
    states: list[tuple[SpeedBin, ...]] = [()]
    for _ in range(3):
        whole.add(rng.uniform(300.0, 900.0, 50), rng.standard_normal(50))
        states.append(whole.curve())
    parts = [curve_since(now, before, 100.0) for before, now in itertools.pairwise(states)]
    assert [sum(b.samples for b in part) for part in parts] == [50, 50, 50]
    for one, other in zip(pooled_curve(parts, 100.0), whole.curve(), strict=True):
        assert one == pytest.approx(other, rel=1e-9)
    assert curve_since(states[1], states[1], 100.0) == ()


def test_a_curve_that_began_anew_counts_as_a_whole():
    long, fresh = curve((500.0, 1.0, 100)), curve((510.0, 2.0, 10), (800.0, 3.0, 5))
    assert curve_since(fresh, long, 100.0) == fresh
    assert curve_since(fresh, (*long, *fresh[1:]), 100.0) == fresh


def test_the_rms_is_compared_at_the_speeds_of_both():
    base = curve((500.0, 1.0, 100), (800.0, 4.0, 100))
    assert rms_growth(curve((490.0, 1.5, 10), (1200.0, 9.0, 10)), base, 100.0) == pytest.approx(0.5)
    assert rms_growth(base, base, 100.0) == 0.0
    assert np.isnan(rms_growth(curve((1200.0, 9.0, 10)), base, 100.0))
    assert np.isnan(rms_growth(base, (), 100.0))

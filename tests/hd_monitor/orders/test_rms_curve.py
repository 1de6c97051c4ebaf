import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.orders.rms_curve import RmsAccumulator


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

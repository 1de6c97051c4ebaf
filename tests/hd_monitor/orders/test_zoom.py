import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import get_window

from hd_monitor.errors import ParameterError
from hd_monitor.orders.zoom import Zoom, zoom_spectrum
from hd_monitor.reducer import LinePair, Reducer

PERIOD = 1e-3
RIG = Reducer(flexspline_teeth=160, circular_spline_teeth=162)


def sine(count, frequency, amplitude=1.0, phase=0.0):
    return amplitude * np.sin(math.tau * frequency * PERIOD * np.arange(count) + phase)


@given(
    st.integers(64, 700),
    st.integers(1, 4),
    st.integers(0, 200),
    st.integers(2, 50),
    st.integers(0, 2**32 - 1),
)
def test_equals_the_zero_padded_fourier_transform_on_its_grid(count, padding, start, bins, seed):
    samples = np.random.default_rng(seed).normal(size=count)
    padded = 1024 * padding
    start = min(start, padded // 2 - bins)
    step = 1.0 / (padded * PERIOD)
    zoom = Zoom(count, PERIOD, start * step, (start + bins - 1) * step, bins)
    weights = get_window("hann", count)
    weighted = weights * (samples - np.average(samples, weights=weights))
    expected = 2.0 / weights.sum() * np.abs(np.fft.rfft(weighted, padded))[start : start + bins]
    np.testing.assert_allclose(zoom(samples), expected, atol=1e-11)


@given(
    st.floats(20.0, 400.0), st.floats(0.01, 1e3), st.floats(0.0, math.tau), st.integers(2000, 6000), st.floats(-50, 50)
)
def test_a_sine_between_the_bins_of_the_fourier_transform_keeps_its_amplitude(frequency, amplitude, phase, count, mean):
    samples = sine(count, frequency, amplitude, phase) + mean
    zoomed = zoom_spectrum(samples, PERIOD, around=LinePair(frequency, frequency + 1.0), k=1)
    # What leaks over from the mirror image at -frequency falls with the third power of the cycles recorded (Hann), and
    # so does what is left of the mean.
    leak = 3.0 / (2.0 * frequency * count * PERIOD) ** 3 * 2
    assert zoomed.line_amplitudes.circular_spline == pytest.approx(amplitude, rel=leak + 1e-9)


@pytest.mark.parametrize("speed", [200.0, 750.0, 3000.0])
@pytest.mark.parametrize("k", [1, 2, 4])
def test_shows_the_pair_and_its_combination_lines_on_bins(speed, k):
    pair = RIG.line_frequencies(speed, k)
    separation = pair.flexspline - pair.circular_spline
    count = int(6.0 / separation / PERIOD)
    heights = {pair.circular_spline - separation: 0.2, pair.circular_spline: 1.0}
    heights |= {pair.flexspline: 0.6, pair.flexspline + separation: 0.3}
    samples = np.sum([sine(count, f, a, 7.0 * a) for f, a in heights.items()], axis=0)
    zoomed = zoom_spectrum(samples, PERIOD, around=pair, k=k)
    assert zoomed.k == k
    assert zoomed.resolved
    assert len(zoomed.frequencies) == len(zoomed.amplitude) == 50
    for frequency, amplitude in heights.items():
        index = int(np.argmin(np.abs(zoomed.frequencies - frequency)))
        assert zoomed.frequencies[index] == pytest.approx(frequency, rel=1e-12)
        assert zoomed.amplitude[index] == pytest.approx(amplitude, rel=1e-3)
        if frequency in pair:
            assert zoomed.amplitude[index] == max(zoomed.amplitude[index - 3 : index + 4])
    assert zoomed.line_amplitudes == pytest.approx((1.0, 0.6), rel=1e-3)


def test_resolved_from_the_travel_that_the_geometry_requires():
    speed, k = 600.0, 1
    pair = RIG.line_frequencies(speed, k)
    seconds = RIG.travel_to_separate(k) / (math.tau * speed / 60.0 / RIG.reduction)
    for factor, resolved in ((0.99, False), (1.01, True)):
        count = round(factor * seconds / PERIOD)
        samples = sine(count, pair.circular_spline) + sine(count, pair.flexspline)
        zoomed = zoom_spectrum(samples, PERIOD, around=pair, k=k)
        assert zoomed.resolved is resolved
        assert zoomed.resolution == pytest.approx(2.0 / (count * PERIOD))


def test_a_short_record_shows_one_whole_lobe():
    pair = LinePair(25.0, 25.3125)
    zoomed = zoom_spectrum(sine(1000, 25.15), PERIOD, around=pair, k=1)
    assert not zoomed.resolved
    assert np.ptp(zoomed.frequencies) > 4.0
    assert zoomed.amplitude[[0, -1]].max() < 0.05 * zoomed.amplitude.max()


@pytest.mark.parametrize(
    "pair",
    [LinePair(2.0, 3.0), LinePair(498.0, 499.5), LinePair(1.0, 499.9), LinePair(3.0, 13.0), LinePair(240.0, 490.0)],
)
def test_the_span_stays_in_the_band(pair):
    zoomed = zoom_spectrum(sine(20_000, 40.0), PERIOD, around=pair, k=1)
    assert zoomed.frequencies[0] >= 0.0
    assert zoomed.frequencies[-1] <= 500.0
    assert len(zoomed.frequencies) == 50
    assert np.all(np.diff(zoomed.frequencies) > 0.0)
    for line in pair:
        assert np.abs(zoomed.frequencies - line).min() < 1e-9


def test_missing_samples_do_not_change_the_amplitude():
    rng = np.random.default_rng(5)
    samples = sine(4000, 50.1, 2.0) + 30.0
    samples[rng.random(4000) < 0.1] = np.nan
    zoomed = zoom_spectrum(samples, PERIOD, around=LinePair(50.1, 51.1), k=1)
    # Random holes throw the power of what they cut out, |2 sin|, onto the whole band: per bin some
    # 2·sqrt(0.1·0.5·1.5/4000) of the amplitude, so five times that bounds it.
    assert zoomed.line_amplitudes.circular_spline == pytest.approx(2.0, rel=5 * 2 * math.sqrt(0.1 * 0.5 * 1.5 / 4000))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"around": LinePair(30.0, 20.0)}, "not a rising pair"),
        ({"around": LinePair(30.0, 600.0)}, "faster input"),
        ({"bins": 5}, "bins = 5"),
        ({"period": 0.0}, "sample period"),
        ({"samples": [1.0]}, "not a record"),
        ({"samples": np.full(100, np.nan)}, "none of the 100 samples"),
    ],
)
def test_refuses_what_has_no_spectrum(change, words):
    arguments = {"samples": np.ones(1000), "period": PERIOD, "around": LinePair(25.0, 26.0), "k": 1} | change
    samples, period = arguments.pop("samples"), arguments.pop("period")
    with pytest.raises(ParameterError, match=words):
        zoom_spectrum(samples, period, **arguments)


@pytest.mark.parametrize("wrong", [{"count": 2}, {"bins": 1}, {"first": -1.0}, {"last": 501.0}, {"first": 30.0}])
def test_refuses_a_configuration_that_shows_nothing(wrong):
    arguments = {"count": 100, "period": PERIOD, "first": 10.0, "last": 20.0, "bins": 10} | wrong
    with pytest.raises(ParameterError):
        Zoom(**arguments)


def test_refuses_samples_of_another_length():
    with pytest.raises(ParameterError, match="100 samples"):
        Zoom(100, PERIOD, 10.0, 20.0)(np.ones(99))

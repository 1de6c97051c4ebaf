import math

import numpy as np
import pytest
from scipy.optimize import least_squares

from hd_monitor.orders.zoom import zoom_spectrum
from hd_monitor.reducer import LinePair

PERIOD = 1.0 / 12_000.0
PAIR = LinePair(119.70, 120.00)
"""Four times the shaft's speed and twice the mains: 0.3 Hz apart."""


def two_tones(samples):
    """Amplitudes and frequencies of two sines fitted to the samples, all four free: the independent reference."""
    times = PERIOD * np.arange(samples.size)

    def columns(frequencies):
        tones = [f(math.tau * frequency * times) for frequency in frequencies for f in (np.cos, np.sin)]
        return np.column_stack([*tones, np.ones_like(times)])

    def residual(frequencies):
        design = columns(frequencies)
        return samples - design @ np.linalg.lstsq(design, samples, rcond=None)[0]

    frequencies = least_squares(residual, list(PAIR), x_scale=1e-3, diff_step=np.full(2, 1e-6)).x
    a, b, c, d, _ = np.linalg.lstsq(columns(frequencies), samples, rcond=None)[0]
    return frequencies, (math.hypot(a, b), math.hypot(c, d))


@pytest.mark.shared_data
@pytest.mark.parametrize("channel", ["DE", "FE"])
def test_splits_two_lines_of_known_origin_on_a_real_machine(cwru, channel):
    zoomed = zoom_spectrum(cwru[channel], PERIOD, around=PAIR, k=0)
    assert zoomed.resolved
    between = (zoomed.frequencies > PAIR.circular_spline) & (zoomed.frequencies < PAIR.flexspline)
    left = zoomed.frequencies < np.mean(PAIR)
    for side, frequency in ((left, PAIR.circular_spline), (~left, PAIR.flexspline)):
        peak = zoomed.frequencies[side][np.argmax(zoomed.amplitude[side])]
        assert peak == pytest.approx(frequency, abs=0.03)
    assert zoomed.amplitude[between].min() < 0.5 * min(zoomed.line_amplitudes)


@pytest.mark.shared_data
@pytest.mark.parametrize("channel", ["DE", "FE"])
def test_heights_are_those_of_a_two_tone_fit(cwru, channel):
    samples = cwru[channel]
    frequencies, amplitudes = two_tones(samples)
    assert frequencies == pytest.approx(PAIR, abs=0.02)
    zoomed = zoom_spectrum(samples, PERIOD, around=LinePair(*frequencies), k=0)
    # Noise: the Hann window's variance is 1.5 times that of the fit, so the two differ by sqrt(0.5) standard deviations
    # of the fit; these come from the spectrum around, where the mean square is 2·1.5 times the fit's variance.
    around = np.abs(zoomed.frequencies - np.mean(PAIR)) > 0.3 / 2 + 2.0 / (samples.size * PERIOD)
    fit_std = math.sqrt(np.mean(zoomed.amplitude[around] ** 2) / 3.0)
    # Leakage: what the Hann window passes of one line at the other's place.
    bins = np.diff(frequencies)[0] * samples.size * PERIOD
    leak = abs(np.sinc(bins) / (1.0 - bins**2))
    for height, own, other in zip(zoomed.line_amplitudes, amplitudes, amplitudes[::-1], strict=True):
        tolerance = 3.0 * math.sqrt(0.5) * fit_std + leak * other
        assert tolerance < 0.1 * own
        assert height == pytest.approx(own, abs=tolerance)

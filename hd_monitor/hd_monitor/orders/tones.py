"""Foreign tones in a vibration signal: mains hum or a neighbouring machine, at frequencies where there is no line."""

import numpy as np
import scipy

from ..arrays import FloatArray

MOST_TONES = 4
"""Tones that are removed from a segment at most."""

LONG_ENOUGH = 200
"""Samples from which tones are looked for."""

_STANDS_OUT = 100.0  # power of a tone over the median of its surroundings
_SURROUNDINGS = 24  # bins on either side
_NEAREST = 5  # bins on either side that a tone itself may fill


def foreign_tones(values: FloatArray, period: float, own: FloatArray, width: float) -> FloatArray:
    """Frequencies [Hz] of tones that stand out of a signal's spectrum away from its own lines.

    Parameters
    ----------
    values : ndarray, shape (samples,)
        0 where missing.
    period : float
        Sample period [s].
    own : ndarray, shape (lines, 2)
        Lowest and highest frequency [Hz] of each line over the segment.
    width : float
        Distance [Hz] from its own lines within which nothing counts as a tone.

    Returns
    -------
    ndarray, shape (tones,)
        The strongest first.
    """
    if values.size < LONG_ENOUGH:
        return np.empty(0)
    spectrum = np.abs(scipy.fft.rfft((values - values.mean()) * scipy.signal.get_window("hann", values.size))) ** 2
    bin_width = 1.0 / (values.size * period)
    frequencies = bin_width * np.arange(spectrum.size)
    margin = width + 4.0 * bin_width
    free = (frequencies > 4.0) & (frequencies < 0.45 / period)
    for low, high in own.tolist():
        free &= (frequencies < low - margin) | (frequencies > high + margin)
    tones: list[float] = []
    left = np.where(free, spectrum, 0.0)
    for _ in range(MOST_TONES):
        peak = int(np.argmax(left))
        around = spectrum[max(peak - _SURROUNDINGS, 0) : peak + _SURROUNDINGS + 1]
        if left[peak] <= _STANDS_OUT * float(np.median(around)) or peak in (0, spectrum.size - 1):
            break
        before, top, after = np.log(spectrum[peak - 1 : peak + 2] + 1e-300)
        bend = before - 2.0 * top + after
        tones.append(bin_width * (peak + (0.5 * (before - after) / bend if bend < 0.0 else 0.0)))
        left[max(peak - _NEAREST, 0) : peak + _NEAREST + 1] = 0.0
    return np.asarray(tones)

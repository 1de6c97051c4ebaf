"""The zoom spectrum around one line pair: the picture that the paper's rule is read from (Fig. 13c)."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from ..arrays import FloatArray
from ..contract import ZOOM_BINS
from ..errors import ParameterError
from ..reducer import LinePair

WIDTH = 2.0
"""Separation of two lines that a Hann window shows as two, in cycles per record (half of its main lobe)."""

PAIRS_SHOWN = 5
"""Width of the span in line separations: the pair, its combination lines on either side, and half as much again."""

LOBES_SHOWN = 8
"""Width of the span in resolutions where the record is too short to separate the lines: a whole lobe and around it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ZoomSpectrum:
    """Amplitude spectrum around one pair of lines.

    Attributes
    ----------
    frequencies : ndarray, shape (bins,)
        Frequencies [Hz], evenly spaced; both expected lines and the combination lines beside them are bins.
    amplitude : ndarray, shape (bins,)
        Peak amplitude in the signal's unit: a sine of amplitude A shows A (the window is corrected for).
    k : int
        Which pair, 0 if none.
    lines : LinePair
        Expected frequencies of the pair [Hz].
    line_amplitudes : LinePair
        The spectrum at those frequencies, in the signal's unit.
    resolution : float
        Separation [Hz] from which two equal lines show as two peaks.
    resolved : bool
        True if the pair is that far apart. If not, the two peaks say nothing about the two splines.
    """

    frequencies: FloatArray
    amplitude: FloatArray
    k: int
    lines: LinePair
    line_amplitudes: LinePair
    resolution: float
    resolved: bool


class Zoom:
    """A zoom spectrum's precomputed configuration: Hann window and chirp-z transform, called on samples.

    Parameters
    ----------
    count : int
        Samples per record.
    period : float
        Sample period [s].
    first, last : float
        First and last frequency [Hz], both shown.
    bins : int
        Number of frequencies.

    Raises
    ------
    ParameterError
        If there is nothing to transform, or the frequencies lie outside the signal's band.

    Examples
    --------
    >>> import numpy as np
    >>> zoom = Zoom(2000, 0.001, 49.0, 51.0, 21)
    >>> amplitude = zoom(3.0 * np.sin(2 * np.pi * 50.0 * 0.001 * np.arange(2000)))
    >>> round(float(amplitude[10]), 6), round(float(zoom.frequencies[10]), 6)
    (3.0, 50.0)
    """

    def __init__(self, count: int, period: float, first: float, last: float, bins: int = ZOOM_BINS) -> None:
        if count < 4 or bins < 2:
            raise ParameterError(f"a zoom of {count} samples to {bins} bins shows nothing; give at least 4 and 2")
        if not 0.0 <= first < last <= 0.5 / period:
            raise ParameterError(
                f"the frequencies {first:g} to {last:g} Hz leave the band 0 to {0.5 / period:g} Hz of samples "
                f"{period:g} s apart; choose another pair or a faster input"
            )
        self.count = count
        self.frequencies: FloatArray = np.linspace(first, last, bins)
        self._window: FloatArray = np.asarray(scipy.signal.get_window("hann", count), dtype=np.float64)
        self._transform = scipy.signal.ZoomFFT(count, [first, last], m=bins, fs=1.0 / period, endpoint=True)

    def __call__(self, samples: npt.ArrayLike) -> FloatArray:
        """Peak amplitudes, shape (bins,), of the samples, shape (count,); their mean is removed.

        Missing samples (NaN) get no weight, and the amplitudes are corrected for it.
        """
        values = np.asarray(samples, dtype=np.float64)
        if values.shape != (self.count,):
            raise ParameterError(f"samples of shape {values.shape} do not fit a zoom made for {self.count} samples")
        present = np.isfinite(values)
        weights = np.where(present, self._window, 0.0)
        total = float(weights.sum())
        if total <= 0.0:
            raise ParameterError(f"none of the {self.count} samples is a number; there is no spectrum to show")
        values = np.where(present, values, 0.0)
        weighted = weights * (values - float(weights @ values) / total)
        return np.asarray(2.0 / total * np.abs(self._transform(weighted)), dtype=np.float64)


def zoom_spectrum(
    samples: npt.ArrayLike,
    period: float,
    *,
    around: LinePair,
    k: int,
    bins: int = ZOOM_BINS,
) -> ZoomSpectrum:
    """Amplitude spectrum around a line pair, its two combination lines included.

    The bins are at the lines and at whole fractions of their separation beside them, so that the height of each
    line, and of ``2 f_cs - f_fs`` and ``2 f_fs - f_cs`` where load modulation shows, is read without scalloping.

    Parameters
    ----------
    samples : array_like, shape (samples,)
        Vibration on an even time grid, any unit; NaN where missing. The speed must be steady: at a changing speed the
        lines smear, and regression on the angle takes over.
    period : float
        Sample period [s].
    around : LinePair
        Expected line frequencies [Hz], circular spline's first.
    k : int
        Number of the pair, for the result.
    bins : int
        As many, at least 10; closer together, or not around the pair's middle, where the span would leave the band
        from 0 to half the sampling rate.

    Returns
    -------
    ZoomSpectrum

    Raises
    ------
    ParameterError
        If the pair lies outside the signal's band, is not a pair, or the samples are not a record.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.ndim != 1 or values.size < 4:
        raise ParameterError(f"samples of shape {values.shape} are not a record; give 4 or more in one dimension")
    if not (np.isfinite(period) and period > 0.0):
        raise ParameterError(f"period = {period!r} s is not a sample period; give the time between two samples")
    if bins < 2 * PAIRS_SHOWN:
        raise ParameterError(f"bins = {bins} cannot show a pair and its neighbours; give at least {2 * PAIRS_SHOWN}")
    left, right = around
    separation, nyquist = right - left, 0.5 / period
    if not (0.0 < left < right < nyquist):
        raise ParameterError(
            f"the lines {left:g} and {right:g} Hz are not a rising pair between 0 and {nyquist:g} Hz, half the "
            "sampling rate; choose a lower pair or a faster input"
        )
    resolution = WIDTH / (values.size * period)
    # Bins per separation: as fine as the five separations allow, coarser where one lobe would not fit into the picture,
    # and so fine that all of them fit into the band.
    finest = bins // PAIRS_SHOWN
    per_separation = int(np.clip(np.floor(bins * separation / (LOBES_SHOWN * resolution)), 1, finest))
    per_separation = min(max(per_separation, int(np.ceil((bins + 1) * separation / nyquist))), bins - 1)
    step = separation / per_separation
    before = (bins - per_separation) // 2
    beyond = int(np.floor((nyquist - left) / step))
    lowest = max(min(-before, beyond - bins + 1), -int(np.floor(left / step)))
    highest = lowest + bins - 1
    first, last = max(left + lowest * step, 0.0), min(left + highest * step, nyquist)
    zoom = Zoom(values.size, period, first, last, highest - lowest + 1)
    amplitude = zoom(values)
    at_left = -lowest
    return ZoomSpectrum(
        frequencies=zoom.frequencies,
        amplitude=amplitude,
        k=k,
        lines=around,
        line_amplitudes=LinePair(float(amplitude[at_left]), float(amplitude[at_left + per_separation])),
        resolution=resolution,
        resolved=bool(separation >= resolution),
    )

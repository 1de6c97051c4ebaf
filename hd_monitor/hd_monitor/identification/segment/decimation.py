"""Decimation of a segment of raw samples: a rate higher than needed is reduced, gaps are bridged or left out."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import BoolArray, FloatArray

RATE_OVER_LINE = 2.8
RATE_OVER_NATURAL = 6.4
"""Sampling rate that is enough, over the highest line's and over the natural frequency."""

PASS_BAND = 0.36
"""Part of the reduced sampling rate up to which the anti-aliasing filter passes everything (to 0.1 %)."""

_TAPS = 32  # of the anti-aliasing filter, per factor of reduction
_LOSS, _LOSS_DEAR = 0.04, 0.12  # part of the samples that reducing the rate may cost, by a little or much
_WORTH_MUCH = 4  # factor of reduction
_BRIDGED = 2  # samples missing in a row that interpolation replaces before the rate is reduced


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Decimated:
    """Samples at a reduced rate.

    Attributes
    ----------
    values : ndarray, shape (samples,)
        0 where left out.
    used : ndarray of bool, shape (samples,)
    factor : int
        Raw sample periods per sample.
    first : int
        Index of the raw sample that the first one represents.
    highest_frequency : float
        Frequency [Hz] up to which the values can be trusted.
    """

    values: FloatArray
    used: BoolArray
    factor: int
    first: int
    highest_frequency: float


def decimate(raw: FloatArray, period: float, line: float, natural: float) -> Decimated:
    """Reduce the sampling rate where the signal needs much less.

    Parameters
    ----------
    raw : ndarray, shape (raw samples,)
        NaN where missing, spikes included.
    period : float
        Raw sample period [s].
    line, natural : float
        Highest line frequency and highest natural frequency of interest [Hz].
    """
    used = np.isfinite(raw)
    factor = math.floor(1.0 / (period * max(RATE_OVER_LINE * line, RATE_OVER_NATURAL * natural)))
    half = _TAPS // 2 * factor
    lost = 2.0 * half / raw.size  # the filter has no output at the ends
    if factor < 2 or lost > (_LOSS_DEAR if factor >= _WORTH_MUCH else _LOSS) or np.count_nonzero(used) < 8:
        values = np.where(used, raw, 0.0)
        return Decimated(values=values, used=used, factor=1, first=0, highest_frequency=0.5 / period)
    taps = scipy.signal.firwin(2 * half + 1, 0.43 * 2.0 / factor, window=("kaiser", 6.0))
    values = np.convolve(_bridge(raw, used), taps, mode="valid")[::factor]
    holes = scipy.ndimage.binary_opening(~used, np.ones(_BRIDGED + 1, dtype=np.bool_))
    near = ~scipy.ndimage.binary_dilation(holes, np.ones(2 * factor + 1, dtype=np.bool_))[
        half : raw.size - half : factor
    ]
    return Decimated(
        values=np.where(near, values, 0.0),
        used=near,
        factor=factor,
        first=half,
        highest_frequency=PASS_BAND / (factor * period),
    )


def _bridge(raw: FloatArray, used: BoolArray) -> FloatArray:
    """Fill in missing samples by cubic interpolation, those at the ends by the nearest."""
    if used.all():
        return raw
    places = np.flatnonzero(used)
    filled = raw.copy()
    filled[~used] = scipy.interpolate.CubicSpline(places, raw[used])(
        np.clip(np.flatnonzero(~used), places[0], places[-1])
    )
    return filled

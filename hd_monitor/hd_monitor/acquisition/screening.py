"""Screening of vibration samples: values that are no vibration are left out and counted, never used in silence."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import BoolArray, FloatArray
from ..robust import PER_MEDIAN, robust_std

Places = npt.NDArray[np.intp]

_SPIKE = 8.0  # robust standard deviations of the curvature; a sine never exceeds 2
_AROUND = 12  # samples on either side of a spike that tell the level there
_STUCK_RUN = 32  # equal samples in a row: no sensor at rest is that quiet
_CLIPPED_RUN = 3  # equal samples in a row at the extreme: a flat top
_NOWHERE = np.empty(0, dtype=np.intp)


class Screened(NamedTuple):
    """Values with the bad ones replaced by NaN, shape (N,), and how many of each kind there were."""

    values: FloatArray
    not_finite: int
    clipped: int
    stuck: int
    spikes: int


def screen(values: FloatArray, *, full_scale: float = 0.0, turning: bool = True) -> Screened:
    """Find values that are not finite, clipped, stuck or spikes.

    Parameters
    ----------
    values : ndarray, shape (N,)
        Vibration samples in sampling order.
    full_scale : float
        Magnitude from which a sample counts as clipped; 0 looks for flat tops at the extremes instead.
    turning : bool
        Whether the joint turned: a standing one may well give a constant signal, a turning one never.
    """
    clean = np.array(values, dtype=np.float64)
    finite = np.isfinite(clean)
    not_finite = clean.size - int(np.count_nonzero(finite))
    if not_finite:
        clean[~finite] = np.nan
    if clean.size < 3:
        return Screened(clean, not_finite, 0, 0, 0)
    clipped = np.flatnonzero(np.abs(clean) >= full_scale) if full_scale > 0.0 else _NOWHERE
    stuck = _NOWHERE
    equal = clean[1:] == clean[:-1]
    if equal.any():
        flat, stuck = _flat_runs(clean, equal, tops=full_scale == 0.0)
        clipped = np.setdiff1d(np.union1d(clipped, flat), stuck)
        if not turning:
            stuck = _NOWHERE
    clean[clipped] = np.nan
    clean[stuck] = np.nan
    spikes = _spikes(clean)
    clean[spikes] = np.nan
    return Screened(clean, not_finite, clipped.size, stuck.size, spikes.size)


def _flat_runs(values: FloatArray, equal: BoolArray, *, tops: bool) -> tuple[Places, Places]:
    """Places of flat tops, if asked for, and of values that are stuck."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], equal, [False]]).astype(np.int8)))
    flat, stuck = np.zeros(values.size, dtype=np.bool_), np.zeros(values.size, dtype=np.bool_)
    high, low = np.nanmax(values), np.nanmin(values)
    for first, last in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        run = slice(first, last + 1)
        length = last + 1 - first
        if length >= _STUCK_RUN:
            stuck[run] = True
        elif tops and length >= _CLIPPED_RUN and values[first] in (high, low) and high > low:
            flat[run] = True
    return np.flatnonzero(flat), np.flatnonzero(stuck)


def _spikes(values: FloatArray) -> Places:
    """Indexes of single samples that stick out of their neighbours."""
    curvature = np.abs(values[1:-1] - 0.5 * (values[:-2] + values[2:]))
    known = curvature
    largest = float(curvature.max(initial=0.0))
    if math.isnan(largest):
        known = curvature[np.isfinite(curvature)]
        largest = float(known.max(initial=0.0))
    if known.size < 16:
        return _NOWHERE
    # Where most are not far below the largest, the median is not either: counting them is quicker than the median
    if 2 * int(np.count_nonzero(known >= largest / (_SPIKE * PER_MEDIAN))) > known.size + 1:
        return _NOWHERE
    limit = _SPIKE * robust_std(known)
    if limit == 0.0 or not (known > limit).any():
        return _NOWHERE
    # the neighbours of a spike bend too, half as much: only the local maximum is the spike
    padded = np.concatenate([[0.0, 0.0], np.nan_to_num(curvature), [0.0, 0.0]])
    peak = (padded[2:-2] >= padded[1:-3]) & (padded[2:-2] >= padded[3:-1]) & (padded[2:-2] > limit)
    candidates = np.flatnonzero(peak)
    return np.asarray([i + 1 for i in candidates.tolist() if _sticks_out(curvature, i)], dtype=np.intp)


def _sticks_out(curvature: FloatArray, place: int) -> bool:
    """Whether the curvature at a place exceeds that around it as well: a level that rises, at a resonance, does not."""
    around = np.concatenate(
        [curvature[max(0, place - _AROUND) : max(0, place - 1)], curvature[place + 2 : place + 1 + _AROUND]]
    )
    around = around[np.isfinite(around)]
    return not around.size or bool(curvature[place] > _SPIKE * robust_std(around))

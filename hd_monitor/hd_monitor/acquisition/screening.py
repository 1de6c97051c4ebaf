"""Screening of vibration samples: bad values are left out and counted, never used silently."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import BoolArray, FloatArray, runs_of
from ..robust import PER_MEDIAN, robust_std

Places = npt.NDArray[np.intp]

_SPIKE = 8.0  # robust standard deviations of the curvature; a sine never exceeds 2
_AROUND = 12  # samples on either side of a spike that show the level there
_LONGEST_SPIKE = 3  # samples in a row; more are a disturbance, not a spike
_LARGEST = 1e150  # any units: the square of a larger number, infinity and NaN mean nothing
_STUCK_RUN = 32  # equal samples in a row: no sensor at rest is that quiet
_CLIPPED_RUN = 3  # equal samples in a row at the extreme: a flat top
_TRIALS = np.array([(n, first) for n in range(1, _LONGEST_SPIKE + 1) for first in range(-n, 2)])
"""Number of samples of a trial spike, and its first one relative to the place of the largest curvature."""
_NOWHERE = np.empty(0, dtype=np.intp)


class Screened(NamedTuple):
    """Values with the bad ones replaced by NaN, shape (N,), and how many of each kind there were."""

    values: FloatArray
    not_finite: int
    clipped: int
    stuck: int
    spikes: int


def screen(values: FloatArray, *, full_scale: float = 0.0, turning: bool = True) -> Screened:
    """Find values that are not finite (or so large that their squares are not), clipped, stuck or spikes.

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
    finite = np.abs(clean) < _LARGEST
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
    """Places of flat tops, with `tops`, and of stuck values."""
    flat, stuck = np.zeros(values.size, dtype=np.bool_), np.zeros(values.size, dtype=np.bool_)
    high, low = np.nanmax(values), np.nanmin(values)
    for first, last in runs_of(equal):
        run = slice(first, last + 1)
        length = last + 1 - first
        if length >= _STUCK_RUN:
            stuck[run] = True
        elif tops and length >= _CLIPPED_RUN and values[first] in (high, low) and high > low:
            flat[run] = True
    return np.flatnonzero(flat), np.flatnonzero(stuck)


def _curvature(values: FloatArray) -> FloatArray:
    """Magnitude of the deviation of each inner sample from the mean of its neighbours, along the last axis."""
    return np.abs(values[..., 1:-1] - 0.5 * (values[..., :-2] + values[..., 2:]))


def _spikes(values: FloatArray) -> Places:
    """Indexes of samples, up to `_LONGEST_SPIKE` in a row, that stick out from their neighbours."""
    curvature = _curvature(values)
    known = curvature
    largest = float(curvature.max(initial=0.0))
    if math.isnan(largest):
        known = curvature[np.isfinite(curvature)]
        largest = float(known.max(initial=0.0))
    if known.size < 16:
        return _NOWHERE
    # Where most are not far below the largest, neither is the median: counting them is quicker than the median
    if 2 * int(np.count_nonzero(known >= largest / (_SPIKE * PER_MEDIAN))) > known.size + 1:
        return _NOWHERE
    limit = _SPIKE * robust_std(known)
    if limit == 0.0 or largest <= limit:
        return _NOWHERE
    # The neighbours of a spike bend too, half as much: only local maxima count
    padded = np.concatenate([[0.0], np.nan_to_num(curvature), [0.0]])
    middle = padded[1:-1]
    peaks = np.flatnonzero((middle >= padded[:-2]) & (middle >= padded[2:]) & (middle > limit))
    calm, found = values.copy(), [_NOWHERE]
    for place in peaks[np.argsort(-middle[peaks], kind="stable")].tolist():
        while (spike := _spike_near(calm, place + 1, limit)).size:
            found.append(spike)
    return np.unique(np.concatenate(found))


def _spike_near(values: FloatArray, place: int, limit: float) -> Places:
    """Find a spike near a place and replace it by the line between its neighbours.

    The curvature there must exceed `limit`, and that around it as well: a level that rises, at a resonance, does not.
    """
    low, high = max(0, place - 2 * _AROUND), min(values.size, place + 2 * _AROUND + 1)
    window = values[low:high]
    raw = _curvature(window)
    curvature = np.nan_to_num(raw)
    near = slice(max(0, place - low - 1 - _LONGEST_SPIKE), place - low + _LONGEST_SPIKE)
    top = near.start + int(np.argmax(curvature[near]))
    level = np.concatenate([raw[max(0, top - _AROUND) : max(0, top - 2)], raw[top + 3 : top + _AROUND + 1]])
    level = level[np.isfinite(level)]
    if curvature[top] <= max(limit, _SPIKE * robust_std(level) if level.size else 0.0):
        return _NOWHERE
    # Trials, each in a row: which samples, of one to three in a row, leave the least curvature once bridged by a line?
    count, first = _TRIALS[:, 0], top + 1 + _TRIALS[:, 1]
    inside = (first >= 0) & (first + count <= window.size)
    count, first = count[inside, None], first[inside, None]
    padded = np.concatenate([[math.nan], window, [math.nan]])
    left, right = padded[first], padded[first + count + 1]
    left, right = np.where(np.isnan(left), right, left), np.where(np.isnan(right), left, right)
    part = (np.arange(window.size) - first + 1) / (count + 1.0)
    chosen = (part > 0.0) & (part < 1.0) & np.isfinite(window)
    bridged = np.where(chosen, left + part * (right - left), window)
    # Squares, so that another spike nearby counts alike in every trial; a longer spike must justify its length
    gain = (curvature**2 - np.nan_to_num(_curvature(bridged)) ** 2).sum(axis=1) / np.sqrt(count[:, 0])
    gain[np.isnan(left[:, 0])] = 0.0
    best = int(np.argmax(gain))
    if gain[best] <= 0.0:
        return _NOWHERE
    values[low:high] = bridged[best]
    return low + np.flatnonzero(chosen[best])

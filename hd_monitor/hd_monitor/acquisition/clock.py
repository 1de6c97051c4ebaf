"""Recovery of the sampling clock: a sensor samples evenly, even where its messages' stamps jitter or some are lost."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray, IntArray
from .bursts import find_bursts

_EVEN = 0.02  # of a period: single differences of stamps as even as this count missing samples reliably
_DISORDERED = 0.2  # of a period: sorted stamps more uneven than this were not sampled in that order
_SHARP = 0.17  # of a period: stamps nearer to the grid than this show their own place; rounding alone leaves 0.29
_OUT_OF_PLACE = 0.55  # of a period: a stamp further from its place belongs to another one
_REFINEMENTS = 4
_SMOOTHING = 20  # samples over which heavy jitter is averaged before missing samples are counted
_MOST_TRIED = 10_000  # excesses on which the guesses of the period are tried
_DRIFT = 2e-3  # relative error of the first guess of the period under heavy jitter, at most


class Clock(NamedTuple):
    """An even grid through jittering stamps.

    Attributes
    ----------
    order : ndarray of int, shape (kept,)
        Indexes of the samples kept, in sampling order.
    number : ndarray of int, shape (kept,)
        Place of each on the grid, from 0, strictly increasing; a jump is a hole.
    start, period : float
        Time of place 0 [s] and sample period [s].
    jitter : float
        Standard deviation of the stamps about the grid [s].
    duplicates : int
        Samples left out because their stamp occurred before.
    burst : int
        Samples that were stamped together as they were read out; 1 if each had its own stamp.
    """

    order: npt.NDArray[np.intp]
    number: IntArray
    start: float
    period: float
    jitter: float
    duplicates: int
    burst: int = 1


def recover_clock(times: FloatArray, period: float | None = None) -> Clock | None:
    """Fit an even grid to stamps in the order of arrival.

    Parameters
    ----------
    times : ndarray, shape (N,)
        Stamps [s], in the order the samples came; duplicates, small disorder and missing samples allowed.
    period : float, optional
        Sample period [s] where already known; else it is estimated.

    Returns
    -------
    Clock or None
        None if there are fewer than 3 different stamps.

    Notes
    -----
    Samples that arrive in another order than their stamps were either reordered on the way (sorting makes the stamps
    even) or have jittering stamps (sorting would scramble the signal). They are sorted where that leaves even stamps.
    """
    order = np.arange(times.size)
    rising = bool((times[1:] > times[:-1]).all())
    if not rising:
        order = np.sort(np.unique(times, return_index=True)[1])
    if order.size < 3:
        return None
    if not rising:
        by_stamp = order[np.argsort(times[order])]
        if _unevenness(np.diff(times[by_stamp])) <= _DISORDERED:
            order = by_stamp
    t = times[order]
    steps = t[1:] - t[:-1]
    typical = period or float(np.median(steps))
    if typical <= 0.0:
        return None
    even = float(steps.max()) < (1.0 + _EVEN) * typical and float(steps.min()) > (1.0 - _EVEN) * typical
    if not (rising and even) and (bursts := find_bursts(times)) is not None:
        apart = times - (bursts.start + bursts.period * bursts.number)
        return Clock(
            np.arange(times.size), bursts.number, bursts.start, bursts.period, float(np.std(apart)), 0, bursts.size
        )
    number = np.arange(t.size) if even else _number(t, steps, typical, period)  # mostly nothing is missing
    start, fitted = _line(number, t)
    apart = t - (start + fitted * number)
    jitter = math.sqrt(float(apart @ apart) / t.size)
    return Clock(order, number, start, fitted, jitter, times.size - order.size)


def _number(t: FloatArray, steps: FloatArray, typical: float, period: float | None) -> IntArray:
    """Number stamps with holes or jitter, their typical step [s] and perhaps the true period [s] being known."""
    number = np.concatenate([[0], np.cumsum(np.maximum(np.rint(steps / typical).astype(np.int64), 1))])
    if _unevenness(steps) > _EVEN:
        # With a line known, a single stamp shows its place more sharply than a difference of two stamps
        number = _settle(number, t)
        start, fitted = _line(number, t)
        apart = np.abs(t - start - fitted * number) / fitted
        if float(np.sqrt(np.mean(apart * apart))) > _SHARP or float(apart.max()) > _OUT_OF_PLACE:
            span = min(_SMOOTHING, max(1, t.size // 4))
            typical = period or float(np.median(t[span:] - t[:-span])) / span
            number = _count_through_jitter(t, typical, exact=period is not None)
    return number


def _settle(number: IntArray, t: FloatArray) -> IntArray:
    """Renumber stamps by the line through them until nothing changes."""
    half = t.size // 2
    for _ in range(_REFINEMENTS):
        start, slope = _line(number, t)
        if np.abs(t - start - slope * number).max() > 0.5 * slope:  # some are out of place: a robust line instead
            slope = float(np.median((t[half:] - t[: t.size - half]) / (number[half:] - number[: t.size - half])))
            start = float(np.median(t - slope * number))
        places = np.rint((t - start) / slope).astype(np.int64)
        places -= places[0]
        if np.array_equal(places, number) or (np.diff(places) < 1).any():
            break
        number = places
    return number


def _unevenness(steps: FloatArray) -> float:
    """Typical deviation of the steps from their median, as a part of it; robust against holes."""
    middle = float(np.median(steps))
    return float(np.median(np.abs(steps - middle))) / middle if middle > 0.0 else np.inf


def _count_through_jitter(t: FloatArray, period: float, *, exact: bool) -> IntArray:
    """Number samples whose stamps jitter by a good part of a period: missing ones show in the smoothed excess only.

    Without jitter, the excess of the stamps over an even count would be a whole number everywhere. Averaged, it lies
    near whole numbers for the true period only: of the periods that the guess allows, that one is taken.
    """
    width = min(2 * _SMOOTHING + 1, t.size)
    count = np.arange(t.size)
    excess = _smooth((t - t[0]) / period - count, width)
    if not exact:
        drift = np.arange(-_DRIFT * t.size, _DRIFT * t.size + 0.25, 0.25) / t.size  # periods per sample
        some = slice(None, None, max(1, width // 4, t.size // _MOST_TRIED))
        whole = [abs(np.exp(2j * np.pi * (excess[some] - each * count[some])).sum()) for each in drift.tolist()]
        excess = excess - drift[int(np.argmax(whole))] * count
    # The first sample's own jitter is in every excess: refer to where the excesses lie on average, not to it
    offset = float(np.angle(np.exp(2j * np.pi * excess).mean())) / (2.0 * np.pi)
    missing = np.maximum.accumulate(np.rint(excess - offset).astype(np.int64))
    return np.asarray(count + missing - missing[0], dtype=np.int64)


def _smooth(values: FloatArray, width: int) -> FloatArray:
    """Moving average; towards the ends over what there is."""
    ones = np.convolve(np.ones(values.size), np.ones(width), mode="same")
    return np.asarray(np.convolve(values, np.ones(width), mode="same") / ones)


def _line(number: IntArray, t: FloatArray) -> tuple[float, float]:
    """Least-squares line through t(number): (start, slope)."""
    mean_n, mean_t = float(number.sum()) / number.size, float(t.sum()) / t.size
    centred = number - mean_n
    slope = float(centred @ (t - mean_t)) / float(centred @ centred)
    return mean_t - slope * mean_n, slope

"""Samples whose stamps come in bursts: a sensor's FIFO that is stamped as it is read out, or several publishers.

A sensor with a FIFO samples evenly, but a driver that stamps on read-out gives all samples of one read-out nearly the
same stamp. The read-outs tell the rate: as many samples as one holds were taken since the one before.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray, IntArray

_FEWEST = 4  # bursts in a period; its bounds may cut the first and the last of them
_SHORTEST = 64  # samples, below which loss by chance looks regular too often
_PAUSE = 1.05  # mean steps: a longer step separates two bursts that cover less than half of the time
_DENSE = 0.5  # part of the time that bursts cover at most; what transit loses in a regular pattern leaves more of it
_ALIKE, _MOSTLY = 0.25, 0.8  # deviation from the middle, and the part of the bursts that keeps within it
_SOME_LOST = 1.5  # times the usual time between bursts: after a longer one, bursts were lost
_MOST_PUBLISHERS = 3  # more samples in a burst are certainly a FIFO's
_ROUGHER = 4.0  # times the mean square of differences: more than chance makes between those of one signal


class Bursts(NamedTuple):
    """Samples that were read out in bursts, on the grid on which they were taken.

    Attributes
    ----------
    number : ndarray of int, shape (N,)
        Place of each on the grid, from 0, strictly increasing; a jump is a hole.
    start, period : float
        Time of place 0 [s] and sample period [s].
    size : int
        Samples in a burst.
    """

    number: IntArray
    start: float
    period: float
    size: int


def find_bursts(t: FloatArray) -> Bursts | None:
    """Recognise bursts in stamps [s], in the order of sampling, shape (N,); None where there are none.

    Notes
    -----
    A burst is read when its newest sample has been taken: a line through the first stamps of the bursts, each in the
    place of the newest sample, is the sampling clock.
    """
    if t.size < _SHORTEST:
        return None
    steps = t[1:] - t[:-1]
    pauses = steps > _PAUSE * float(np.mean(steps))
    firsts = np.concatenate([[0], np.flatnonzero(pauses) + 1])
    if firsts.size < _FEWEST or firsts.size == t.size:
        return None
    counts = np.diff(firsts, append=t.size)
    apart = np.diff(t[firsts])
    size, pace = float(np.median(counts[1:-1])), float(np.median(apart))
    regular = size >= 2.0 and _mostly(counts[1:-1], size) and _mostly(apart, pace)
    within = float(np.median(steps[~pauses]))
    repeats = within <= 0.0 and size <= _MOST_PUBLISHERS  # the same message two or three times
    if not regular or repeats or (size - 1.0) * within > _DENSE * pace:
        return None
    period = float(np.median(apart[:-1] / counts[1:-1]))
    lost = np.where(apart > _SOME_LOST * pace, np.rint(apart / period).astype(np.int64) - counts[1:], 0)
    lost[lost < 0.5 * size] = 0
    oldest = np.cumsum(np.concatenate([[0], counts[:-1] + lost]))
    newest = oldest + counts - 1
    slope, start = np.polyfit(newest[1:-1], t[firsts[1:-1]], 1)
    number = np.repeat(oldest - firsts, counts) + np.arange(t.size)
    return Bursts(np.asarray(number, dtype=np.int64), float(start), float(slope), round(size))


def _mostly(values: npt.NDArray[np.generic], middle: float) -> bool:
    """Whether most values lie near their middle."""
    return bool(np.mean(np.abs(np.asarray(values, dtype=np.float64) - middle) <= _ALIKE * middle) >= _MOSTLY)


def interleaved(values: FloatArray, number: IntArray, size: int) -> bool:
    """Whether samples in the places `number`, in bursts of `size`, come from as many publishers in turn.

    In a FIFO all neighbours are alike. Those of several publishers differ more than each one's own successive samples;
    where all publish the same signal, they differ less within a burst than between two.
    """
    if not 2 <= size <= _MOST_PUBLISHERS:
        return False

    def power(lag: int, phases: range) -> list[float]:
        squares = np.square(values[lag:] - values[:-lag])
        squares[number[lag:] - number[:-lag] != lag] = np.nan
        return [float(np.nanmean(squares[number[:-lag] % size == phase])) for phase in phases]

    neighbours, own = power(1, range(size)), power(size, range(size))
    return max(neighbours) > _ROUGHER * min(neighbours) or sum(neighbours) > _ROUGHER * sum(own)

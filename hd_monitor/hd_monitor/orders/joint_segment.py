"""Joint samples cut into segments: one direction, fast enough for the lines and slow enough for the sampling rate."""

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from ..acquisition.record import JointSamples, Record
from ..arrays import BoolArray, FloatArray
from .regression import line_columns

LOWEST_FREQUENCY = 3.0
"""Hz of the first line below which it cannot be distinguished from friction and gravity."""

HIGHEST_SHARE = 0.45
"""Highest line frequency used, as a part of the sampling rate; a line at half of it is its own alias."""

WORKING_RATE = 250.0
"""Hz; faster samples are averaged down to about this, which loses nothing of the lines that a joint's speed allows."""

LONGEST_GAP = 0.5
"""s without a message that end a segment; shorter gaps are left out of it."""

LONGEST = 6.0
"""s after which a segment is closed and the next one begins, so that an endless rotation yields evidence too."""

SHORTEST = 40
"""Rows of a segment that is worth keeping: more than its trend terms."""

GAP = 2.5
"""Sample periods between two messages above which something is missing."""

ONE_SPEED = 0.1
"""Part of the speed over which the middle half of all rows must spread for the speed to count as varied."""

SPEED_SPAN = 0.04
"""s over which speed is taken from positions where messages carry none."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointSegment:
    """A segment of motion in one direction.

    Attributes
    ----------
    direction : int
        1 or -1, the sign of the output speed.
    angle : ndarray, shape (rows,)
        Output angle [rad].
    speed : ndarray, shape (rows,)
        Magnitude of the output speed [rad/s].
    values : ndarray, shape (rows,)
        The vibration signal: effort, velocity or acceleration, in its own unit.
    starts : ndarray of bool, shape (rows,)
        True where a row does not follow its predecessor without a gap.
    averaged : int
        Samples averaged into a row, 1 for none.
    rate : float
        Rows per second.
    """

    direction: int
    angle: FloatArray
    speed: FloatArray
    values: FloatArray
    starts: BoolArray
    averaged: int
    rate: float

    @property
    def duration(self) -> float:
        """Time covered [s]."""
        return self.values.size / self.rate

    def columns(self, orders: npt.ArrayLike) -> FloatArray:
        """Lines of unit amplitude as the rows show them, averaging included.

        Parameters
        ----------
        orders : array_like, shape (lines,)
            Cycles per output revolution.

        Returns
        -------
        ndarray, shape (rows, 2 * lines)
            As in :func:`line_columns`.
        """
        order = np.asarray(orders, dtype=np.float64)
        columns = line_columns(self.angle, order)
        if self.averaged > 1:
            step = self.speed / (self.rate * self.averaged)  # rad between successive samples of a row
            columns *= np.tile(scipy.special.diric(np.multiply.outer(step, order), self.averaged), 2)
        return columns


class JointSegmentCutter:
    """Turns a stream of joint samples into segments, independent of how the stream is chunked.

    Parameters
    ----------
    source : str
        ``'joint_effort'`` or ``'joint_velocity'``: the field that is the vibration signal.
    orders : tuple of float
        Cycles per output revolution of the lowest and the highest line looked for.
    minimum_speed : float
        Output speed [rad/s] below which the joint counts as standing.
    """

    def __init__(self, source: str, orders: tuple[float, float], minimum_speed: float) -> None:
        self._source = source
        self._lowest, highest = orders
        self._minimum = max(minimum_speed, LOWEST_FREQUENCY * math.tau / highest)
        self._pending = np.empty((0, 4))
        self._recent = np.empty((0, 4))
        self._period: float | None = None
        self.too_fast = 0.0
        self.turning = 0.0

    def add(self, samples: JointSamples) -> list[JointSegment]:
        """Take in messages and return the segments that are complete now."""
        value = samples.effort if self._source == "joint_effort" else samples.speed
        rows = np.column_stack([samples.times, samples.angle, samples.speed, value])
        rows = rows[np.isfinite(rows[:, [0, 1, 3]]).all(axis=1)]
        if not len(rows):
            return []
        known = np.concatenate([self._recent, rows])
        known[:, 1] = np.unwrap(known[:, 1])  # a joint that turns on and on may report -π to π
        rows[:, 1] = known[len(self._recent) :, 1]
        rows[:, 2] = _speeds(known)[len(self._recent) :]
        self._recent = known[known[:, 0] >= known[-1, 0] - 2.0 * SPEED_SPAN]
        rows = np.concatenate([self._pending, rows])
        sign = np.where(np.abs(rows[:, 2]) >= self._minimum, np.sign(rows[:, 2]), 0.0)
        pause = np.diff(rows[:, 0])
        edges = np.flatnonzero((np.diff(sign) != 0.0) | (pause > LONGEST_GAP) | (pause <= 0.0)) + 1
        bounds = [0, *edges.tolist(), len(rows)]
        segments: list[JointSegment] = []
        for first, last in itertools.pairwise(bounds):
            if sign[first] == 0.0:
                first = last
            while first < last:
                end = first + int(np.searchsorted(rows[first:last, 0], rows[first, 0] + LONGEST))
                if end == len(rows):
                    break
                segments += self._close(rows[first:end])
                first = end
        self._pending = rows[first:]
        return segments

    def finish(self) -> list[JointSegment]:
        """Return the segment that is still open, if it is long enough: no more messages will come."""
        rows, self._pending, self._recent = self._pending, np.empty((0, 4)), np.empty((0, 4))
        return self._close(rows) if len(rows) and abs(rows[0, 2]) >= self._minimum else []

    def _close(self, rows: FloatArray) -> list[JointSegment]:
        """Return the segment of these rows, without those in which the lines are too fast for the rate, if any."""
        if len(rows) < SHORTEST:
            return []
        if self._period is None:
            self._period = float(np.median(np.diff(rows[:, 0])))
        period = self._period
        averaged = max(1, int(1.02 / period / WORKING_RATE))  # stamps in whole milliseconds round the period
        self.turning += len(rows) * period
        limit = HIGHEST_SHARE / (period * averaged) * math.tau / self._lowest
        fast = np.abs(rows[:, 2]) > limit
        self.too_fast += float(np.count_nonzero(fast)) * period
        return _segments(rows, ~fast, period, averaged)


def samples_of_records(records: Iterable[Record]) -> JointSamples:
    """Accelerations in place of the effort, so that records can be cut into segments like joint states."""
    parts = list(records)
    times, angle, speed, acceleration = (
        np.concatenate([np.empty(0), *(getattr(record, name) for record in parts)])
        for name in ("times", "angle", "speed", "acceleration")
    )
    return JointSamples(times=times, angle=angle, speed=speed, effort=acceleration)


def _speeds(rows: FloatArray) -> FloatArray:
    """Output speeds [rad/s] of rows (time, angle, speed, value), from the positions where there is none."""
    speed = rows[:, 2].copy()
    missing = ~np.isfinite(speed)
    if missing.any():
        time, angle = rows[:, 0], rows[:, 1]
        before = np.maximum(np.searchsorted(time, time - SPEED_SPAN, side="right") - 1, 0)
        before = np.where(before == np.arange(time.size), np.maximum(before - 1, 0), before)
        elapsed = np.maximum(time - time[before], 1e-9)
        speed[missing] = ((angle - angle[before]) / elapsed)[missing]
    return speed


def _segments(rows: FloatArray, good: BoolArray, period: float, averaged: int) -> list[JointSegment]:
    """Make a segment of the good rows, averaged in groups that do not span gaps; none if they are too few."""
    place = np.flatnonzero(good)
    apart = np.diff(rows[place, 0]) > GAP * period
    starts = np.concatenate([[True], apart | (np.diff(place) > 1)])
    within = np.arange(place.size) - np.flatnonzero(starts)[np.cumsum(starts) - 1]
    group = np.flatnonzero(within % averaged == 0)
    whole = group[np.diff(np.append(group, place.size)) == averaged]
    if whole.size < SHORTEST:
        return []
    _, angle, pace, values = rows[place[whole[:, None] + np.arange(averaged)]].mean(axis=1).T
    segment = JointSegment(
        direction=1 if float(pace.mean()) > 0.0 else -1,
        angle=angle,
        speed=np.abs(pace),
        values=values,
        starts=np.concatenate([[True], np.diff(whole) != averaged]) | starts[whole],
        averaged=averaged,
        rate=1.0 / (period * averaged),
    )
    return [segment]


def one_speed(segments: Iterable[JointSegment]) -> float:
    """Output speed [rad/s] if nearly all of the motion was at one; NaN if it varied.

    At one speed a fixed frequency of the machine, or a tone of its supply, looks the same as a line.
    """
    speeds = [segment.speed for segment in segments]
    if not speeds:
        return math.nan
    low, middle, high = np.percentile(np.concatenate(speeds), [25.0, 50.0, 75.0]).tolist()
    return float(middle) if high - low < ONE_SPEED * middle else math.nan

"""The joint's motion between its messages: angle, speed and torque at any time."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..interpolation import hermite, linear
from .clock import recover_clock

FloatArray = npt.NDArray[np.float64]

_LARGEST_HOLE = 0.25  # s; a joint can change its speed within that in ways that no interpolation knows
_HOLE_PERIODS = 5.0
_ENOUGH_EFFORT = 0.5  # of the messages: torque is slow, so that single missing efforts are bridged
_FEWEST_TO_EVEN = 16  # messages
_JITTER_NOTICED = 20e-6  # s
_CLEARLY_BETTER = 0.5  # of the squared contradiction between position and velocity


class Motion(NamedTuple):
    """Output angle [rad], output speed [rad/s] and torque [N·m] at some times, shape (N,) each; NaN where unknown."""

    angle: FloatArray
    speed: FloatArray
    torque: FloatArray


def even_stamps(times: FloatArray, rows: FloatArray) -> FloatArray:
    """Take jitter off the stamps of joint states, where the joint's own motion proves that it is jitter.

    Drivers sample evenly but often stamp in passing. Position and velocity tell which of the two clocks is true: the
    one on which the position moves as the velocity says. At 3000 rpm a jitter of 1 ms would shift the lines' phase by
    half a radian.

    Parameters
    ----------
    times : ndarray, shape (N,)
        Stamps [s], increasing.
    rows : ndarray, shape (N, 3)
        Position [rad], velocity [rad/s], effort [N·m].

    Returns
    -------
    ndarray, shape (N,)
        Evened times [s], or `times` where evening them does not explain the motion clearly better.
    """
    if times.size < _FEWEST_TO_EVEN or not np.isfinite(rows[:, :2]).all():
        return times
    if float(np.ptp(np.diff(times))) < _JITTER_NOTICED:
        return times
    clock = recover_clock(times)
    if clock is None or clock.order.size != times.size or clock.jitter < _JITTER_NOTICED:
        return times
    even: FloatArray = np.asarray(clock.start + clock.period * clock.number, dtype=np.float64)
    if clock.jitter > 0.5 * clock.period or not np.array_equal(clock.order, np.arange(times.size)):
        return times
    moved, velocity = np.diff(np.unwrap(rows[:, 0])), rows[:, 1]
    mean = 0.5 * (velocity[1:] + velocity[:-1])
    as_stamped, as_evened = (float(np.sum((moved - mean * np.diff(t)) ** 2)) for t in (times, even))
    return even if as_evened < _CLEARLY_BETTER * as_stamped else times


class MotionTrack:
    """Joint states as a function of time, fed a stretch at a time.

    The angle is unwrapped: a joint that reports -π after π is taken to go on turning.
    """

    def __init__(self) -> None:
        self._times = np.empty(0)
        self._rows = np.empty((0, 3))

    def extend(self, times: FloatArray, rows: FloatArray) -> int:
        """Append messages: times [s], shape (N,), increasing, and rows (position, velocity, effort), shape (N, 3).

        Returns the number of messages left out: not finite in position, or not later than the one before.
        """
        good = np.isfinite(rows[:, 0])
        if self._times.size:
            good &= times > self._times[-1]
        good[1:] &= times[1:] > times[:-1]
        dropped = int(times.size - np.count_nonzero(good))
        if dropped:
            times, rows = times[good], rows[good]
        if not times.size:
            return dropped
        self._times = np.concatenate([self._times, times])
        self._rows = np.concatenate([self._rows, rows])
        angle = self._rows[:, 0]
        if float(np.abs(angle[1:] - angle[:-1]).max(initial=0.0)) > math.pi:
            self._rows[:, 0] = np.unwrap(angle)
        return dropped

    def forget_before(self, time: float) -> None:
        """Drop what is no longer needed to interpolate from `time` [s] on."""
        first = max(0, int(np.searchsorted(self._times, time)) - 2)
        if first:
            self._times, self._rows = self._times[first:], self._rows[first:]

    def forget_from(self, time: float) -> None:
        """Drop the messages of `time` [s] and later: they were only lent to close an interval."""
        last = int(np.searchsorted(self._times, time))
        self._times, self._rows = self._times[:last], self._rows[:last]

    def clear(self) -> None:
        """Forget everything."""
        self._times = np.empty(0)
        self._rows = np.empty((0, 3))

    def at(self, times: FloatArray) -> Motion:
        """Interpolate at `times` [s], shape (N,); NaN outside of the track and in its holes."""
        unknown = np.full(times.size, np.nan)
        if self._times.size < 2 or not times.size:
            return Motion(unknown, unknown, unknown)
        known, rows = self._times, self._rows
        steps = known[1:] - known[:-1]
        velocity = rows[:, 1]
        finite = np.isfinite(velocity)
        if not finite.all():
            velocity = np.where(finite, velocity, np.gradient(rows[:, 0], known))
        place = np.clip(known.searchsorted(times, side="right"), 1, known.size - 1) - 1
        length = steps[place]
        part = (times - known[place]) / length
        first, last = rows[place], rows[place + 1]
        velocities = velocity[place], velocity[place + 1]
        angle = hermite(first[:, 0], last[:, 0], velocities[0] * length, velocities[1] * length, part)
        speed = linear(*velocities, part)
        effort = rows[:, 2]
        measured = np.isfinite(effort)
        if measured.all():
            torque = linear(first[:, 2], last[:, 2], part)
        elif np.count_nonzero(measured) >= max(2, _ENOUGH_EFFORT * effort.size):
            torque = np.interp(times, known[measured], effort[measured])
        else:
            torque = unknown.copy()
        outside = (times < known[0]) | (times > known[-1])
        longest = float(steps.max())
        if longest > _largest_gap(float(steps.min())):  # the median is not below the least: only now it is wanted
            outside |= length > _largest_gap(float(np.median(steps)))
        if outside.any():
            for values in (angle, speed, torque):
                values[outside] = np.nan
        return Motion(angle, speed, torque)


def _largest_gap(step: float) -> float:
    """Time [s] between two messages that interpolation bridges where their typical distance is `step`."""
    return min(_LARGEST_HOLE, _HOLE_PERIODS * step + 0.02)

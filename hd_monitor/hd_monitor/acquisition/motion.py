"""The joint's motion between its messages: angle, speed and torque at any time."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import BoolArray, FloatArray
from .clock import recover_clock

LARGEST = 1e12
"""Position [rad], velocity [rad/s] or torque [N·m] up to which a message is believed: beyond it, neighbouring
floating-point numbers are more than 1e-4 apart, which turns a line visibly, and squares and sums soon overflow."""

_LARGEST_HOLE = 0.25  # s; within that, a joint's speed can change in ways that interpolation cannot follow
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
    """Remove jitter from the stamps of joint states where the joint's own motion proves that it is jitter.

    Drivers sample evenly but often stamp unevenly. Position and velocity show which of the two clocks is true: the
    one on which the position changes as the velocity says. At 3000 rpm a jitter of 1 ms would shift the lines' phase by
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
    if times.size < _FEWEST_TO_EVEN:
        return times
    steps = times[1:] - times[:-1]
    if float(steps.max() - steps.min()) < _JITTER_NOTICED or not np.isfinite(rows[:, :2]).all():
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


class Track:
    """Stamped rows, fed a stretch at a time and kept as long as interpolation needs them."""

    columns: int
    """Values in a row."""

    def __init__(self) -> None:
        self._times = np.empty(0)
        self._rows = np.empty((0, self.columns))

    def extend(self, times: FloatArray, rows: FloatArray) -> BoolArray:
        """Append rows, shape (N, columns), with their times [s], shape (N,), increasing.

        Returns which ones were taken, shape (N,): finite in the first column, nowhere beyond `LARGEST`, and later than
        the one before.
        """
        good = np.isfinite(rows[:, 0]) & ~(np.abs(rows) > LARGEST).any(axis=1)
        if self._times.size:
            good &= times > self._times[-1]
        good[1:] &= times[1:] > times[:-1]
        if not good.all():
            times, rows = times[good], rows[good]
        if times.size:
            self._times = np.concatenate([self._times, times])
            self._rows = np.concatenate([self._rows, rows])
        return good

    def forget(self, time: float, reach: float = 0.0) -> None:
        """Drop what interpolation from `reach` before `time` [s] does not need, and rows from `time` on: they recur."""
        last = int(self._times.searchsorted(time))
        first = max(0, (int(self._times.searchsorted(time - reach)) if reach else last) - 2)
        self._times, self._rows = self._times[first:last], self._rows[first:last]


class TorqueTrack(Track):
    """A measured torque as a function of time."""

    columns = 1

    def at(self, times: FloatArray) -> FloatArray:
        """Interpolate the torque [N·m] at rising `times` [s], shape (N,); NaN outside of the track and in its holes."""
        known = self._times
        if known.size < 2:
            return np.full(times.size, np.nan)
        torque = np.interp(times, known, self._rows[:, 0], left=np.nan, right=np.nan)
        steps = np.diff(known)
        longest = _largest_gap(float(np.median(steps)))
        if steps.max() > longest:
            torque[np.repeat(steps, _in_each(known, times)) > longest] = np.nan
        return torque


class MotionTrack(Track):
    """Joint states as a function of time: position [rad], velocity [rad/s], effort [N·m].

    The angle is unwrapped: a joint that reports -π after π is assumed to go on turning.
    """

    columns = 3

    def extend(self, times: FloatArray, rows: FloatArray) -> BoolArray:
        """Append joint states; see :meth:`Track.extend`."""
        good = super().extend(times, rows)
        angle = self._rows[:, 0]
        steps = angle[1:] - angle[:-1]
        if steps.size and (steps.max() > math.pi or steps.min() < -math.pi):
            self._rows[:, 0] = np.unwrap(angle)
        return good

    def at(self, times: FloatArray) -> Motion:
        """Interpolate at rising `times` [s], shape (N,); NaN outside of the track and in its holes.

        The angle follows the cubic (Hermite) that has the messages' positions and velocities at both ends.
        """
        known, rows = self._times, self._rows
        if known.size < 2 or not times.size:
            return Motion(*np.full((3, times.size), np.nan))
        steps = known[1:] - known[:-1]
        position, velocity, effort = rows[:, 0], rows[:, 1], rows[:, 2]
        if not np.isfinite(velocity).all():
            velocity = np.where(np.isfinite(velocity), velocity, np.gradient(position, known))
        measured = np.isfinite(effort)
        polynomials = np.empty((10, steps.size))  # of every interval, then of the times: far fewer gathers and products
        polynomials[0], polynomials[1] = known[:-1], steps
        rise, slope, next_slope = position[1:] - position[:-1], velocity[:-1] * steps, velocity[1:] * steps
        polynomials[2], polynomials[3] = position[:-1], slope
        polynomials[4], polynomials[5] = 3.0 * rise - 2.0 * slope - next_slope, slope + next_slope - 2.0 * rise
        polynomials[6], polynomials[7] = velocity[:-1], velocity[1:] - velocity[:-1]
        polynomials[8], polynomials[9] = effort[:-1], effort[1:] - effort[:-1]
        start, length, q0, q1, q2, q3, v0, v1, e0, e1 = np.repeat(polynomials, _in_each(known, times), axis=1)
        part = (times - start) / length
        angle = q0 + part * (q1 + part * (q2 + part * q3))
        speed = v0 + part * v1
        if measured.all():
            torque = e0 + part * e1
        elif np.count_nonzero(measured) >= max(2, _ENOUGH_EFFORT * effort.size):
            torque = np.interp(times, known[measured], effort[measured])
        else:
            torque = np.full(times.size, np.nan)
        outside: list[slice | BoolArray] = []
        if times[0] < known[0]:
            outside.append(slice(0, int(times.searchsorted(known[0]))))
        if times[-1] > known[-1]:
            outside.append(slice(int(times.searchsorted(known[-1], side="right")), None))
        longest = float(steps.max())
        if longest > _largest_gap(float(steps.min())):  # the median is not below the least: only now it is wanted
            outside.append(length > _largest_gap(float(np.median(steps))))
        for place in outside:
            for values in (angle, speed, torque):
                values[place] = np.nan
        return Motion(angle, speed, torque)


def _in_each(known: FloatArray, times: FloatArray) -> npt.NDArray[np.intp]:
    """Count the rising `times` in each interval between rising `known` ones; those outside go to the outermost."""
    counts = np.empty(known.size - 1, dtype=np.intp)
    edges = times.searchsorted(known[1:-1])
    counts[:-1] = edges
    counts[-1] = times.size
    counts[1:] -= edges
    return counts


def _largest_gap(step: float) -> float:
    """Time [s] between two messages that interpolation bridges where their typical distance is `step`."""
    return min(_LARGEST_HOLE, _HOLE_PERIODS * step + 0.02)

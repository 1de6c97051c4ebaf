"""A wave-generator speed that is piecewise linear in time, and its exact angle."""

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.errors import ParameterError

RPM = math.tau / 60.0
"""One revolution per minute in rad/s."""


class Ripple(NamedTuple):
    """Speed ripple tied to the wave generator, as a motor's torque ripple or a bent shaft causes it."""

    amplitude: float = 0.0
    """Fraction of the speed."""
    order: float = 2.0
    """Cycles per wave-generator revolution."""
    phase: float = 0.0
    """[rad]"""


NO_RIPPLE = Ripple()


class Course(NamedTuple):
    """What a programme demands, in arrays of the shape of the times; all before the reducer."""

    angle: FloatArray
    """Wave-generator angle φ [rad], 0 at the start."""
    speed: FloatArray
    """[rad/s]"""
    acceleration: FloatArray
    """[rad/s²]"""
    carried: FloatArray | float
    """Fraction of the payload that is carried."""


class SpeedProgramme:
    """Speed of the wave generator over time: straight lines between corners, once, several times or forever.

    Parameters
    ----------
    times : array_like, shape (corners,)
        Times of the corners [s], rising from 0; the last one ends a cycle.
    speeds : array_like, shape (corners,)
        Wave-generator speeds [rpm] there; negative ones turn back.
    cycles : int
        How often the corners are run through; 0: forever.
    ripple : Ripple
        Multiplies the speed by ``1 + amplitude cos(order φ0 + phase)``, where φ0 is the angle without ripple.
    carried : array_like, shape (corners,), optional
        Fraction of the payload carried at the corners; it passes from one to the next as half a cosine wave.

    Raises
    ------
    ParameterError
        If the corners are not in order, the speed or the payload would jump where a cycle joins the next, or the
        ripple would turn the wave generator back.

    Examples
    --------
    Up to 600 rpm in one second, held for one:

    >>> programme = SpeedProgramme(times=[0.0, 1.0, 2.0], speeds=[0.0, 600.0, 600.0], cycles=1)
    >>> round(float(programme.angle(2.0)) / (2 * np.pi), 12)
    15.0
    """

    def __init__(
        self,
        *,
        times: npt.ArrayLike,
        speeds: npt.ArrayLike,
        cycles: int = 0,
        ripple: Ripple = NO_RIPPLE,
        carried: npt.ArrayLike | None = None,
    ) -> None:
        self.times: FloatArray = np.array(times, dtype=np.float64)
        self.speeds: FloatArray = np.array(speeds, dtype=np.float64)
        self.cycles = cycles
        self.ripple = ripple
        self.carried: FloatArray = np.zeros(self.times.shape) if carried is None else np.array(carried, np.float64)
        self._check()
        lengths = np.diff(self.times)
        self._carries = bool(self.carried.any())
        self._lengths: FloatArray = np.append(lengths, math.inf)
        steps = 0.5 * RPM * (self.speeds[1:] + self.speeds[:-1]) * lengths
        # The last speed is held beyond the last corner: joint states may fall a little beyond the end.
        self._slopes: FloatArray = np.append(RPM * np.diff(self.speeds) / lengths, 0.0)
        self._angles: FloatArray = np.concatenate([[0.0], np.cumsum(steps)])

    def _check(self) -> None:
        times, speeds = self.times, self.speeds
        if times.ndim != 1 or times.shape != speeds.shape or times.size < 2:
            raise ParameterError(
                f"{times.size} times and {speeds.size} speeds do not make a programme; give at least two of each"
            )
        if times[0] != 0.0 or not np.all(np.diff(times) > 0.0) or not np.all(np.isfinite(times)):
            raise ParameterError(f"times {times.tolist()} s do not rise from 0; give the corners in their order")
        if not np.all(np.isfinite(speeds)):
            raise ParameterError(f"speeds {speeds.tolist()} rpm are not all finite; give plain numbers")
        if self.cycles < 0:
            raise ParameterError(f"cycles = {self.cycles} is negative; give 0 for a programme without end")
        if self.cycles != 1 and speeds[-1] != speeds[0]:
            raise ParameterError(
                f"a cycle ends at {speeds[-1]:g} rpm and the next begins at {speeds[0]:g} rpm: a drive cannot jump; "
                "give cycles = 1 or a last corner at the first speed"
            )
        if self.carried.shape != times.shape or not np.all((self.carried >= 0.0) & (self.carried <= 1.0)):
            raise ParameterError(
                f"{self.carried.size} fractions of the payload for {times.size} corners, from "
                f"{self.carried.min(initial=0.0):g} to {self.carried.max(initial=0.0):g}; give one from 0 to 1 a corner"
            )
        if self.cycles != 1 and self.carried[-1] != self.carried[0]:
            raise ParameterError(
                f"a cycle ends with {self.carried[-1]:g} of the payload and the next begins with {self.carried[0]:g}; "
                "give cycles = 1 or the same fraction at both ends"
            )
        if not 0.0 <= self.ripple.amplitude < 1.0 or not all(map(math.isfinite, self.ripple)):
            raise ParameterError(
                f"a speed ripple of amplitude {self.ripple.amplitude:g} would stop or reverse the wave generator; "
                "give a fraction of at least 0 and below 1"
            )

    @property
    def cycle_duration(self) -> float:
        """Duration of one cycle [s]."""
        return float(self.times[-1])

    @property
    def duration(self) -> float:
        """Duration of the whole programme [s]; infinite if it has no end."""
        return self.cycles * self.cycle_duration if self.cycles else math.inf

    def course(self, times: npt.ArrayLike) -> Course:
        """Everything that the programme demands at `times` [s], any shape."""
        t = np.asarray(times, dtype=np.float64)
        cycle, rest = self._cycle(t)
        piece = np.clip(np.searchsorted(self.times, rest, side="right") - 1, 0, self.times.size - 1)
        since = rest - self.times[piece]
        start, slope = RPM * self.speeds[piece], self._slopes[piece]
        angle = cycle * self._angles[-1] + self._angles[piece] + (start + 0.5 * slope * since) * since
        speed, acceleration = start + slope * since, slope
        amplitude, order, phase = self.ripple
        if amplitude:
            turn = order * angle + phase
            factor = 1.0 + amplitude * np.cos(turn)
            acceleration = slope * factor - amplitude * order * speed**2 * np.sin(turn)
            speed = speed * factor
            angle = angle + amplitude / order * (np.sin(turn) - math.sin(phase)) if order else angle * factor
        return Course(angle, speed, acceleration, self._carried(piece, since))

    def angle(self, times: npt.ArrayLike) -> FloatArray:
        """Wave-generator angle φ [rad] at `times` [s], any shape; 0 at the start, exact to rounding."""
        return self.course(times).angle

    def speed(self, times: npt.ArrayLike) -> FloatArray:
        """Wave-generator speed [rad/s] at `times` [s], any shape."""
        return self.course(times).speed

    def acceleration(self, times: npt.ArrayLike) -> FloatArray:
        """Wave-generator acceleration [rad/s²] at `times` [s], any shape; at a corner that of the next piece."""
        return self.course(times).acceleration

    def corners(self, start: float, end: float) -> FloatArray:
        """Times [s] of the corners after `start` and up to `end` [s]; there the acceleration jumps."""
        (first, last), _ = self._cycle(np.array([start, end]))
        found = []
        for cycle in range(int(first), int(last) + 1):
            begin = cycle * self.cycle_duration
            inside = slice(*np.searchsorted(self.times, [start - begin, end - begin], side="right"))
            found.append(begin + self.times[inside])
        return np.concatenate(found)

    def strokes(self, times: npt.ArrayLike) -> IntArray:
        """Strokes begun by `times` [s], any shape: moves out of a standstill or a reversal."""
        cycle, rest = self._cycle(np.asarray(times, dtype=np.float64))
        begun = np.searchsorted(self._stroke_starts, rest, side="right")
        return np.asarray(cycle * self._stroke_starts.size + begun, dtype=np.int64)

    def _cycle(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Number of the cycle and the time [s] since its start; the last cycle goes on beyond its end."""
        cycle = np.floor(times / self.cycle_duration)
        if self.cycles:
            cycle = np.minimum(cycle, self.cycles - 1)
        return cycle, times - cycle * self.cycle_duration

    def _carried(self, piece: IntArray, since: FloatArray) -> FloatArray | float:
        if not self._carries:
            return 0.0
        start, end = self.carried[piece], self.carried[np.minimum(piece + 1, self.carried.size - 1)]
        return np.asarray(start + 0.5 * (end - start) * (1.0 - np.cos(np.pi / self._lengths[piece] * since)))

    @cached_property
    def _stroke_starts(self) -> FloatArray:
        """Times [s] within a cycle at which a stroke begins."""
        before, after = self.speeds[:-1], self.speeds[1:]
        departs = (before == 0.0) & (after != 0.0)
        reverses = np.sign(before) * np.sign(after) < 0.0  # the product itself may underflow
        share = np.divide(before, before - after, out=np.zeros(before.size), where=reverses)
        starts: FloatArray = self.times[:-1] + share * self._lengths[:-1]
        return np.asarray(starts[departs | reverses])

    def visited_speeds(self, spacing: float = 25.0) -> FloatArray:
        """Speeds [rpm] without sign that the programme holds, and those it passes at every `spacing` rpm; sorted."""
        speeds = np.abs(self.speeds)
        held = speeds[:-1][self.speeds[:-1] == self.speeds[1:]]
        crossing = np.sign(self.speeds[1:]) * np.sign(self.speeds[:-1]) < 0.0
        lowest = 0.0 if crossing.any() else float(speeds.min())
        highest = float(speeds.max())
        passed = np.arange(math.ceil(lowest / spacing), math.floor(highest / spacing) + 1) * spacing
        return np.unique(np.concatenate([held, passed, [lowest, highest]]))

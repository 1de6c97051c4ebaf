"""A wave-generator speed that is piecewise linear in time, and its exact angle."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hd_monitor.arrays import FloatArray
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

    Raises
    ------
    ParameterError
        If the corners are not in order, the speed would jump where a cycle joins the next, or the ripple would turn
        the wave generator back.

    Examples
    --------
    Up to 600 rpm in one second, held for one:

    >>> programme = SpeedProgramme(times=[0.0, 1.0, 2.0], speeds=[0.0, 600.0, 600.0], cycles=1)
    >>> round(float(programme.angle(2.0)) / (2 * np.pi), 12)
    15.0
    """

    def __init__(
        self, *, times: npt.ArrayLike, speeds: npt.ArrayLike, cycles: int = 0, ripple: Ripple = NO_RIPPLE
    ) -> None:
        self.times: FloatArray = np.array(times, dtype=np.float64)
        self.speeds: FloatArray = np.array(speeds, dtype=np.float64)
        self.cycles = cycles
        self.ripple = ripple
        self._check()
        lengths = np.diff(self.times)
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

    def angle(self, times: npt.ArrayLike) -> FloatArray:
        """Wave-generator angle φ [rad] at `times` [s], any shape; 0 at the start, exact to rounding."""
        angle, _, _ = self._plain(times)
        amplitude, order, phase = self.ripple
        if not order:
            return angle * (1.0 + amplitude * math.cos(phase))
        return angle + amplitude / order * (np.sin(order * angle + phase) - math.sin(phase))

    def speed(self, times: npt.ArrayLike) -> FloatArray:
        """Wave-generator speed [rad/s] at `times` [s], any shape."""
        angle, speed, _ = self._plain(times)
        return speed * (1.0 + self.ripple.amplitude * np.cos(self.ripple.order * angle + self.ripple.phase))

    def acceleration(self, times: npt.ArrayLike) -> FloatArray:
        """Wave-generator acceleration [rad/s²] at `times` [s], any shape; at a corner that of the next piece."""
        angle, speed, slope = self._plain(times)
        amplitude, order, phase = self.ripple
        turn = order * angle + phase
        return slope * (1.0 + amplitude * np.cos(turn)) - amplitude * order * speed**2 * np.sin(turn)

    def _plain(self, times: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Angle, speed and acceleration without the ripple."""
        t = np.asarray(times, dtype=np.float64)
        cycle = np.floor(t / self.cycle_duration)
        if self.cycles:
            cycle = np.minimum(cycle, self.cycles - 1)
        rest = t - cycle * self.cycle_duration
        piece = np.clip(np.searchsorted(self.times, rest, side="right") - 1, 0, self.times.size - 1)
        since = rest - self.times[piece]
        start, slope = RPM * self.speeds[piece], self._slopes[piece]
        angle = cycle * self._angles[-1] + self._angles[piece] + (start + 0.5 * slope * since) * since
        return angle, start + slope * since, slope

    def visited_speeds(self, spacing: float = 25.0) -> FloatArray:
        """Speeds [rpm] without sign that the programme holds, and those it passes at every `spacing` rpm; sorted."""
        speeds = np.abs(self.speeds)
        held = speeds[:-1][self.speeds[:-1] == self.speeds[1:]]
        crossing = np.sign(self.speeds[1:]) * np.sign(self.speeds[:-1]) < 0.0
        lowest = 0.0 if crossing.any() else float(speeds.min())
        highest = float(speeds.max())
        passed = np.arange(math.ceil(lowest / spacing), math.floor(highest / spacing) + 1) * spacing
        return np.unique(np.concatenate([held, passed, [lowest, highest]]))

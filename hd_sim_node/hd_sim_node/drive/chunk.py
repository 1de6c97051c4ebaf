"""A stretch of the rig's motion, as the integration leaves it."""

from dataclasses import dataclass, fields, replace
from typing import Self

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from hd_monitor.arrays import FloatArray

from .equation import State


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigChunk:
    """A stretch of the rig's motion.

    Attributes
    ----------
    first : int
        Number of its first sample since the start.
    times : ndarray, shape (samples,)
        Sampling instants [s] since the start.
    angle, speed, rigid_acceleration : ndarray, shape (samples,)
        Output angle q [rad], its rate [rad/s], and what an accelerometer feels of the motion itself [rad/s²].
    displacement, velocity, acceleration : ndarray, shape (samples,)
        Torsional vibration θ [rad], θ' [rad/s], θ'' [rad/s²].
    torque : ndarray, shape (samples,)
        Torque M on the output [N·m].
    """

    first: int
    times: FloatArray
    angle: FloatArray
    speed: FloatArray
    rigid_acceleration: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    _fine_times: FloatArray
    _fine: State

    def __len__(self) -> int:
        """Return the number of samples."""
        return int(self.times.size)

    def thinned(self, every: int) -> Self:
        """Keep every `every`-th sample of a stretch that begins with such a one."""
        if every == 1:
            return self
        columns = [field.name for field in fields(self) if not field.name.startswith("_") and field.name != "first"]
        return replace(self, first=self.first // every, **{name: getattr(self, name)[::every] for name in columns})

    def vibration_at(self, times: FloatArray) -> State:
        """State at `times` [s] within this stretch, by the integration's own cubic pieces (hysteresis: by lines)."""
        displacement, velocity, hysteresis = self._fine
        spline = CubicHermiteSpline(self._fine_times, displacement, velocity)
        return State(spline(times), spline(times, nu=1), np.interp(times, self._fine_times, hysteresis))

"""The rig in motion: the parametric model integrated along a speed programme, a stretch at a time."""

import math
from dataclasses import KW_ONLY, dataclass, field, replace

import numpy as np
import numpy.typing as npt

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.errors import ParameterError
from hd_monitor.model import Oscillator, ParametricModel, Response
from hd_monitor.model.oscillator import GAUSS_OFFSETS
from hd_monitor.reducer import WAVE_GENERATOR_LOBES

from ..motion.programme import SpeedProgramme
from .chunk import RigChunk
from .surroundings import Motion, Surroundings

PHASE_STEP = 0.25
"""Longest integration step, in radians of the fastest of natural vibration and stiffness harmonics: good to 1e-6."""


@dataclass(eq=False)
class Rig:
    """A drive, a reducer with its defects and an inertia, turned by a speed programme.

    It starts at its static wind-up. The result does not depend on how it is cut into stretches.

    Parameters
    ----------
    model : ParametricModel
        May be replaced while it runs (attribute `model`): the state carries on.
    programme : SpeedProgramme
    rate : float
        Samples per second [Hz]. The integration takes finer steps where accuracy requires it.
    start_angle : float
        Output angle q [rad] at the start.
    surroundings : Surroundings, optional

    Raises
    ------
    ParameterError
        If the rate is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> from hd_monitor.model import ParametricModel, StiffnessSeries
    >>> still = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 0.0])
    >>> model = ParametricModel(flexspline=StiffnessSeries((0.05, 0.03)))
    >>> chunk = Rig(model, still, rate=1000.0).advance(500)
    >>> bool(np.abs(chunk.acceleration).max() < 1e-9)  # at rest nothing vibrates
    True
    """

    model: ParametricModel
    programme: SpeedProgramme
    _: KW_ONLY
    rate: float
    start_angle: float = 0.0
    surroundings: Surroundings = field(default_factory=Surroundings)
    _next: int = field(default=0, init=False)
    _state: tuple[float, float] | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        """Check the rate."""
        if not (math.isfinite(self.rate) and self.rate > 0.0):
            raise ParameterError(f"rate = {self.rate!r} Hz is not a sampling rate; give a number above 0")

    def angle(self, times: npt.ArrayLike) -> FloatArray:
        """Output angle q [rad] at `times` [s]."""
        return self.start_angle + self.programme.angle(times) / self.model.reducer.reduction

    def speed(self, times: npt.ArrayLike) -> FloatArray:
        """Output speed [rad/s] at `times` [s]."""
        return self.programme.speed(times) / self.model.reducer.reduction

    def motion(self, times: npt.ArrayLike) -> Motion:
        """Motion that the programme demands of the output at `times` [s], any shape."""
        t = np.asarray(times, dtype=np.float64)
        course, reduction = self.programme.course(t), self.model.reducer.reduction
        angle = self.start_angle + course.angle / reduction
        return Motion(
            times=t,
            angle=angle,
            speed=course.speed / reduction,
            acceleration=course.acceleration / reduction,
            turn=reduction * angle,
            carried=course.carried,
        )

    def rigid_acceleration(self, times: npt.ArrayLike) -> FloatArray:
        """Acceleration [rad/s²] of the output along the programme at `times` [s]; 0 where it is left out."""
        return self.motion(times).acceleration if self.surroundings.rigid_body else np.zeros(np.shape(times))

    def torque(self, times: npt.ArrayLike, *, drive: bool = True) -> FloatArray:
        """Torque M [N·m] that winds up the reducer at `times` [s], with or without the drive's own fluctuation."""
        motion = self.motion(times)
        model = self.model if drive else replace(self.model, torque=replace(self.model.torque, drive_fluctuation=0.0))
        own = model.torque_at(motion.angle)
        return np.asarray(self.surroundings.torque(motion, model.dynamics.inertia, own=own, drive=drive))

    def reaction(self, times: npt.ArrayLike, vibration: Response) -> FloatArray:
        """Torque [N·m] that the reducer transmits at `times` [s]: of its stiffness and its damping."""
        dynamics, omega = self.model.dynamics, self.model.dynamics.angular_frequency
        stiffness = omega**2 * (1.0 + self.model.stiffness_fluctuation(self.angle(times)))
        damping = 2.0 * dynamics.damping_ratio * omega
        return dynamics.inertia * (stiffness * vibration.displacement + damping * vibration.velocity)

    def advance(self, count: int) -> RigChunk:
        """Simulate the next `count` samples.

        Raises
        ------
        ParameterError
            If `count` is not positive.
        """
        if count < 1:
            raise ParameterError(f"count = {count} is not a number of samples; give at least 1")
        model, inertia = self.model, self.model.dynamics.inertia
        index = self._next + np.arange(count + 1)
        substeps = self._substeps(index)
        place = np.repeat(np.arange(count), substeps)
        ends = np.cumsum(substeps)
        within = np.arange(ends[-1]) - np.repeat(ends - substeps, substeps)
        steps = 1.0 / (self.rate * substeps[place])
        gauss = np.stack([(index[place] + (within + c) / substeps[place]) / self.rate for c in GAUSS_OFFSETS])
        # Torque and stiffness at the Gauss points, then one scan over all steps.
        oscillator = Oscillator(model.dynamics, model.stiffness_fluctuation(self.angle(gauss)), steps)
        times = index[:-1] / self.rate
        angle, torque = self.angle(times), self.torque(times)
        if self._state is None:
            self._state = (float(torque[0] / model.stiffness(angle[0])), 0.0)
        fine = oscillator.respond(self.torque(gauss) / inertia, self._state)
        at = ends - substeps
        displacement, velocity = fine.displacement[at], fine.velocity[at]
        self._state = (float(fine.displacement[-1]), float(fine.velocity[-1]))
        first, self._next = self._next, self._next + count
        # Eq. 3 at the sampling instants; the model knows its own torques, the surroundings' come on top.
        extra = (torque - model.torque_at(angle)) / inertia
        return RigChunk(
            first=first,
            times=times,
            angle=angle,
            speed=self.speed(times),
            rigid_acceleration=self.rigid_acceleration(times),
            displacement=displacement,
            velocity=velocity,
            acceleration=model.acceleration(angle, displacement, velocity) + extra,
            torque=torque,
            _fine_times=np.append((index[place] + within / substeps[place]) / self.rate, index[-1] / self.rate),
            _fine=fine,
        )

    def _substeps(self, index: IntArray) -> IntArray:
        """Steps in each sampling interval: enough for the fastest thing that happens in it."""
        model = self.model
        orders = model.reducer.output_orders
        top = max(
            len(model.circular_spline.beta) * orders.circular_spline,
            len(model.flexspline.beta) * orders.flexspline,
            WAVE_GENERATOR_LOBES * model.reducer.reduction,
        )
        speed = np.abs(self.speed(index / self.rate))
        fluctuation = sum(map(abs, model.circular_spline.beta)) + sum(map(abs, model.flexspline.beta))
        natural = model.dynamics.angular_frequency * math.sqrt(1.0 + fluctuation)
        fastest = np.maximum(natural, top * np.maximum(speed[1:], speed[:-1]))
        return np.maximum(1, np.ceil(fastest / (self.rate * PHASE_STEP))).astype(np.int64)

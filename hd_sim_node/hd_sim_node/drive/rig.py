"""The rig in motion: the drive integrated along a speed programme, a stretch at a time."""

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.errors import ParameterError
from hd_monitor.model import Oscillator, ParametricModel
from hd_monitor.model.oscillator import GAUSS_OFFSETS
from hd_monitor.reducer import WAVE_GENERATOR_LOBES

from ..motion.programme import SpeedProgramme
from .chunk import RigChunk
from .effects import Effects, coefficients, grown, laws
from .equation import Coefficients, State, march
from .steps import Steps
from .surroundings import Motion, Surroundings

PHASE_STEP = 0.25
"""Longest step of the scan, in radians of the fastest of natural vibration and stiffness harmonics: good to 1e-6."""

MARCH_NATURAL, MARCH_FORCED, MARCH_FRICTION = 0.08, 0.3, 0.2
"""Longest step where the drive is not linear, for errors of 1e-5 of θ'': in radians of natural vibration, in radians
of the fastest excitation, and in time constants of friction at standstill."""

_TOGETHER = 1_000_000
"""Steps times drives whose coefficients are held at once: some 250 MB."""


@dataclass(eq=False)
class Rig:
    """A drive, a reducer with its defects and an inertia, turned by a speed programme.

    It starts at its static wind-up. The result does not depend on how it is cut into stretches.

    Parameters
    ----------
    model : ParametricModel
    programme : SpeedProgramme
    rate : float
        Samples per second [Hz]. The integration takes finer steps where accuracy requires it.
    start_angle : float
        Output angle q [rad] at the start.
    surroundings : Surroundings, optional
    effects : Effects, optional
        What the model leaves out. Like model and surroundings it may be replaced while the rig runs.

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
    effects: Effects = field(default_factory=Effects)
    _next: int = field(default=0, init=False)
    _state: State | None = field(default=None, init=False)

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

    def torque(self, times: npt.ArrayLike, *, drive: bool = True) -> FloatArray:
        """Torque M [N·m] that winds up the reducer at `times` [s], with or without the drive's own fluctuation."""
        motion = self.motion(times)
        model = self.model if drive else replace(self.model, torque=replace(self.model.torque, drive_fluctuation=0.0))
        own = model.torque_at(motion.angle)
        return np.asarray(self.surroundings.torque(motion, model.dynamics.inertia, own=own, drive=drive))

    def coefficients(self, times: npt.ArrayLike) -> Coefficients:
        """Coefficients of the equation of motion at `times` [s], any shape."""
        counted = self.effects.growth.unit == "strokes"
        strokes = np.asarray(self.programme.strokes(times) if counted else 0, dtype=np.float64)
        return coefficients(self.model, self.effects, self.surroundings, self.motion(times), strokes)

    def transmitted(self, times: npt.ArrayLike) -> FloatArray:
        """Torque [N·m] that winds up the reducer at `times` [s] without vibration and ripple: friction is taken off."""
        t = np.asarray(times, dtype=np.float64)
        return self.torque(t, drive=False) - self.effects.friction_torque(t, self.speed(t))

    def reaction(self, times: npt.ArrayLike, state: State) -> FloatArray:
        """Torque [N·m] that the reducer transmits at `times` [s], given the vibration there: what J θ'' leaves of M."""
        t = np.asarray(times, dtype=np.float64)
        inertia = self.model.dynamics.inertia * self.surroundings.inertia_factor(self.motion(t))
        acceleration = laws([(self.model, self.effects)]).acceleration(self.coefficients(t), *state)
        friction = self.effects.friction_torque(t, self.speed(t) + state.velocity)
        return np.asarray(self.torque(t) - friction - inertia * acceleration)

    def advance(self, count: int) -> RigChunk:
        """Simulate the next `count` samples.

        Raises
        ------
        ParameterError
            If `count` is not positive.
        """
        return advance_together([self], count)[0]

    def _begin(self) -> State:
        """State at the next sample; at first that of rest under the torque there."""
        if self._state is None:
            start = np.array([self._next / self.rate])
            at, factor = self.coefficients(start), self.surroundings.inertia_factor(self.motion(start))
            load = self.torque(start) - self.effects.friction_torque(start, self.speed(start))
            stiffness = self.model.dynamics.stiffness
            level = load / (self.model.dynamics.inertia * factor * at.stiffness)
            self._state = State(self.effects.elasticity.twist(float(level[0]), stiffness) - float(at.error[0]), 0.0)
        return self._state

    def _end(self, steps: Steps, at: Coefficients, fine: State) -> RigChunk:
        """Keep the last state and describe the samples, given the coefficients there and the states at all steps."""
        self._state = State(*(float(values[-1]) for values in fine))
        self._next += steps.substeps.size
        times, state = steps.times, State(*(values[steps.sampled] for values in fine))
        motion = self.motion(times)
        return RigChunk(
            first=steps.first,
            times=times,
            angle=motion.angle,
            speed=motion.speed,
            rigid_acceleration=motion.acceleration if self.surroundings.rigid_body else np.zeros(times.size),
            displacement=state.displacement,
            velocity=state.velocity,
            acceleration=np.asarray(laws([(self.model, self.effects)]).acceleration(at, *state)),
            torque=self.torque(times),
            _fine_times=steps.ends,
            _fine=fine,
        )

    def _scan(self, count: int) -> RigChunk:
        """Integrate a linear drive: coefficients at the Gauss points, then one scan over all steps."""
        dynamics, steps = self.model.dynamics, Steps(self._next, self.rate, self._substeps(count), self._corners(count))
        at = self.coefficients(steps.instants(*GAUSS_OFFSETS))
        fluctuation = at.stiffness / dynamics.angular_frequency**2 - 1.0
        oscillator = Oscillator(dynamics, fluctuation, steps.lengths, np.broadcast_to(at.damping, fluctuation.shape))
        forcing = at.forcing - at.damping * at.error_rate - at.stiffness * at.error
        begin = self._begin()
        fine = oscillator.respond(forcing, (begin.displacement, begin.velocity))
        return self._end(steps, self.coefficients(steps.times), State(*fine, np.zeros(fine.velocity.size)))

    def _corners(self, count: int) -> FloatArray:
        """Times [s] within the next sampling intervals and at their end at which the torque jumps."""
        if not self.surroundings.rigid_body:
            return np.empty(0)
        return self.programme.corners(self._next / self.rate, (self._next + count) / self.rate)

    def _substeps(self, count: int) -> IntArray:
        """Steps in each of the next sampling intervals: enough for the fastest thing that happens in it."""
        effects, dynamics, around = self.effects, self.model.dynamics, self.surroundings
        model, reducer = grown(self.model, effects.growth), self.model.reducer
        orders = reducer.output_orders
        top = max(
            len(model.circular_spline.beta) * orders.circular_spline,
            len(model.flexspline.beta) * orders.flexspline,
            max(WAVE_GENERATOR_LOBES, around.ripple.highest_order) * reducer.reduction,
            effects.errors.highest_order(reducer),
        )
        speed = np.abs(self.speed((self._next + np.arange(count + 1)) / self.rate))
        forced = top * np.maximum(speed[1:], speed[:-1])
        fluctuation = sum(map(abs, model.circular_spline.beta)) + sum(map(abs, model.flexspline.beta))
        lightest = 1.0 + around.inertia.lowest
        natural = dynamics.angular_frequency * math.sqrt((1.0 + fluctuation) / lightest)
        natural *= 1.0 + max(0.0, effects.drift.natural_frequency)
        if effects.linear:
            fastest = np.maximum(natural, forced) / PHASE_STEP
        else:
            inertia, loop = lightest * dynamics.inertia, effects.hysteresis
            natural = math.sqrt(natural**2 * max(effects.elasticity.ratios) + 2.0 * loop.torque / loop.length / inertia)
            rubbing = effects.friction.steepest * (1.0 + max(0.0, effects.drift.friction)) / inertia
            slowest = max(natural / MARCH_NATURAL, rubbing / MARCH_FRICTION)
            fastest = np.maximum(slowest, forced / MARCH_FORCED)
        return np.maximum(1, np.ceil(fastest / self.rate)).astype(np.int64)


def advance_together(rigs: Sequence[Rig], count: int) -> list[RigChunk]:
    """Simulate the next `count` samples of several rigs of one rate at once.

    Rigs that are not linear share their steps, those that the most demanding of them needs.

    Raises
    ------
    ParameterError
        If `count` is not positive, or the rigs differ in their rates or their next samples.
    """
    if count < 1:
        raise ParameterError(f"count = {count} is not a number of samples; give at least 1")
    if len({(rig.rate, rig._next) for rig in rigs}) > 1:
        raise ParameterError(
            "rigs that are simulated together need the same rate and the same number of samples so far"
        )
    marching = [rig for rig in rigs if not rig.effects.linear]
    marched = iter(_march_together(marching, count) if marching else ())
    return [rig._scan(count) if rig.effects.linear else next(marched) for rig in rigs]


def _march_together(rigs: Sequence[Rig], count: int) -> list[RigChunk]:
    substeps = np.stack([rig._substeps(count) for rig in rigs]).max(axis=0)
    corners = np.concatenate([rig._corners(count) for rig in rigs])
    steps = Steps(rigs[0]._next, rigs[0].rate, substeps, corners)
    law = laws([(rig.model, rig.effects) for rig in rigs])
    begin = [rig._begin() for rig in rigs]
    state = begin[0] if len(rigs) == 1 else State(*np.array(begin).T)
    lengths, instants = steps.lengths.tolist(), steps.halves
    fine = [np.array(state)[None]]
    sampled: list[Sequence[Any]] = []
    block = max(1, _TOGETHER // len(rigs))
    for first in range(0, len(lengths), block):
        part = lengths[first : first + block]
        rows = _rows(rigs, instants[2 * first : 2 * (first + len(part)) + 1])
        states = march(law, rows, part, state)
        state = states[-1]
        fine.append(np.array(states[1:]))
        within = steps.sampled - first
        sampled += [rows[2 * step] for step in within[(within >= 0) & (within < len(part))]]
    columns = np.concatenate(fine).reshape(len(lengths) + 1, len(State._fields), len(rigs)).T.copy()
    at = np.array(sampled).reshape(count, len(Coefficients._fields), len(rigs)).T.copy()
    return [rig._end(steps, Coefficients(*own), State(*x)) for rig, own, x in zip(rigs, at, columns, strict=True)]


def _rows(rigs: Sequence[Rig], times: FloatArray) -> Sequence[Sequence[Any]]:
    """Return the :class:`Coefficients` as rows over `times` [s]: numbers of one rig, or columns of several."""
    values = np.empty((len(rigs), len(Coefficients._fields), times.size))
    for own, rig in zip(values, rigs, strict=True):
        for row, coefficient in zip(own, rig.coefficients(times), strict=True):
            row[:] = coefficient
    return values[0].T.tolist() if len(rigs) == 1 else list(np.ascontiguousarray(values.T))

"""What a real drive does beyond the parametric model, and the coefficients of its equation of motion."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.polynomial.polynomial import polyval

from hd_monitor.arrays import FloatArray
from hd_monitor.model import ParametricModel, StiffnessSeries

from .elasticity import Elasticity, Hysteresis, Scalar, characteristic
from .equation import Coefficients, Laws
from .friction import Friction, sliding
from .slow_change import DefectGrowth, Drift, Growth
from .surroundings import Motion, Surroundings
from .transmission_error import TransmissionErrors


@dataclass(frozen=True, slots=True, kw_only=True)
class Effects:
    """What the parametric model leaves out. By default nothing: the drive is the paper's."""

    errors: TransmissionErrors = field(default_factory=TransmissionErrors)
    elasticity: Elasticity = field(default_factory=Elasticity)
    hysteresis: Hysteresis = field(default_factory=Hysteresis)
    friction: Friction = field(default_factory=Friction)
    drift: Drift = field(default_factory=Drift)
    growth: DefectGrowth = field(default_factory=DefectGrowth)

    @property
    def linear(self) -> bool:
        """Whether the equation of motion is linear in the vibration, with coefficients that vary in time."""
        return self.elasticity.linear and not self.hysteresis.torque and not self.friction.slides

    def friction_torque(self, times: FloatArray, speed: FloatArray) -> FloatArray:
        """Torque [N·m] of all friction at `times` [s] and speeds [rad/s] of the output."""
        friction = self.friction
        law = sliding(friction.coulomb, friction.stribeck, friction.stribeck_velocity, friction.creep_velocity)
        rubbing = 1.0 + self.drift.friction * self.drift.warmth(times)
        return np.asarray(rubbing * (law(speed) + friction.viscous * speed))


def grown(model: ParametricModel, growth: DefectGrowth) -> ParametricModel:
    """Return the model with its defects as large as they get."""

    def scaled(series: StiffnessSeries, factor: float) -> StiffnessSeries:
        return replace(series, beta=tuple(factor * beta for beta in series.beta))

    flexspline, circular_spline = growth.largest
    return replace(
        model,
        flexspline=scaled(model.flexspline, flexspline),
        circular_spline=scaled(model.circular_spline, circular_spline),
    )


def coefficients(
    model: ParametricModel, effects: Effects, surroundings: Surroundings, motion: Motion, strokes: FloatArray
) -> Coefficients:
    """Coefficients of the equation of motion along a motion, arrays of its shape.

    Parameters
    ----------
    model : ParametricModel
    effects : Effects
    surroundings : Surroundings
    motion : Motion
    strokes : ndarray
        Strokes begun at the motion's times.
    """
    dynamics, orders = model.dynamics, model.reducer.output_orders
    omega = dynamics.angular_frequency
    drift, friction = effects.drift, effects.friction
    warmth: FloatArray | float = drift.warmth(motion.times) if drift.any else 0.0
    faster, rubbing = 1.0 + drift.natural_frequency * warmth, 1.0 + drift.friction * warmth
    growing = effects.growth.at(motion.times, strokes)
    errors = effects.errors
    fluctuation: FloatArray | float = 0.0
    error: FloatArray | float = 0.0
    error_rate: FloatArray | float = 0.0
    for order, stiffness, transmission, growth in (
        (orders.flexspline, model.flexspline, errors.flexspline, growing[0]),
        (orders.circular_spline, model.circular_spline, errors.circular_spline, growing[1]),
        (model.reducer.reduction, StiffnessSeries(), errors.wave_generator, Growth()),
    ):
        if not (any(stiffness.beta) or any(transmission.peak_to_peak)):
            continue
        unit = np.exp(1j * order * motion.angle)
        part = transmission.at(unit, order)
        fluctuation = fluctuation + growth.factor * polyval(unit, [0.0, *stiffness.phasors]).real
        error = error + growth.factor * part.error
        error_rate = error_rate + growth.factor * part.slope * motion.speed + growth.rate * part.error
    # Mass-normalised: J0 carries stiffness and damping, J(t) is accelerated
    lighter = 1.0 / surroundings.inertia_factor(motion)
    per_inertia = lighter / dynamics.inertia
    viscous = friction.viscous * rubbing
    torque = surroundings.torque(motion, dynamics.inertia, own=model.torque_at(motion.angle))
    damping = 2.0 * dynamics.damping_ratio * omega * (1.0 + drift.damping_ratio * warmth) * faster * lighter
    given = Coefficients(
        # Viscous friction acts on the output's speed q' + θ', and as part of c also on e'
        forcing=per_inertia * (torque - viscous * (motion.speed - error_rate)),
        damping=damping + viscous * per_inertia,
        stiffness=omega**2 * (1.0 + fluctuation) * faster**2 * lighter,
        error=error,
        error_rate=error_rate,
        speed=motion.speed,
        friction=rubbing * per_inertia,
        hysteresis=effects.hysteresis.torque * per_inertia,
    )
    return Coefficients(*np.broadcast_arrays(*given))


def laws(drives: Sequence[tuple[ParametricModel, Effects]]) -> Laws:
    """Laws of one drive as numbers, or of several in columns."""

    def column(values: Sequence[float]) -> Scalar:
        return values[0] if len(values) == 1 else np.array(values)

    effects = [effect for _, effect in drives]
    corners = [effect.elasticity.corners(model.dynamics.stiffness) for model, effect in drives]
    steps = [(*effect.elasticity.ratios, *corner) for effect, corner in zip(effects, corners, strict=True)]
    frictions = [effect.friction for effect in effects]
    return Laws(
        characteristic=_identity
        if all(effect.elasticity.linear for effect in effects)
        else characteristic(*map(column, zip(*steps, strict=True))),
        friction=sliding(
            column([f.coulomb for f in frictions]),
            column([f.stribeck for f in frictions]),
            column([f.stribeck_velocity for f in frictions]),
            column([f.creep_velocity for f in frictions]),
        )
        if any(f.slides for f in frictions)
        else _no_friction,
        length=column([e.hysteresis.length for e in effects]) if any(e.hysteresis.torque for e in effects) else None,
    )


def _identity(twist: Scalar) -> Scalar:
    return twist


def _no_friction(speed: Scalar) -> Scalar:
    return 0.0

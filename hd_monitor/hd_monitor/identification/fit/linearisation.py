"""The model's prediction of a segment, and how it changes with every unknown."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import FloatArray
from ...model.oscillator import GAUSS_OFFSETS, Oscillator, gauss_times
from ...model.parameters import Dynamics
from ...reducer import ARCMIN
from ..segment.path import Path
from ..segment.segment import Segment, Twist
from .hardening import Hardening
from .unknowns import Unknowns

_ERROR_UNIT = 0.5 * ARCMIN
"""Amplitude [rad] of one arcmin peak to peak."""

_NEWTON_STEPS = 8
_NONLINEAR = 1e-4
"""Error of the restoring torque, over the reference torque, by taking it as linear about a motion near the true one."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Linearisation:
    """A segment's prediction error and its derivatives; all in rad/s², one row a sample.

    Attributes
    ----------
    residual : ndarray, shape (samples,)
        Measured minus predicted θ''; 0 where samples are left out.
    predicted : ndarray, shape (samples,)
        Prediction, with the free vibration that fits the measurement best.
    jacobian : ndarray, shape (samples, unknowns + knots)
        Derivatives of the prediction by the unknowns, and by the inertia at its knots where it wanders.
    free : ndarray, shape (samples, 2)
        The two free vibrations: whatever the state at the segment's start was, it is a combination of them.
    twist : Twist or None
        About which the law of the restoring torque is linear; None if it is throughout.
    """

    residual: FloatArray
    predicted: FloatArray
    jacobian: FloatArray
    free: FloatArray
    twist: Twist | None = None

    def moved(self, segment: Segment, step: FloatArray) -> "Linearisation":
        """Return the linearisation at a point a small `step` of the unknowns on, to first order of the step.

        The free vibration is fitted to the measurement again; the derivatives do not change.
        """
        start, residual = _fit_free(segment, self.residual - self.jacobian @ step, self.free)
        predicted = self.predicted + self.jacobian @ step + self.free @ start
        return replace(self, residual=residual, predicted=predicted)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Predictor:
    """Predicts segments.

    Attributes
    ----------
    unknowns : Unknowns
    given : Dynamics
        Natural frequency and damping at which their unknowns are 0, and the inertia.
    reference_torque : float
        Torque [N·m] in whose unit the load fluctuations are expressed.
    """

    unknowns: Unknowns
    given: Dynamics
    reference_torque: float

    def linearise(self, segment: Segment, values: FloatArray) -> Linearisation:
        """Simulate a segment and, along the same motion, the effect of every unknown.

        Every sensitivity obeys the oscillator's own equation with another input (differentiate eq. 3 of Gu et al.
        2021 by the unknown), so that one set of transition matrices serves them all. Where the stiffness depends on
        the twist, that equation is linear about the motion, which Newton's method finds.
        """
        dynamics = self.unknowns.dynamics(self.given, values)
        omega, step = dynamics.angular_frequency, segment.period / segment.substeps
        limit = segment.low_pass.limit if segment.fastest > segment.low_pass.limit else math.inf
        steps = segment.at_gauss.torque.shape[1]
        before = segment.twist or Twist(None, None)
        gauss = _Along(self, segment.at_gauss, values, dynamics, limit, before.at_gauss)
        nodes = _Along(self, segment.at_steps, values, dynamics, limit, before.at_steps)
        if segment.wander is not None:
            gauss.wander(segment.wander.hats(gauss_times(np.arange(steps + 1) / steps)), segment.wander.values)
            nodes.wander(segment.wander.hats(np.arange(steps + 1) / steps), segment.wander.values)
        damping = 2.0 * dynamics.damping_ratio * omega * nodes.ease[..., None]

        # From the quasi-static wind-up, and the two free vibrations
        inputs, force = np.zeros((2, steps, 3)), np.zeros((steps + 1, 3))
        initial = [[nodes.wound[0], 1.0, 0.0], [0.0, 0.0, omega]]
        for _ in range(_NEWTON_STEPS):
            oscillator, spring = self._linear(dynamics, gauss, nodes, step)
            inputs[..., 0], force[:, 0] = gauss.ease * gauss.push, nodes.ease * nodes.push
            base = oscillator.respond(inputs, initial=initial)
            motion = force - damping * base.velocity - spring * base.displacement
            sampled = segment.heard(motion)
            start, residual = _fit_free(segment, segment.acceleration - sampled[:, 0], sampled[:, 1:])
            mix = np.concatenate([[1.0], start])
            theta, theta_dot, theta_ddot = base.displacement @ mix, base.velocity @ mix, motion @ mix
            theta_gauss = _hermite(theta, theta_dot * step)
            if max(nodes.follow(theta), gauss.follow(theta_gauss)) < _NONLINEAR:
                break
        if nodes.hardens:
            oscillator, spring = self._linear(dynamics, gauss, nodes, step)

        u_gauss = gauss.forcing(theta_gauss, _hermite(theta_dot, theta_ddot * step))
        change = oscillator.respond(u_gauss)
        jacobian = nodes.forcing(theta, theta_dot)
        jacobian -= damping * change.velocity
        jacobian -= spring * change.displacement
        return Linearisation(
            residual=residual,
            predicted=sampled @ mix,
            jacobian=segment.heard(jacobian),
            free=sampled[:, 1:],
            twist=Twist(nodes.twist, gauss.twist) if nodes.hardens else None,
        )

    @staticmethod
    def _linear(dynamics: Dynamics, gauss: "_Along", nodes: "_Along", step: float) -> tuple[Oscillator, FloatArray]:
        """Oscillator about the motion as known so far, and its stiffness over inertia [1/s²] at the nodes."""
        damping = 2.0 * dynamics.damping_ratio * dynamics.angular_frequency * gauss.ease if gauss.ease.ndim else None
        oscillator = Oscillator(dynamics, gauss.ease * gauss.stiffness - 1.0, step, damping)
        return oscillator, (dynamics.angular_frequency**2 * nodes.ease * nodes.stiffness)[:, None]


class _Along:
    """The model's coefficients along a path, and the inputs of the sensitivities' equations.

    Of lines beyond `limit` [Hz] the sensor hears at most traces by their coupling with others, which are no evidence.
    """

    def __init__(
        self,
        predictor: Predictor,
        path: Path,
        values: FloatArray,
        dynamics: Dynamics,
        limit: float,
        twist: FloatArray | None,
    ) -> None:
        self._unknowns = unknowns = predictor.unknowns
        self._path = path
        self.ease = np.ones(())
        self._hats: FloatArray | None = None
        self._beta = values[unknowns.stiffness]
        delay, drift = float(values[unknowns.delay]), float(values[unknowns.drift])
        self._lines = lines = path.lines_after(delay, drift)
        self._speed_then = path.speed + (delay + drift * path.time) * path.acceleration
        self._unheard = np.abs(path.speed)[..., None] * path.rates > math.tau * limit if limit < math.inf else None
        self._load_unit = predictor.reference_torque / predictor.given.inertia
        self._known = math.exp(values[unknowns.torque]) / predictor.given.inertia * path.torque
        self._fluctuation = np.asarray(1.0 + lines @ self._beta)
        inertial = values[unknowns.inertia] * path.acceleration
        self._excitation = np.asarray(self._known + self._load_unit * (path.loads @ values[unknowns.load]) - inertial)
        self._omega = dynamics.angular_frequency
        self._damping = 2.0 * dynamics.damping_ratio * self._omega
        self._errors = bool(unknowns.transmission_error)
        self._error = self._error_rate = np.zeros(())
        if self._errors:
            # The error e winds the spring up as the vibration θ does: both forces act on θ + e
            series = _ERROR_UNIT * values[unknowns.displacement]
            slopes = path.turned(series)
            self._error = np.asarray(lines @ series)
            self._error_slope = np.asarray(lines @ slopes)
            self._error_bend = np.asarray(lines @ path.turned(slopes))
            self._error_rate = path.speed * self._error_slope
            self._excitation -= self._damping * self._error_rate
        unit = predictor.reference_torque / predictor.given.stiffness
        self._law = Hardening(values=values[unknowns.hardening], unit=unit)
        self.hardens = not self._law.is_linear
        wound = self._law.twist(self._excitation / (self._omega**2 * self._fluctuation))
        self.wound = wound - self._error
        self.twist = wound if twist is None else twist
        self._linearise()

    def follow(self, theta: FloatArray) -> float:
        """Take the restoring torque as linear about a motion; return its error so far, over the reference torque."""
        if not self.hardens:
            return 0.0
        self.twist = theta + self._error
        so_far = self._rest + self._slope * self.twist
        self._linearise()
        return float(np.abs(self._torque - so_far).max()) / self._law.unit

    def _linearise(self) -> None:
        """Find the coefficient of θ, over ωn², and the input [rad/s²] that belongs to it."""
        self._torque, self._slope = self._law.torque(self.twist), self._law.slope(self.twist)
        self._rest = self._torque - self._slope * self.twist
        self.stiffness = self._fluctuation * self._slope
        self.push = self._excitation - self._omega**2 * self._fluctuation * (self._rest + self._slope * self._error)

    def wander(self, hats: FloatArray, values: FloatArray) -> None:
        """Let ln(inertia) be `values` at the knots, whose weights along the path are `hats`."""
        self._hats, self.ease = hats, np.exp(-hats @ values)

    def forcing(self, theta: FloatArray, theta_dot: FloatArray) -> FloatArray:
        """Inputs [rad/s² per unit of each unknown] where θ and θ' are as given, shape (..., unknowns + knots)."""
        unknowns, path, omega, damping = self._unknowns, self._path, self._omega, self._damping
        twist, rate = theta + self._error, theta_dot + self._error_rate
        spring = -(omega**2) * self._law.torque(twist)
        knots = 0 if self._hats is None else self._hats.shape[-1]
        forcing = np.empty((*theta.shape, unknowns.size + knots))
        np.multiply(self._lines, spring[..., None], out=forcing[..., unknowns.stiffness])
        np.multiply(path.loads, self._load_unit, out=forcing[..., unknowns.load])
        friction = -damping * rate
        forcing[..., unknowns.frequency] = friction + 2.0 * spring * self._fluctuation
        stages = self._law.derivatives(twist)
        np.multiply(stages, (-(omega**2) * self._fluctuation)[..., None], out=forcing[..., unknowns.hardening])
        forcing[..., unknowns.damping] = friction
        forcing[..., unknowns.torque] = self._known
        forcing[..., unknowns.inertia] = -path.acceleration
        forcing[..., unknowns.delay] = spring * self._speed_then * (self._lines @ path.turned(self._beta))
        if self._errors:
            stiff = -(omega**2) * self.stiffness
            errors = forcing[..., unknowns.displacement]
            np.multiply(self._lines, (_ERROR_UNIT * stiff)[..., None], out=errors)
            errors -= (_ERROR_UNIT * damping * path.speed)[..., None] * path.slopes(self._lines)
            bending = damping * path.speed * self._error_bend
            forcing[..., unknowns.delay] += self._speed_then * (stiff * self._error_slope - bending)
        np.multiply(forcing[..., unknowns.delay], path.time, out=forcing[..., unknowns.drift])
        if self._unheard is not None:
            forcing[..., unknowns.stiffness][self._unheard] = 0.0
            if self._errors:
                forcing[..., unknowns.displacement][self._unheard] = 0.0
        if self._hats is not None:
            # More inertia slows all that moves: the whole of θ'' falls with it
            total = self._excitation - damping * theta_dot + spring * self._fluctuation
            np.multiply(self._hats, -total[..., None], out=forcing[..., unknowns.size :])
            forcing *= self.ease[..., None]
        return forcing


def _fit_free(segment: Segment, error: FloatArray, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Amounts of two free vibrations that fit an error best, and what then remains of it."""
    used, slow = segment.used, segment.slow
    error, free = np.where(used, error, 0.0), motion * used[:, None]
    flat_error, flat_free = error - slow @ (slow.T @ error), free - slow @ (slow.T @ free)
    start = np.linalg.lstsq(flat_free, flat_error, rcond=1e-9)[0]
    return start, error - free @ start


def _hermite(values: FloatArray, slopes: FloatArray) -> FloatArray:
    """Interpolate at the Gauss points of every step by cubics, shape (2, steps); `slopes` are per step.

    This takes a third of the time of scipy's spline object, which is made for more than one evaluation.
    """
    u = np.asarray(GAUSS_OFFSETS)[:, None]
    rise = values[1:] - values[:-1]
    bend, other_bend = slopes[:-1] - rise, rise - slopes[1:]
    return np.asarray(values[:-1] + u * (rise + (1.0 - u) * (bend * (1.0 - u) + other_bend * u)))

"""The model's prediction of a stretch, and how it changes with every unknown."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..model.oscillator import GAUSS_OFFSETS, Oscillator, Response
from ..model.parameters import Dynamics
from .stretch import Path, Stretch
from .unknowns import Unknowns

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Linearisation:
    """A stretch's prediction error and its derivatives; all in rad/s², one row a sample.

    Attributes
    ----------
    residual : ndarray, shape (samples,)
        Measured minus predicted θ''; 0 where samples are left out.
    predicted : ndarray, shape (samples,)
        Prediction, with the free vibration that fits the measurement best.
    jacobian : ndarray, shape (samples, unknowns)
        Derivatives of the prediction.
    free : ndarray, shape (samples, 2)
        The two free vibrations: whatever the state at the stretch's start was, it is a combination of them.
    """

    residual: FloatArray
    predicted: FloatArray
    jacobian: FloatArray
    free: FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Predictor:
    """Predicts stretches.

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

    def stiffness(self, path: Path, values: FloatArray) -> FloatArray:
        """Relative stiffness K/Kav along a path."""
        return np.asarray(1.0 + path.lines @ values[self.unknowns.stiffness])

    def drive(self, path: Path, values: FloatArray) -> FloatArray:
        """Torque over inertia [rad/s²] along a path."""
        load = self.reference_torque * (path.loads @ values[self.unknowns.load])
        return np.asarray((path.torque + load) / self.given.inertia)

    def linearise(self, stretch: Stretch, values: FloatArray) -> Linearisation:
        """Simulate a stretch and, along the same path, the effect of every unknown.

        Every sensitivity obeys the oscillator's own equation with another input (differentiate eq. 3 of Gu et al.
        2021 by the unknown), so that one set of transition matrices serves them all.
        """
        unknowns, dynamics = self.unknowns, self.unknowns.dynamics(self.given, values)
        omega = dynamics.angular_frequency
        gauss, nodes = stretch.at_gauss, stretch.at_steps
        k_gauss, k_nodes = self.stiffness(gauss, values), self.stiffness(nodes, values)
        step = stretch.period / stretch.substeps
        oscillator = Oscillator(dynamics, k_gauss - 1.0, step)
        damping = 2.0 * dynamics.damping_ratio * omega
        spring = (omega**2 * k_nodes)[:, None]

        # Response from the quasi-static wind-up, and the two free vibrations
        inputs = np.zeros((2, oscillator.steps, 3))
        inputs[..., 0] = self.drive(gauss, values)
        force = np.zeros((nodes.torque.size, 3))
        force[:, 0] = self.drive(nodes, values)
        wound = force[0, 0] / spring[0, 0]
        base = oscillator.respond(inputs, initial=[[wound, 1.0, 0.0], [0.0, 0.0, omega]])
        motion = force - damping * base.velocity - spring * base.displacement
        motion = motion[:: stretch.substeps]
        start, residual = _fit_start(stretch, motion)
        theta = base.displacement[:, 0] + base.displacement[:, 1:] @ start
        theta_dot = base.velocity[:, 0] + base.velocity[:, 1:] @ start
        slope = (force - damping * base.velocity - spring * base.displacement) @ np.append(1.0, start)

        middle, middle_dot = _between(theta, theta_dot, slope, step)
        u_gauss = self._forcing(gauss, middle, middle_dot, k_gauss, dynamics)
        u_nodes = self._forcing(nodes, theta, theta_dot, k_nodes, dynamics)[:: stretch.substeps]
        change: Response = oscillator.respond(u_gauss)
        jacobian = u_nodes - damping * change.velocity[:: stretch.substeps]
        jacobian -= spring[:: stretch.substeps] * change.displacement[:: stretch.substeps]
        predicted = motion[:, 0] + motion[:, 1:] @ start
        return Linearisation(residual=residual, predicted=predicted, jacobian=jacobian, free=motion[:, 1:])

    def _forcing(
        self, path: Path, theta: FloatArray, theta_dot: FloatArray, stiffness: FloatArray, dynamics: Dynamics
    ) -> FloatArray:
        """Inputs of the sensitivities' equations, shape (..., unknowns)."""
        unknowns, omega = self.unknowns, dynamics.angular_frequency
        forcing = np.empty((*theta.shape, unknowns.size))
        np.multiply(path.lines, (-(omega**2) * theta)[..., None], out=forcing[..., unknowns.stiffness])
        np.multiply(path.loads, self.reference_torque / self.given.inertia, out=forcing[..., unknowns.load])
        friction = -2.0 * dynamics.damping_ratio * omega * theta_dot
        forcing[..., unknowns.frequency] = friction - 2.0 * omega**2 * stiffness * theta
        forcing[..., unknowns.damping] = friction
        return forcing


def _fit_start(stretch: Stretch, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Amounts of the two free vibrations that fit the measurement best, and what then remains of it."""
    used, slow = stretch.used, stretch.slow
    error = np.where(used, stretch.acceleration - motion[:, 0], 0.0)
    free = motion[:, 1:] * used[:, None]
    flat_error, flat_free = error - slow @ (slow.T @ error), free - slow @ (slow.T @ free)
    start = np.linalg.lstsq(flat_free, flat_error, rcond=1e-9)[0]
    return start, error - free @ start


def _between(
    position: FloatArray, velocity: FloatArray, acceleration: FloatArray, step: float
) -> tuple[FloatArray, FloatArray]:
    """Position and velocity at the Gauss points by Hermite interpolation, shape (2, steps) each."""
    return _hermite(position, velocity * step), _hermite(velocity, acceleration * step)


def _hermite(values: FloatArray, slopes: FloatArray) -> FloatArray:
    u = np.asarray(GAUSS_OFFSETS)[:, None]
    rise = np.diff(values)
    return np.asarray(
        values[:-1] + u * (rise + (1.0 - u) * ((slopes[:-1] - rise) * (1.0 - u) + (rise - slopes[1:]) * u))
    )

"""The Cramér-Rao bound for all unknowns together, from a simulation that shares no code with the estimator.

Eq. 3 of Gu et al. 2021 is integrated by the classical Runge-Kutta method for the true unknowns and for each of them
moved a little to either side; the differences are the sensitivities of every sample. With white noise of known
variance they give the Fisher information, and its inverse bounds the covariance of any unbiased estimate when all
unknowns, wanted or not, must be found from the same samples.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hd_monitor.arrays import BoolArray, FloatArray
from hd_monitor.model import ParametricModel

HARMONICS = 3
STIFFNESS = slice(0, 4 * HARMONICS)
"""Real, then imaginary parts of the circular spline's β phasors, then the same of the flexspline's."""

LOAD = slice(12, 16)
"""Load phasors once and twice per output revolution over the mean torque: real, then imaginary parts."""

FREQUENCY, DAMPING = 16, 17
"""ln fn, ln ζ."""

START = slice(18, 20)
"""Displacement [rad] and velocity over ωn [rad] at the first sample, beside the static wind-up."""

SIZE = 20
PRIOR_STD = np.concatenate([np.full(12, 0.3), np.full(4, 2.0), [0.1, 0.5], np.full(2, np.inf)])
"""The estimator's prior knowledge of the unknowns."""

_STEPS = np.concatenate([np.full(12, 1e-4), np.full(4, 1e-3), [1e-5, 1e-4], np.full(2, 1e-7)])
_OVERSAMPLING = 2  # integration steps a sample


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Bound:
    """Least covariance of the unknowns, and the estimate that would reach it.

    Attributes
    ----------
    truth : ndarray, shape (SIZE,)
    covariance : ndarray, shape (SIZE, SIZE)
        Inverse of the Fisher information; 0 for unknowns taken as known.
    jacobian : ndarray, shape (samples, SIZE)
        Change of every sample [rad/s²] per unit of every unknown.
    noise : float
        Standard deviation of the samples' white noise [rad/s²].
    """

    truth: FloatArray
    covariance: FloatArray
    jacobian: FloatArray
    noise: float

    def efficient_error(self, noise: FloatArray) -> FloatArray:
        """Error, for this noise [rad/s²] of the samples, of the efficient estimate: its covariance is the bound."""
        return np.asarray(self.covariance @ (self.jacobian.T @ noise) / self.noise**2)


def bound(
    model: ParametricModel,
    angle: npt.ArrayLike,
    *,
    samples: int,
    rate: float,
    noise: float,
    unknown: BoolArray,
    informed: bool = False,
) -> Bound:
    """Cramér-Rao bound for a motion at constant acceleration.

    Parameters
    ----------
    model : ParametricModel
        The truth; its load fluctuation is left out.
    angle : array_like
        Polynomial in time [s] that the output angle [rad] follows, highest power first.
    samples : int
    rate : float
        [Hz]
    noise : float
        [rad/s²]
    unknown : ndarray of bool, shape (SIZE,)
        What must be found from the samples; the rest is known.
    informed : bool
        Whether the estimator's prior knowledge counts as information, too (van Trees).
    """
    truth = np.zeros(SIZE)
    series = model.circular_spline.phasors, model.flexspline.phasors
    truth[STIFFNESS] = np.concatenate([part for phasors in series for part in (phasors.real, phasors.imag)])
    moved = np.concatenate([truth + np.diag(_STEPS), truth - np.diag(_STEPS)])
    response = acceleration(model, np.asarray(angle, dtype=np.float64), moved, samples, rate)
    jacobian = (response[:, :SIZE] - response[:, SIZE:]) / (2.0 * _STEPS)
    information = jacobian.T @ jacobian / noise**2
    if informed:
        information += np.diag(1.0 / PRIOR_STD**2)
    covariance = np.zeros((SIZE, SIZE))
    place = np.ix_(unknown, unknown)
    scale = np.sqrt(information.diagonal()[unknown])
    covariance[place] = np.linalg.inv(information[place] / np.outer(scale, scale)) / np.outer(scale, scale)
    return Bound(truth=truth, covariance=covariance, jacobian=jacobian, noise=noise)


def acceleration(
    model: ParametricModel, angle: FloatArray, unknowns: FloatArray, samples: int, rate: float
) -> FloatArray:
    """θ'' [rad/s²], shape (samples, sets), for several sets of unknowns, shape (sets, SIZE), by Runge-Kutta."""
    dynamics, mean = model.dynamics, model.torque.mean
    step = 1.0 / (rate * _OVERSAMPLING)
    half = np.arange(2 * samples * _OVERSAMPLING + 1) * step / 2.0
    q = np.polyval(angle, half)[:, None]
    x = unknowns.T
    stiffness = np.ones((half.size, x.shape[1]))
    for spline, order in enumerate(model.reducer.output_orders):
        for k in range(HARMONICS):
            real, imaginary = x[6 * spline + k], x[6 * spline + HARMONICS + k]
            stiffness += real * np.cos((k + 1) * order * q) - imaginary * np.sin((k + 1) * order * q)
    torque = np.full(stiffness.shape, mean)
    for k, order in enumerate((1, 2)):
        torque += mean * (x[12 + k] * np.cos(order * q) - x[14 + k] * np.sin(order * q))
    omega = math.tau * dynamics.natural_frequency * np.exp(x[FREQUENCY])
    damping = 2.0 * dynamics.damping_ratio * np.exp(x[DAMPING]) * omega
    spring, drive = omega**2 * stiffness, torque / dynamics.inertia
    displacement, velocity = mean / dynamics.stiffness + x[18], omega * x[19]
    result = np.empty((samples, x.shape[1]))
    for i in range(samples * _OVERSAMPLING):
        (k0, k1, k2), (u0, u1, u2) = spring[2 * i : 2 * i + 3], drive[2 * i : 2 * i + 3]
        a1 = u0 - damping * velocity - k0 * displacement
        if i % _OVERSAMPLING == 0:
            result[i // _OVERSAMPLING] = a1
        v2 = velocity + 0.5 * step * a1
        a2 = u1 - damping * v2 - k1 * (displacement + 0.5 * step * velocity)
        v3 = velocity + 0.5 * step * a2
        a3 = u1 - damping * v3 - k1 * (displacement + 0.5 * step * v2)
        v4 = velocity + step * a3
        a4 = u2 - damping * v4 - k2 * (displacement + step * v3)
        displacement = displacement + step / 6.0 * (velocity + 2.0 * v2 + 2.0 * v3 + v4)
        velocity = velocity + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    return result

"""Time integration of linear oscillators with varying stiffness: a Magnus-4 scan without a loop over samples.

One step of a linear system is an affine map, and affine maps compose; so the steps are grouped in blocks, all blocks
advance together (vectorised), and only the few block ends are chained one after the other. It is the same arithmetic
as a step-by-step integrator, at the speed of array operations.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError
from .parameters import Dynamics, FloatArray

GAUSS_OFFSETS = (0.5 - np.sqrt(3.0) / 6.0, 0.5 + np.sqrt(3.0) / 6.0)
"""Places of the two Gauss-Legendre points in a step, as fractions of it; coefficients are wanted there."""

_COMMUTATOR = np.sqrt(3.0) / 12.0
_LARGEST_PHASE_STEP = 1.0  # rad of ωn per step: beyond it the Magnus series is no longer accurate
_SERIES_REMAINDER = 1e-17


class Response(NamedTuple):
    """Motion at the steps' ends: displacement [rad] and velocity [rad/s], shape (steps + 1,) or (steps + 1, inputs)."""

    displacement: FloatArray
    velocity: FloatArray


def gauss_times(times: npt.ArrayLike) -> FloatArray:
    """Times [s] of the two Gauss points of every step, shape (2, steps); `times`, shape (steps + 1,), are its ends."""
    t = np.asarray(times, dtype=np.float64)
    start, length = t[:-1], np.diff(t)
    return np.stack([start + c * length for c in GAUSS_OFFSETS])


class Oscillator:
    """Solver of ``x'' + 2ζωn x' + ωn² (1 + k(t)) x = u(t)`` for a given k(t) and any number of inputs u(t).

    The transition matrices depend on k(t) alone; they are computed once and reused by every call of :meth:`respond`
    (identification needs a dozen inputs for one k: the sensitivities obey the same equation).

    Parameters
    ----------
    dynamics : Dynamics
    fluctuation : array_like, shape (2, steps)
        Relative stiffness fluctuation k at the two Gauss points of every step (see :func:`gauss_times`).
    step : float or array_like, shape (steps,)
        Length of the steps [s].

    Raises
    ------
    ParameterError
        If the step is not positive, or longer than 1/ωn (the fourth-order expansion would be inaccurate).

    Notes
    -----
    Fourth-order Magnus expansion with two Gauss points [1]_, applied to the system extended by its input, so that a
    varying input is integrated at the same order. The state is scaled by ωn for conditioning. Exponential and φ1
    function are summed as series whose matrix powers reduce to scalars by Cayley-Hamilton.

    References
    ----------
    .. [1] Blanes, Casas, Oteo, Ros, "The Magnus expansion and some of its applications", Phys. Rep. 470 (2009).

    Examples
    --------
    A free oscillation of 1 Hz is back where it started after 1 s:

    >>> import numpy as np
    >>> still = Oscillator(Dynamics(natural_frequency=1.0, damping_ratio=0.0), np.zeros((2, 100)), 0.01)
    >>> round(float(still.respond(np.zeros((2, 100)), initial=(1.0, 0.0)).displacement[-1]), 9)
    1.0
    """

    __slots__ = ("_damping", "_input_map", "_omega", "_step", "_transition", "steps")

    def __init__(self, dynamics: Dynamics, fluctuation: npt.ArrayLike, step: npt.ArrayLike) -> None:
        k = np.asarray(fluctuation, dtype=np.float64)
        if k.ndim != 2 or k.shape[0] != 2:
            raise ParameterError(
                f"fluctuation has the shape {k.shape}; give (2, steps), its values at the Gauss points"
            )
        self.steps: int = k.shape[1]
        self._omega = omega = dynamics.angular_frequency
        self._damping = damping = -2.0 * dynamics.damping_ratio * omega
        self._step = h = np.broadcast_to(np.asarray(step, dtype=np.float64), (self.steps,))
        if self.steps and not (h.min() > 0.0 and h.max() * omega <= _LARGEST_PHASE_STEP):
            raise ParameterError(
                f"steps of {h.min():.3g} to {h.max():.3g} s do not resolve a natural frequency of "
                f"{dynamics.natural_frequency:g} Hz; use steps above 0 and up to {_LARGEST_PHASE_STEP / omega:.3g} s"
            )
        # Scaled system matrix at the Gauss points: [[0, ωn], [a, d]]. Exponent: h (A1 + A2)/2 + (√3/12) h² [A2, A1].
        a1, a2 = -omega * (1.0 + k[0]), -omega * (1.0 + k[1])
        skew = _COMMUTATOR * h * (a1 - a2)
        w00 = h * omega * skew
        exponent = np.empty((2, 2, self.steps))
        exponent[0, 0] = w00
        exponent[0, 1] = h * omega
        exponent[1, 0] = h * (0.5 * (a1 + a2) + damping * skew)
        exponent[1, 1] = h * damping - w00
        self._transition, self._input_map = _exponential_and_phi(exponent)

    @property
    def transition(self) -> FloatArray:
        """Transition matrices of (displacement, velocity) over each step, shape (steps, 2, 2)."""
        scale = np.array([[1.0, 1.0 / self._omega], [self._omega, 1.0]])
        return np.asarray(np.moveaxis(self._transition, -1, 0) * scale)

    def respond(self, forcing: npt.ArrayLike, initial: npt.ArrayLike = (0.0, 0.0)) -> Response:
        """Integrate from `initial`.

        Parameters
        ----------
        forcing : array_like, shape (2, steps) or (2, steps, inputs)
            u [rad/s²] at the Gauss points of every step.
        initial : array_like, shape (2,) or (2, inputs)
            Displacement [rad] and velocity [rad/s] at the start.

        Returns
        -------
        Response

        Raises
        ------
        ParameterError
            If the forcing does not have one value for each Gauss point.
        """
        u = np.asarray(forcing, dtype=np.float64)
        single = u.ndim == 2
        u = u[:, :, None] if single else u
        if u.ndim != 3 or u.shape[:2] != (2, self.steps):
            raise ParameterError(
                f"forcing has the shape {np.shape(forcing)}, but this oscillator was made for {self.steps} steps; "
                f"give (2, {self.steps}) or (2, {self.steps}, inputs)"
            )
        start = np.array(np.broadcast_to(np.asarray(initial, dtype=np.float64).reshape(2, -1), (2, u.shape[2])))
        start[0] *= self._omega
        # Vector part of the exponent: h (b1 + b2)/2 + (√3/12) h² (A2 b1 - A1 b2) with b = (0, u)
        h = self._step[:, None]
        slope = _COMMUTATOR * h * h * (u[0] - u[1])
        v0 = self._omega * slope
        v1 = 0.5 * h * (u[0] + u[1]) + self._damping * slope
        m = self._input_map[:, :, :, None]
        states = _scan(self._transition, np.stack([m[0, 0] * v0 + m[0, 1] * v1, m[1, 0] * v0 + m[1, 1] * v1]), start)
        states[0] /= self._omega
        return Response(states[0, :, 0], states[1, :, 0]) if single else Response(states[0], states[1])


def _exponential_and_phi(exponent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return exp(Ω) and φ1(Ω) = Σ Ωⁿ/(n+1)! for 2×2 matrices Ω, all of shape (2, 2, steps)."""
    trace = exponent[0, 0] + exponent[1, 1]
    determinant = exponent[0, 0] * exponent[1, 1] - exponent[0, 1] * exponent[1, 0]
    norm = float(np.abs(exponent).sum(axis=1).max(initial=0.0))
    # Ωⁿ = p Ω + q I, by Cayley-Hamilton; the sums over n are scalars
    p, q = np.zeros_like(trace), np.ones_like(trace)
    exp_p, exp_q = p.copy(), q.copy()
    phi_p, phi_q = p.copy(), q.copy()
    n, size = 0, 1.0
    while size > _SERIES_REMAINDER:
        n += 1
        size *= norm / n
        p, q = trace * p + q, -determinant * p
        factor = 1.0 / math.factorial(n)
        exp_p += factor * p
        exp_q += factor * q
        factor /= n + 1
        phi_p += factor * p
        phi_q += factor * q
    results = []
    for on_matrix, on_identity in ((exp_p, exp_q), (phi_p, phi_q)):
        result = exponent * on_matrix
        result[0, 0] += on_identity
        result[1, 1] += on_identity
        results.append(result)
    return results[0], results[1]


def _scan(transition: FloatArray, gain: FloatArray, start: FloatArray) -> FloatArray:
    """Chain x[n+1] = T[n] x[n] + g[n]: shapes (2, 2, N), (2, N, R), (2, R) give (2, N + 1, R)."""
    count, inputs = gain.shape[1], gain.shape[2]
    length = max(1, math.isqrt(count))
    blocks = -(-count // length)
    padding = blocks * length - count
    if padding:
        identity = np.broadcast_to(np.eye(2)[:, :, None], (2, 2, padding))
        transition = np.concatenate([transition, identity], axis=2)
        gain = np.concatenate([gain, np.zeros((2, padding, inputs))], axis=1)
    maps = np.ascontiguousarray(np.moveaxis(transition.reshape(2, 2, blocks, length), 3, 0))[..., None]
    gains = np.ascontiguousarray(np.moveaxis(gain.reshape(2, blocks, length, inputs), 2, 0))
    # Every block at once: its response from rest (R columns) and its own transition so far (2 columns).
    local = np.empty((length, 2, blocks, inputs + 2))
    state = np.zeros((2, blocks, inputs + 2))
    state[0, :, inputs] = state[1, :, inputs + 1] = 1.0
    for j in range(length):
        now, t = local[j], maps[j]
        np.multiply(t[:, 0], state[0], out=now)
        now += t[:, 1] * state[1]
        now[:, :, :inputs] += gains[j]
        state = now
    # Then the few block ends, one after the other, and every block's true start added in.
    ends = np.moveaxis(local[-1], 1, 0) if length else local
    starts = np.empty((blocks, 2, inputs))
    for b in range(blocks):
        starts[b] = start
        start = ends[b, :, inputs:] @ start + ends[b, :, :inputs]
    first, second = starts[:, 0], starts[:, 1]
    whole = local[..., :inputs]
    whole = whole + local[..., inputs, None] * first + local[..., inputs + 1, None] * second
    states = np.empty((2, count + 1, inputs))
    states[:, 0] = starts[0] if blocks else start
    states[:, 1:] = np.moveaxis(whole, 0, 2).reshape(2, blocks * length, inputs)[:, :count]
    return states

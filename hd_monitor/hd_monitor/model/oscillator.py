"""Time integration of linear oscillators with varying stiffness: Magnus-4 steps without a loop over samples.

One step of a linear system is an affine map. The steps are grouped in blocks, in each of which the products of the
transition matrices (the fundamental solution) are formed for all blocks at once; with them any input's response is a
cumulative sum (variation of constants), and only the few block ends are chained one after the other.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray
from ..errors import ParameterError
from .parameters import Dynamics

GAUSS_OFFSETS = (0.5 - np.sqrt(3.0) / 6.0, 0.5 + np.sqrt(3.0) / 6.0)
"""Places of the two Gauss-Legendre points in a step, as fractions of it; coefficients are evaluated there."""

_COMMUTATOR = np.sqrt(3.0) / 12.0
_LARGEST_PHASE_STEP = 1.0  # rad of ωn per step: beyond it the Magnus series is no longer accurate
_SERIES_REMAINDER = 1e-17
_CACHED = 32_768  # numbers in the sums processed at once
_LARGEST_CONDITION = 11.5  # natural logarithm of the condition of a block's matrix: five of sixteen digits at worst


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
    """Solver of ``x'' + c(t) x' + ωn² (1 + k(t)) x = u(t)`` for given k(t), c(t) and any number of inputs u(t).

    The transition matrices depend on k(t) and c(t) alone; they are computed once and reused by every call of
    :meth:`respond` (identification needs a dozen inputs for one k: the sensitivities obey the same equation).

    Parameters
    ----------
    dynamics : Dynamics
    fluctuation : array_like, shape (2, steps)
        Relative stiffness fluctuation k at the two Gauss points of every step (see :func:`gauss_times`).
    step : float or array_like, shape (steps,)
        Length of the steps [s].
    damping : array_like, shape (2, steps), optional
        Damping c [1/s] at the Gauss points; by default that of `dynamics`, 2ζωn, throughout.

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
    A free oscillation of 1 Hz returns to its start after 1 s:

    >>> import numpy as np
    >>> still = Oscillator(Dynamics(natural_frequency=1.0, damping_ratio=0.0), np.zeros((2, 100)), 0.01)
    >>> round(float(still.respond(np.zeros((2, 100)), initial=(1.0, 0.0)).displacement[-1]), 9)
    1.0
    """

    __slots__ = ("_longest_block", "_omega", "_propagator", "_transition", "_weights", "steps")

    def __init__(
        self, dynamics: Dynamics, fluctuation: npt.ArrayLike, step: npt.ArrayLike, damping: npt.ArrayLike | None = None
    ) -> None:
        k = np.asarray(fluctuation, dtype=np.float64)
        if k.ndim != 2 or k.shape[0] != 2:
            raise ParameterError(
                f"fluctuation has the shape {k.shape}; give (2, steps), its values at the Gauss points"
            )
        self.steps: int = k.shape[1]
        self._omega = omega = dynamics.angular_frequency
        constant = -2.0 * dynamics.damping_ratio * omega
        d1, d2 = (constant, constant) if damping is None else -np.asarray(damping, dtype=np.float64)
        h = np.broadcast_to(np.asarray(step, dtype=np.float64), (self.steps,))
        if self.steps and not (h.min() > 0.0 and h.max() * omega <= _LARGEST_PHASE_STEP):
            raise ParameterError(
                f"steps of {h.min():.3g} to {h.max():.3g} s do not resolve a natural frequency of "
                f"{dynamics.natural_frequency:g} Hz; use steps above 0 and up to {_LARGEST_PHASE_STEP / omega:.3g} s"
            )
        # Scaled system matrix at the Gauss points: [[0, ωn], [a, d]]. Exponent: h (A1 + A2)/2 + (√3/12) h² [A2, A1].
        a1, a2 = -omega * (1.0 + k[0]), -omega * (1.0 + k[1])
        mean, change = 0.5 * (d1 + d2), _COMMUTATOR * h * (d1 - d2)
        skew = _COMMUTATOR * h * (a1 - a2)
        w00 = h * omega * skew
        exponent = np.empty((2, 2, self.steps))
        exponent[0, 0] = w00
        exponent[0, 1] = h * omega * (1.0 + change)
        exponent[1, 0] = h * (0.5 * (a1 + a2) * (1.0 - change) + mean * skew)
        exponent[1, 1] = h * mean - w00
        self._transition, input_map = _exponential_and_phi(exponent)
        # Vector part of the exponent: h (b1 + b2)/2 + (√3/12) h² (A2 b1 - A1 b2) with b = (0, u). The input map turns
        # it into a step's contribution to the state: a weight for u at either Gauss point, for either component.
        slope = _COMMUTATOR * h * h
        parts = [(sign * omega * slope, 0.5 * h + sign * d * slope) for sign, d in ((1.0, d2), (-1.0, d1))]
        self._weights = np.stack([input_map[:, 0] * first + input_map[:, 1] * second for first, second in parts])
        # Bound on the logarithm of the condition of one step's matrix, from its logarithmic norms
        largest = float(np.abs(k).max(initial=0.0))
        strongest = 0.5 / omega * float(np.abs([d1, d2]).max(initial=0.0))
        condition = 2.0 * omega * float(h.max(initial=0.0)) * math.hypot(strongest, 0.5 * largest)
        self._longest_block = _LARGEST_CONDITION / max(condition, 1e-12)
        self._propagator: _Propagator | None = None  # the stability analysis needs none

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
        if self._propagator is None:
            self._propagator = _Propagator(self._transition, self._longest_block)
        states = self._propagator.chain(self._weights, u, start)
        states[0] /= self._omega
        return Response(states[0, :, 0], states[1, :, 0]) if single else Response(states[0], states[1])


class _Propagator:
    """Chains x[n+1] = T[n] x[n] + w1[n] u1[n] + w2[n] u2[n] for given matrices T, shape (2, 2, steps).

    Within a block that starts at x, the state after a step is P (x + Σ P⁻¹ w u), where P is the product of the
    matrices since the block's start. Blocks are short enough for P to be well conditioned.
    """

    __slots__ = ("_ends", "_inverse", "_products", "_shape", "_steps")

    def __init__(self, transition: FloatArray, longest: float) -> None:
        self._steps = transition.shape[2]
        # Few and long: block ends are chained one by one
        length = max(1, min(3 * math.isqrt(self._steps), int(min(longest, 1e9))))
        blocks = -(-self._steps // length)
        self._shape = blocks, length
        padded = np.zeros((2, 2, blocks * length))
        padded[0, 0] = padded[1, 1] = 1.0
        padded[:, :, : self._steps] = transition
        products = padded.reshape(2, 2, blocks, length)
        reach = 1
        while reach < length:  # products of 2, 4, 8 … neighbours, up to those since the block's start
            late, early = products[..., reach:], products[..., :-reach]
            products[..., reach:] = late[:, 0, None] * early[None, 0] + late[:, 1, None] * early[None, 1]
            reach *= 2
        self._ends = np.ascontiguousarray(np.moveaxis(products[..., -1], 2, 0))
        p = self._products = products.reshape(2, 2, blocks * length)
        self._inverse = np.array([[p[1, 1], -p[0, 1]], [-p[1, 0], p[0, 0]]]) / (p[0, 0] * p[1, 1] - p[0, 1] * p[1, 0])

    def chain(self, weights: FloatArray, forcing: FloatArray, start: FloatArray) -> FloatArray:
        """Return the states from `start` on.

        Weights of shape (point, component, steps), forcing of shape (point, steps, R) and a start of shape (2, R) give
        states of shape (2, steps + 1, R).
        """
        (blocks, length), steps, inputs = self._shape, self._steps, forcing.shape[2]
        states = np.empty((2, steps + 1, inputs))
        states[:, 0] = start
        together = max(1, _CACHED // (2 * length * inputs))  # blocks whose sums stay in the processor's cache
        at = start
        for first in range(0, blocks, together):
            part = slice(first * length, min((first + together) * length, steps))
            at = self._chain(weights[..., part], forcing[:, part], at, first, states[:, 1:][:, part])
        return states

    def _chain(
        self, weights: FloatArray, forcing: FloatArray, at: FloatArray, first: int, states: FloatArray
    ) -> FloatArray:
        """Write the states of some blocks from number `first` on, and return the last one."""
        length, (_, steps, inputs) = self._shape[1], forcing.shape
        blocks = -(-steps // length)
        here = slice(first * length, first * length + steps)
        inverse, p = self._inverse[:, :, here], self._products[:, :, here, None]
        sums = np.zeros((2, blocks * length, inputs))
        term = np.empty((steps, inputs))
        for row in range(2):
            early, late = (inverse[row, 0] * weight[0] + inverse[row, 1] * weight[1] for weight in weights)
            np.multiply(early[:, None], forcing[0], out=sums[row, :steps])
            np.multiply(late[:, None], forcing[1], out=term)
            sums[row, :steps] += term
        by_block = sums.reshape(2, blocks, length, inputs)
        np.cumsum(by_block, axis=2, out=by_block)
        ends = self._ends[first : first + blocks]
        gained = ends @ np.moveaxis(by_block[:, :, -1], 1, 0)
        starts = np.empty((blocks, 2, inputs))
        for block in range(blocks):
            starts[block] = at
            at = ends[block] @ at + gained[block]
        by_block += np.moveaxis(starts, 0, 1)[:, :, None]
        for row in range(2):
            np.multiply(p[row, 0], sums[0, :steps], out=states[row])
            np.multiply(p[row, 1], sums[1, :steps], out=term)
            states[row] += term
        return at


def _exponential_and_phi(exponent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return exp(Ω) and φ1(Ω) = Σ Ωⁿ/(n+1)! for 2×2 matrices Ω, all of shape (2, 2, steps)."""
    trace = exponent[0, 0] + exponent[1, 1]
    determinant = exponent[0, 0] * exponent[1, 1] - exponent[0, 1] * exponent[1, 0]
    norm = float(np.abs(exponent).sum(axis=1).max(initial=0.0))
    # Ωⁿ = p[n] Ω - det p[n-1] I by Cayley-Hamilton, p[n+1] = trace p[n] - det p[n-1]; the sums over n are of scalars:
    # with s[m] = Σ p[n] / (n+m)!, exp(Ω) = s[0] Ω + (1 - det s[1]) I and φ1(Ω) = s[1] Ω + (1 - det s[2]) I
    terms, size = 1, norm
    while size > _SERIES_REMAINDER:
        terms += 1
        size *= norm / terms
    powers = np.empty((terms, trace.size))
    powers[0] = 1.0
    if terms > 1:
        powers[1] = trace
    for n in range(2, terms):
        np.multiply(trace, powers[n - 1], out=powers[n])
        powers[n] -= determinant * powers[n - 2]
    sums = np.array([[1.0 / math.factorial(n + m) for n in range(1, terms + 1)] for m in range(3)]) @ powers
    results = []
    for on_matrix, next_sum in pairwise(sums):
        result = exponent * on_matrix
        on_identity = 1.0 - determinant * next_sum
        result[0, 0] += on_identity
        result[1, 1] += on_identity
        results.append(result)
    return results[0], results[1]

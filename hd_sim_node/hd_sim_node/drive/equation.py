"""The drive's equation of motion with every effect, and its integration where it is not linear.

``θ'' = M/J - c (θ' + e') - κ G(θ + e) - (f F(q' + θ') + T z)/J`` with ``c = C/J`` and ``κ = K/J``: θ is the torsional
vibration, e the transmission error, q' the output's speed, G the elastic characteristic, F sliding friction and z the
state of the hysteresis. Viscous friction is contained in c and in the forcing.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from .elasticity import Scalar, branch


class Coefficients(NamedTuple):
    """What the equation contains at one instant, or at many: numbers, or arrays of one shape."""

    forcing: Scalar
    """M/J without what the laws below contribute [rad/s²]."""
    damping: Scalar
    """c [1/s]"""
    stiffness: Scalar
    """κ [1/s²]"""
    error: Scalar
    """Transmission error e [rad]."""
    error_rate: Scalar
    """e' [rad/s]"""
    speed: Scalar
    """q' [rad/s]"""
    friction: Scalar
    """f/J: [rad/s²] for each N·m that the friction law gives."""
    hysteresis: Scalar
    """T/J [rad/s²]"""


class State(NamedTuple):
    """State of one drive (numbers) or of several (arrays, one column a drive)."""

    displacement: Scalar
    """θ [rad]"""
    velocity: Scalar
    """θ' [rad/s]"""
    hysteresis: Scalar = 0.0
    """z, from -1 to 1"""


class Laws(NamedTuple):
    """The laws that make the equation nonlinear, for one drive or for several in columns."""

    characteristic: Callable[[Scalar], Scalar]
    """G(τ) [rad] of the twist τ [rad]."""
    friction: Callable[[Scalar], Scalar]
    """F(v) [N·m] of the output's speed v [rad/s]."""
    length: Scalar | None
    """The twist x over which the hysteresis turns [rad]; None if there is none."""

    def acceleration(self, at: Sequence[Scalar], x: Scalar, v: Scalar, z: Scalar) -> Scalar:
        """θ'' [rad/s²] with the :class:`Coefficients` `at`, for θ = x, θ' = v and the hysteresis' state z."""
        forcing, damping, stiffness, error, error_rate, speed, friction, hysteresis = at
        return (
            forcing
            - damping * (v + error_rate)
            - stiffness * self.characteristic(x + error)
            - friction * self.friction(speed + v)
            - hysteresis * z
        )


def march(laws: Laws, rows: Iterable[Sequence[Scalar]], steps: Iterable[float], state: State) -> list[State]:
    """Integrate by the classical Runge-Kutta method: of fourth order, of third while hysteresis turns.

    Hysteresis is a function of the twist since its last reversal, in closed form: within a step it stays on the branch
    on which the step begins, and where the twist has reversed, the new branch is entered at the turning point.

    Parameters
    ----------
    laws : Laws
    rows : iterable
        :class:`Coefficients` at the beginning, the middle and the end of every step, where an end is the next
        beginning: 2 steps + 1 rows of numbers, or of arrays with a column for each drive.
    steps : iterable of float
        Lengths of the steps [s].
    state : State
        At the beginning.

    Returns
    -------
    list of State
        At the beginning and at the end of every step.
    """
    several = isinstance(state.displacement, np.ndarray)
    exp: Callable[[Scalar], Scalar] = np.exp if several else math.exp
    sign: Callable[[float, Scalar], Scalar] = np.copysign if several else math.copysign
    acceleration, length = laws.acceleration, laws.length

    def turned(z: Scalar, side: Scalar, travel: Scalar) -> Scalar:
        return z if length is None else branch(z, side, travel / length, exp)

    states, place = [state], iter(rows)
    begin = next(place)
    x, v, z = state
    for h in steps:
        middle, end = next(place), next(place)
        half = 0.5 * h
        twist, rate = x + begin[_ERROR], v + begin[_ERROR_RATE]
        side = sign(1.0, rate)
        a1 = acceleration(begin, x, v, z)
        x2, v2 = x + half * v, v + half * a1
        a2 = acceleration(middle, x2, v2, turned(z, side, x2 + middle[_ERROR] - twist))
        x3, v3 = x + half * v2, v + half * a2
        a3 = acceleration(middle, x3, v3, turned(z, side, x3 + middle[_ERROR] - twist))
        x4, v4 = x + h * v3, v + h * a3
        a4 = acceleration(end, x4, v4, turned(z, side, x4 + end[_ERROR] - twist))
        x, v = x + h / 6.0 * (v + 2.0 * (v2 + v3) + v4), v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)
        if length is not None:
            final, last = x + end[_ERROR], v + end[_ERROR_RATE]
            reversal = _turning_point(twist, rate, final, last, h)
            z = turned(turned(z, side, reversal - twist), sign(1.0, last), final - reversal)
        begin = end
        states.append(State(x, v, z))
    return states


_ERROR, _ERROR_RATE = Coefficients._fields.index("error"), Coefficients._fields.index("error_rate")
_TINY = 1e-300


def _turning_point(first: Scalar, rate: Scalar, last: Scalar, final_rate: Scalar, step: Scalar) -> Scalar:
    """Twist at which it reverses within a step, by its cubic through both ends; the first if it does not reverse."""
    reverses = rate * final_rate < 0.0
    f = reverses * abs(rate) / (abs(rate) + abs(final_rate) + _TINY)
    g = 1.0 - f
    return g * g * (first * (1.0 + 2.0 * f) + step * rate * f) + f * f * (
        last * (3.0 - 2.0 * f) - step * final_rate * g
    )

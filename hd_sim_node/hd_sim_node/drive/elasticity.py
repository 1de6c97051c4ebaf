"""Torsional elasticity as catalogues state it: stiffness in three steps, and hysteresis about zero torque.

The laws are plain algebra, so that they hold for numbers and for arrays (one column a reducer) alike.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from scipy.optimize import brentq

from hd_monitor.errors import ParameterError
from hd_monitor.parameter import number
from hd_monitor.reducer import ARCMIN

ROUNDING = 0.1
"""Width over which the stiffness passes from one step to the next, as a fraction of the twist at the corner. Measured
characteristics bend there; catalogues put two straight lines in their place."""

Scalar = Any
"""A float, or an array with one value a reducer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Elasticity:
    """Stiffness in three steps K1, K2, K3 with corners at the torques T1, T2: the parameters ``elasticity.*``.

    Raises
    ------
    ParameterError
        If there are not three ratios and two torques, or the torques do not rise.
    """

    ratios: tuple[float, ...] = number(
        (1.0, 1.0, 1.0), "", 0.01, 100.0, "stiffness K1, K2, K3 over J (2π fn)², below T1, from T1 to T2 and above T2"
    )
    torques: tuple[float, ...] = number(
        (5.0, 20.0),
        "N·m",
        1e-6,
        1e6,
        "torques T1, T2 between the steps of stiffness; each corner is rounded over 10 % of its twist",
    )

    def __post_init__(self) -> None:
        """Check what belongs together."""
        if len(self.ratios) != 3 or len(self.torques) != 2 or not self.torques[0] < self.torques[1]:
            raise ParameterError(
                f"elasticity.ratios = {list(self.ratios)} with elasticity.torques = {list(self.torques)} N·m: give "
                "three ratios (K1, K2, K3) and two torques T1 < T2, as catalogues do"
            )

    @property
    def linear(self) -> bool:
        """Whether stiffness is the same at every torque, and equal to the mean."""
        return self.ratios == (1.0, 1.0, 1.0)

    def corners(self, stiffness: float) -> tuple[float, float]:
        """Twists [rad] at T1 and T2 for a stiffness K [N·m/rad] of ratio 1."""
        first = self.torques[0] / (self.ratios[0] * stiffness)
        return first, first + (self.torques[1] - self.torques[0]) / (self.ratios[1] * stiffness)

    def twist(self, level: float, stiffness: float) -> float:
        """Twist τ [rad] at which G(τ) is `level` [rad], for a stiffness K [N·m/rad] of ratio 1."""
        if self.linear:
            return level
        k1, k2, k3 = self.ratios
        law = characteristic(k1, k2, k3, *self.corners(stiffness))
        limit = 2.0 * abs(level) / min(self.ratios) + 1e-12  # beyond any rounding of the corners
        return float(brentq(lambda twist: law(twist) - level, -limit, limit, xtol=1e-18, rtol=1e-14))


def characteristic(k1: Scalar, k2: Scalar, k3: Scalar, first: Scalar, second: Scalar) -> Callable[[Scalar], Scalar]:
    """Return the law G(τ) [rad], the restoring torque at a twist τ [rad] over the stiffness of ratio 1.

    Slopes k1, k2, k3 with hyperbolic passages at the twists `first` and `second` [rad]; G is odd and smooth, so that
    an integration keeps its order.
    """
    low, high = 0.5 * (k2 - k1), 0.5 * (k3 - k2)
    soft, hard = (ROUNDING * first) ** 2, (ROUNDING * second) ** 2

    def law(twist: Scalar) -> Scalar:
        up, down = twist - first, twist + first
        over, under = twist - second, twist + second
        return (
            (k1 + 2.0 * low + 2.0 * high) * twist
            + low * ((up * up + soft) ** 0.5 - (down * down + soft) ** 0.5)
            + high * ((over * over + hard) ** 0.5 - (under * under + hard) ** 0.5)
        )

    return law


@dataclass(frozen=True, slots=True, kw_only=True)
class Hysteresis:
    """Hysteresis about zero torque (Dahl's law): the parameters ``hysteresis.*``.

    A torque T z opposes the twist, where ``dz/dτ = (1 - z sign(τ'))/x``: after a reversal of the twist it passes from
    -T to T over a few times the twist x. The loop that a slow load describes is 2 T wide in torque, and 2 T / K1 in
    twist: the catalogue's hysteresis loss.
    """

    torque: float = number(0.0, "N·m", 0.0, 1e6, "half the width of the hysteresis loop, T; 0: no hysteresis")
    twist: float = number(
        1.0, "arcmin", 1e-3, 1e4, "twist x over which the loop closes by a factor e after a reversal (Dahl)"
    )

    @property
    def length(self) -> float:
        """The twist x in radians."""
        return self.twist * ARCMIN


def branch(state: Scalar, sign: Scalar, travel: Scalar, exp: Callable[[Scalar], Scalar]) -> Scalar:
    """Return z after a twist of `travel` [lengths x] in direction `sign`, from `state`: Dahl's law in closed form."""
    return sign + (state - sign) * exp(-sign * travel)

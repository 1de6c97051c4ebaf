"""Friction on the output: Coulomb, Stribeck and viscous, with reversals."""

from collections.abc import Callable
from dataclasses import dataclass

from hd_monitor.parameter import number

from .elasticity import Scalar


@dataclass(frozen=True, slots=True, kw_only=True)
class Friction:
    """Friction torque against the output's speed, in N·m and rad/s of the output: the parameters ``friction.*``."""

    coulomb: float = number(0.0, "N·m", 0.0, 1e6, "sliding friction at the output, against its speed with vibration")
    stribeck: float = number(
        0.0, "N·m", 0.0, 1e6, "by how much friction at the start of sliding exceeds the sliding one"
    )
    stribeck_velocity: float = number(
        0.05, "rad/s", 1e-4, 1e3, "output speed vs at which half of that excess is gone, as 1/(1 + (v/vs)²)"
    )
    viscous: float = number(0.0, "N·m·s/rad", 0.0, 1e6, "friction that grows with the output's speed")
    creep_velocity: float = number(
        0.01,
        "rad/s",
        1e-4,
        10.0,
        "output speed vc below which friction falls to 0, as v/√(v² + vc²): what stands creeps instead of sticking",
    )

    @property
    def slides(self) -> bool:
        """Whether friction is more than viscous."""
        return bool(self.coulomb or self.stribeck)

    @property
    def steepest(self) -> float:
        """Steepest rise of sliding friction over speed [N·m·s/rad], at standstill."""
        return (self.coulomb + self.stribeck) / self.creep_velocity


def sliding(
    coulomb: Scalar, stribeck: Scalar, stribeck_velocity: Scalar, creep_velocity: Scalar
) -> Callable[[Scalar], Scalar]:
    """Return the law of sliding friction [N·m] over speed [rad/s], for numbers or one array value a reducer.

    The Stribeck curve is Hess and Soom's, J. Tribology 110 (1988): ``1/(1 + (v/vs)²)``.
    """
    creep = creep_velocity * creep_velocity
    scale = 1.0 / (stribeck_velocity * stribeck_velocity)

    def law(speed: Scalar) -> Scalar:
        square = speed * speed
        return (coulomb + stribeck / (1.0 + square * scale)) * speed / (square + creep) ** 0.5

    return law

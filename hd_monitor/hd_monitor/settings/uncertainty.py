"""How sure the parameters are: the standard deviations, before any data, of what is given and estimated along."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

from ..parameter import Value


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertainty:
    """How sure the parameters are: standard deviations of what is given.

    Attributes
    ----------
    natural_frequency, damping, inertia, measured_torque, assumed_torque : float
        As parts of the value; the torque's are those of its scale.
    hardening : float
        Of the stiffness at other torques than the usual one, as a part of that.
    delay : float
        Of the lag between the stamps of vibration and joint states [s].
    clock_drift : float
        Of the rate at which that lag changes.
    """

    natural_frequency: float
    damping: float
    inertia: float
    hardening: float
    measured_torque: float
    assumed_torque: float
    delay: float
    clock_drift: float

    @classmethod
    def of(cls, values: Mapping[str, Value]) -> Self:
        """Return what a joint's checked parameters say."""

        def number(name: str) -> float:
            return float(values[name])  # type: ignore[arg-type]

        return cls(
            natural_frequency=number("dynamics.natural_frequency_uncertainty"),
            damping=number("dynamics.damping_uncertainty"),
            inertia=number("dynamics.inertia_uncertainty"),
            hardening=number("dynamics.hardening_uncertainty"),
            measured_torque=number("load.torque_uncertainty"),
            assumed_torque=number("load.assumed_uncertainty"),
            delay=number("input.delay_uncertainty"),
            clock_drift=1e-6 * number("input.clock_drift"),
        )

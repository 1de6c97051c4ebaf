"""What acts on the drive from outside: gravity, the payload, the motor's torque ripple and the motion of the load."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from hd_monitor.arrays import FloatArray
from hd_monitor.errors import ParameterError
from hd_monitor.parameter import number


class Motion(NamedTuple):
    """Motion demanded of the output, in arrays of any one shape."""

    times: FloatArray
    """[s]"""
    angle: FloatArray
    """Output angle q [rad]."""
    speed: FloatArray
    """q' [rad/s]"""
    acceleration: FloatArray
    """q'' [rad/s²]"""
    turn: FloatArray
    """Wave-generator angle [rad]."""
    carried: FloatArray | float
    """Fraction of the payload that is carried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MotorRipple:
    """Torque ripple of the motor, referred to the output: the parameters ``torque.ripple*``.

    Raises
    ------
    ParameterError
        If the lists do not match.
    """

    ripple: tuple[float, ...] = number(
        (0.0, 0.0, 0.0), "N·m", 0.0, 1e6, "amplitudes of the motor's torque ripple on the output, one for each order"
    )
    ripple_orders: tuple[float, ...] = number(
        (2.0, 6.0, 12.0), "", 0.0, 1000.0, "cycles of the torque ripple per wave-generator revolution"
    )
    ripple_phase: tuple[float, ...] = number(
        (0.0,), "rad", -1e3, 1e3, "phases of the torque ripple; those left out are 0"
    )

    def __post_init__(self) -> None:
        """Compare the lengths of the lists."""
        if len(self.ripple) != len(self.ripple_orders):
            raise ParameterError(
                f"torque.ripple has {len(self.ripple)} amplitudes and torque.ripple_orders {len(self.ripple_orders)} "
                "orders; give one amplitude for each order"
            )
        if len(self.ripple_phase) > len(self.ripple):
            raise ParameterError(
                f"torque.ripple_phase has {len(self.ripple_phase)} phases for {len(self.ripple)} amplitudes; leave out "
                "those too many"
            )

    @property
    def highest_order(self) -> float:
        """Highest order present, in cycles per wave-generator revolution; 0 if there is none."""
        return max((order for m, order in zip(self.ripple, self.ripple_orders, strict=True) if m), default=0.0)

    def torque(self, turn: FloatArray) -> FloatArray | float:
        """Torque [N·m] on the output at the wave-generator angles `turn` [rad], any shape."""
        phases = self.ripple_phase + (0.0,) * (len(self.ripple) - len(self.ripple_phase))
        waves = zip(self.ripple, self.ripple_orders, phases, strict=True)
        return sum((m * np.cos(order * turn + phase) for m, order, phase in waves if m), start=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangingInertia:
    """Inertia on the output as the other joints move and the payload comes and goes: the parameters ``inertia.*``.

    The other joints swing steadily: J/J0 - 1 is a sine wave between `lowest` and `highest` that starts at 0, rising,
    so that J0 (``dynamics.inertia``) is the inertia at the start. The payload adds its own share while it is carried.
    """

    lowest: float = number(0.0, "", -0.9, 0.0, "smallest change of the inertia by the other joints, as a fraction")
    highest: float = number(0.0, "", 0.0, 10.0, "largest change of the inertia by the other joints, as a fraction")
    period: float = number(
        4.0, "s", 0.05, 86_400.0, "time in which the other joints move there and back, as a sine wave"
    )
    payload: float = number(0.0, "", 0.0, 10.0, "inertia of the payload while it is carried, as a fraction")

    def factor(self, times: FloatArray, carried: FloatArray | float) -> FloatArray | float:
        """J(t)/J0 at `times` [s], any shape, with the fraction `carried` of the payload."""
        factor: FloatArray | float = 1.0 + self.payload * carried
        if self.lowest == self.highest:  # both are 0
            return factor
        middle, amplitude = 0.5 * (self.highest + self.lowest), 0.5 * (self.highest - self.lowest)
        start = math.asin(-middle / amplitude)
        return factor + middle + amplitude * np.sin(math.tau / self.period * times + start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What acts on the rig besides the model's own torques.

    Parameters
    ----------
    gravity : float
        Amplitude [N·m] of an eccentric load's torque, a cosine of the output angle.
    gravity_angle : float
        Output angle [rad] at which gravity's torque is largest.
    payload : float
        Amplitude [N·m] that the payload adds to `gravity` while it is carried.
    rigid_body : bool
        Whether the output's own acceleration along the programme counts: its inertia winds up the reducer, and the
        accelerometer feels it. The paper's model leaves it out.
    ripple : MotorRipple
    inertia : ChangingInertia
    """

    gravity: float = 0.0
    gravity_angle: float = 0.0
    payload: float = 0.0
    rigid_body: bool = False
    ripple: MotorRipple = field(default_factory=MotorRipple)
    inertia: ChangingInertia = field(default_factory=ChangingInertia)

    def torque(
        self, motion: Motion, inertia: float, *, own: FloatArray | float = 0.0, drive: bool = True
    ) -> FloatArray | float:
        """Torque [N·m] on the output, of the shape of the motion; 0.0 alone if nothing acts.

        Parameters
        ----------
        motion : Motion
        inertia : float
            Inertia J0 [kg·m²] at the start.
        own : ndarray or float
            Torque [N·m] of the model itself, to which the rest is added.
        drive : bool
            Whether the motor's ripple counts.
        """
        torque = own
        if self.gravity or self.payload:
            weight = self.gravity + self.payload * motion.carried
            torque = torque + weight * np.cos(motion.angle - self.gravity_angle)
        if self.rigid_body:
            torque = torque - inertia * self.inertia_factor(motion) * motion.acceleration
        return torque + self.ripple.torque(motion.turn) if drive else torque

    def inertia_factor(self, motion: Motion) -> FloatArray | float:
        """Inertia J(t)/J0, of the shape of the motion; 1.0 alone where it does not change."""
        return self.inertia.factor(motion.times, motion.carried)

"""What an IMU on the output link measures: its axes, the rotation, gravity and how its axes leak into each other."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.constants import g as standard_gravity

from hd_monitor.arrays import FloatArray
from hd_monitor.parameter import choice, number
from hd_monitor.settings.groups import AXES

from ..drive.chunk import RigChunk
from ..drive.surroundings import Surroundings
from .fault import Fault, FaultSettings

_AXES = "xyz"


@dataclass(frozen=True, slots=True, kw_only=True)
class ImuSettings:
    """How the IMU sits on the link."""

    radius: float = number(0.55, "m", 0.0, 100.0, "distance of the accelerometer from the joint's axis")
    imu_axis: str = choice("y", AXES, "axis of the IMU that points along the motion (tangential)")
    cross_axis: float = number(0.0, "", -0.5, 0.5, "fraction of each other acceleration that leaks into an axis")


class ImuReadings(NamedTuple):
    """Readings of a stretch, shape (samples, 3) each."""

    force: FloatArray
    """Specific force [m/s²]."""
    turning: FloatArray
    """Angular velocity [rad/s]."""


class Imu:
    """An IMU whose tangential axis is the accelerometer.

    Parameters
    ----------
    settings : ImuSettings
        `imu_axis` has the next axis in the order x, y, z, x along the joint's axis, and the remaining one points
        outwards: for y these are z and x. With a minus it is turned around by half a turn about the outward axis.
    fault : FaultSettings, optional
        May be replaced while it runs (attribute `fault.settings`).
    seed : int
        The accelerometer's, so that both fail alike.
    """

    def __init__(self, settings: ImuSettings, fault: FaultSettings | None = None, *, seed: int = 0) -> None:
        self.fault = Fault(fault or FaultSettings(), seed=seed)
        self._settings = settings

    def measure(
        self, felt: RigChunk, samples: FloatArray, *, surroundings: Surroundings, gain: float = 1.0
    ) -> ImuReadings:
        """Readings of a stretch of motion.

        Parameters
        ----------
        felt : RigChunk
        samples : ndarray, shape (samples,)
            The accelerometer's samples of it [rad/s²].
        surroundings : Surroundings
            With a torque of gravity the joint's axis is horizontal and the tangential axis feels gravity; else it is
            vertical.
        gain : float
            The accelerometer's.
        """
        settings = self._settings
        sign = -1.0 if settings.imu_axis.startswith("-") else 1.0
        tangential = _AXES.index(settings.imu_axis[-1])
        along, outward = (tangential + 1) % 3, (tangential + 2) % 3
        force, turning = np.zeros((len(felt), 3)), np.zeros((len(felt), 3))
        left = self.fault.sensitivity(felt.times)
        scale = gain * left
        force[:, tangential] = settings.radius * samples
        force[:, outward] = -settings.radius * felt.speed**2 * scale
        if surroundings.gravity or surroundings.payload:
            turn = felt.angle - surroundings.gravity_angle
            force[:, tangential] -= standard_gravity * np.cos(turn) * scale
            force[:, outward] -= standard_gravity * np.sin(turn) * scale
        else:
            force[:, along] = standard_gravity * scale
        turning[:, along] = (felt.speed + felt.velocity) * left
        # Mounted the other way round: rotated by half a turn about the outward axis.
        force[:, [tangential, along]] *= sign
        turning[:, along] *= sign
        if settings.cross_axis:
            force += settings.cross_axis * (force.sum(axis=1, keepdims=True) - force)
        readings = self.fault.interrupt(felt.times, np.hstack([force, turning]))
        return ImuReadings(readings[:, :3], readings[:, 3:])

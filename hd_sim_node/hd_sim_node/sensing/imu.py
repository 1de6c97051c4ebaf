"""What an IMU on the output link measures: its axes, the rotation and gravity."""

import numpy as np
from scipy.constants import g as standard_gravity

from hd_monitor.arrays import FloatArray

from ..drive.chunk import RigChunk
from ..drive.surroundings import Surroundings

_AXES = "xyz"


def imu_readings(
    motion: RigChunk, samples: FloatArray, *, radius: float, axis: str, surroundings: Surroundings
) -> tuple[FloatArray, FloatArray]:
    """Readings of an IMU at `radius` [m] from the joint's axis.

    Parameters
    ----------
    motion : RigChunk
    samples : ndarray, shape (samples,)
        Measured torsional acceleration [rad/s²].
    radius : float
    axis : str
        The axis along the motion, ``'y'`` or with a minus. The next one in the order x, y, z, x lies along the
        joint's axis and the remaining one points outwards, so that for y these are z and x.
    surroundings : Surroundings
        With a torque of gravity or payload the joint's axis is horizontal and the tangential axis feels gravity; else
        it is vertical.

    Returns
    -------
    force, turning : ndarray, shape (samples, 3)
        Specific force [m/s²] and angular velocity [rad/s].
    """
    sign = -1.0 if axis.startswith("-") else 1.0
    tangential = _AXES.index(axis[-1])
    along, outward = (tangential + 1) % 3, (tangential + 2) % 3
    force, turning = np.zeros((len(motion), 3)), np.zeros((len(motion), 3))
    force[:, tangential] = radius * samples
    force[:, outward] = -radius * motion.speed**2
    if surroundings.gravity or surroundings.payload:
        turn = motion.angle - surroundings.gravity_angle
        force[:, tangential] -= standard_gravity * np.cos(turn)
        force[:, outward] -= standard_gravity * np.sin(turn)
    else:
        force[:, along] = standard_gravity
    turning[:, along] = motion.speed + motion.velocity
    # Mounted the other way round: rotated by half a turn about the outward axis.
    force[:, [tangential, along]] *= sign
    turning[:, along] *= sign
    return force, turning

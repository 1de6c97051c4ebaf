"""What drives the model besides the defects: the measured torque and the joint's own acceleration, without noise.

The reducer is a lightly damped resonator: noise of a per cent on a measured torque, taken at its word, would excite it
more than a defect does. What a joint transmits follows its angle and its motion, and else changes slowly.
"""

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter1d

FloatArray = npt.NDArray[np.float64]

SLOW = 0.08
"""Standard deviation [s] of the smoothing of what angle and motion do not explain: 2 Hz."""

_QUICK = 0.012  # s, smoothing of the joint's own acceleration
_LOAD_ORDERS = (1, 2)  # cycles per output revolution
_FRICTION_SPEED = 0.03  # of the top speed, over which friction changes its sign
_RIDGE = 1e-6


def own_acceleration(speed: FloatArray, period: float) -> FloatArray:
    """Acceleration [rad/s²] of the output, from its speed [rad/s] at samples `period` [s] apart."""
    if float(np.ptp(speed)) == 0.0:
        return np.zeros(speed.shape)
    return np.asarray(gaussian_filter1d(np.gradient(speed, period), _QUICK / period, mode="nearest"))


def smooth_torque(
    torque: FloatArray, angle: FloatArray, speed: FloatArray, acceleration: FloatArray, period: float
) -> FloatArray:
    """Return a measured torque [N·m] without its noise.

    A regression on angle (gravity, load), speed (friction) and acceleration keeps what is quick but explained, such
    as the friction's change of sign at a reversal; of the rest only what is slow is kept.
    """
    if float(np.ptp(torque)) == 0.0:
        return torque
    top = float(np.abs(speed).max()) or 1.0
    columns = [np.ones(angle.size), speed / top, np.tanh(speed / (_FRICTION_SPEED * top)), acceleration]
    columns += [wave(order * angle) for order in _LOAD_ORDERS for wave in (np.cos, np.sin)]
    matrix = np.stack(columns, axis=1)
    matrix /= np.linalg.norm(matrix, axis=0) + 1e-300
    gram = matrix.T @ matrix
    explained = matrix @ np.linalg.solve(gram + _RIDGE * np.eye(len(gram)), matrix.T @ torque)
    return np.asarray(explained + gaussian_filter1d(torque - explained, SLOW / period, mode="nearest"))

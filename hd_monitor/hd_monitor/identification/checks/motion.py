"""Whether positions and velocities of a joint describe the same motion, and if not, which mistake would explain it."""

import math

import numpy as np

from ...arrays import FloatArray
from ..limitation import Limitation, LimitationCode, blocker

WINDOW = 0.05
"""Time [s] over which the two are compared: longer than the step between joint states of any useful rate."""

SLIP = 0.4
"""Root mean square of their difference, over the larger of the two, from which they contradict each other."""

_FOLLOWS = 0.9  # correlation from which one is a multiple of the other
_STILL = 0.02  # size of one over the other below which it does not move
_CLOSE = 1.1  # factor within which a ratio is that of a known mistake


def motion_contradiction(
    times: FloatArray, angle: FloatArray, speed: FloatArray, *, minimum_speed: float, reduction: float
) -> Limitation | None:
    """Return how positions and velocities contradict each other; None if they do not, or if the joint stands.

    Parameters
    ----------
    times : ndarray, shape (samples,)
        Rising [s].
    angle, speed : ndarray, shape (samples,)
        Output angle [rad], unwrapped, and output speed [rad/s], both finite.
    minimum_speed : float
        Output speed [rad/s] below which the joint counts as standing.
    reduction : float
        Motor revolutions per output revolution.
    """
    if times.size < 3 or times[-1] - times[0] < 2.0 * WINDOW:
        return None
    first = np.flatnonzero(np.diff(np.floor((times - times[0]) / WINDOW), prepend=-1.0))
    travelled = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(times))])
    moved, said = np.diff(angle[first]), np.diff(travelled[first])
    size_moved, size_said = float(np.linalg.norm(moved)), float(np.linalg.norm(said))
    larger = max(size_moved, size_said)
    if larger < minimum_speed * WINDOW * math.sqrt(moved.size) or float(np.linalg.norm(moved - said)) <= SLIP * larger:
        return None
    if abs(float(moved @ said)) <= _FOLLOWS * size_moved * size_said:
        if size_said < _STILL * size_moved:
            return blocker(LimitationCode.VELOCITY_ZERO, moved_deg=math.degrees(float(np.abs(moved).sum())))
        if size_moved < _STILL * size_said:
            return blocker(LimitationCode.POSITION_STILL, velocity_deg_s=math.degrees(float(np.abs(speed).max())))
        slip = 100.0 * float(np.linalg.norm(moved - said)) / larger
        return blocker(LimitationCode.MOTION_INCONSISTENT, difference_percent=slip)
    ratio = float(moved @ said) / size_said**2
    for mistake, factor in _mistakes(reduction).items():
        if 1.0 / _CLOSE < ratio / factor < _CLOSE:
            return blocker(LimitationCode.VELOCITY_UNIT, ratio=ratio, mistake=mistake)
    return blocker(LimitationCode.VELOCITY_SCALE, ratio=ratio)


def _mistakes(reduction: float) -> dict[str, float]:
    """Changes of position over those that velocities tell, by the mistake that brings them about."""
    return {
        "velocities of the opposite sign": -1.0,
        "velocities in deg/s": math.radians(1.0),
        "velocities in rpm": math.tau / 60.0,
        "velocities of the motor": 1.0 / reduction,
        "positions in degrees": math.degrees(1.0),
        "positions of the motor": reduction,
    }

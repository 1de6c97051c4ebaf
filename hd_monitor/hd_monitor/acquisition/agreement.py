"""Whether positions and velocities of a joint describe the same motion, and if not, which mistake would explain it."""

import math
from typing import NamedTuple

import numpy as np
from numpy.linalg import norm

from ..limitation import Limitation, LimitationCode, blocker
from .record import JointSamples

WINDOW = 0.05
"""Time [s] over which the two are compared: longer than the step between joint states of any useful rate."""

SLIP = 0.4
"""Root mean square of their difference, over the larger of the two, from which they contradict each other."""

_FOLLOWS = 0.9  # correlation from which one is a multiple of the other
_STILL = 0.02  # size of one over the other below which it does not move
_WRAPPED = 1.5 * math.pi  # rad between two positions from which the joint reports ±π alternately
_CLOSE = 1.1  # factor within which a ratio is that of a known mistake


class MotionAgreement(NamedTuple):
    """Whether a joint moves and, if so, how its positions and velocities contradict each other, if they do."""

    moves: bool
    contradiction: Limitation | None


def compare_motion(samples: JointSamples, *, minimum_speed: float, reduction: float) -> MotionAgreement:
    """Compare the positions of joint states with their velocities; those without either are left out.

    Parameters
    ----------
    samples : JointSamples
    minimum_speed : float
        Output speed [rad/s] below which the joint counts as standing.
    reduction : float
        Motor revolutions per output revolution.
    """
    times, angle, speed = samples.times, samples.angle, samples.speed
    if not (known := np.isfinite(angle) & np.isfinite(speed)).all():
        times, angle, speed = times[known], angle[known], speed[known]
    if times.size < 3 or times[-1] - times[0] < 2.0 * WINDOW:
        return MotionAgreement(False, None)
    steps = angle[1:] - angle[:-1]
    if (wrapped := np.abs(steps) > _WRAPPED).any():
        steps -= math.tau * np.rint(steps / math.tau) * wrapped
    moved, said = steps, 0.5 * (speed[1:] + speed[:-1]) * (times[1:] - times[:-1])
    size_moved, size_said, apart = (float(norm(way)) for way in (moved, said, moved - said))
    if apart > SLIP * max(size_moved, size_said):
        # Between single messages quantisation and noise differ, too
        first = np.flatnonzero(np.diff(np.floor((times[1:] - times[0]) / WINDOW), prepend=-1.0))
        moved, said = np.add.reduceat(moved, first), np.add.reduceat(said, first)
        size_moved, size_said, apart = (float(norm(way)) for way in (moved, said, moved - said))
    larger = max(size_moved, size_said)
    if larger <= minimum_speed * float(times[-1] - times[0]) / math.sqrt(moved.size):
        return MotionAgreement(False, None)
    difference = apart / larger
    if difference <= SLIP:
        return MotionAgreement(True, None)
    correlation = float((moved / size_moved) @ (said / size_said)) if size_moved and size_said else 0.0
    if abs(correlation) > _FOLLOWS:
        return MotionAgreement(True, _scaled(correlation * (size_moved / size_said), reduction))
    if size_said < _STILL * size_moved and float(np.abs(speed).max()) > minimum_speed:
        found = blocker(LimitationCode.POSITION_JUMPS, jump_deg=math.degrees(float(np.abs(steps).max())))
    elif size_said < _STILL * size_moved:
        found = blocker(LimitationCode.VELOCITY_ZERO, moved_deg=math.degrees(float(np.abs(moved).sum())))
    elif size_moved < _STILL * size_said:
        found = blocker(LimitationCode.POSITION_STILL, velocity_deg_s=math.degrees(float(np.abs(speed).max())))
    else:
        found = blocker(LimitationCode.MOTION_INCONSISTENT, difference_percent=100.0 * difference)
    return MotionAgreement(True, found)


def _scaled(ratio: float, reduction: float) -> Limitation:
    """Return the contradiction of positions that are a multiple of what the velocities say."""
    for mistake, factor in _mistakes(reduction).items():
        if 1.0 / _CLOSE < ratio / factor < _CLOSE:
            return blocker(LimitationCode.VELOCITY_UNIT, ratio=ratio, mistake=mistake)
    return blocker(LimitationCode.VELOCITY_SCALE, ratio=ratio)


def _mistakes(reduction: float) -> dict[str, float]:
    """Changes of position over those implied by the velocities, by the mistake that causes them."""
    return {
        "velocities of the opposite sign": -1.0,
        "velocities in deg/s": math.radians(1.0),
        "velocities in rpm": math.tau / 60.0,
        "velocities of the motor": 1.0 / reduction,
        "positions in degrees": math.degrees(1.0),
        "positions of the motor": reduction,
    }

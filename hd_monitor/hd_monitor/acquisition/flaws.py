"""What the messages of an input show to be wrong with it, whatever the reducer does."""

import math

import numpy as np
from numpy.linalg import norm

from ..arrays import FloatArray
from ..limitation import Limitation, LimitationCode, blocker
from ..robust import robust_std
from .record import JointSamples

_TURN = 0.3  # rad that a line may turn in an error of the motion, root mean square
_FEWEST = 16  # messages
_WHOLE = 0.02  # of a step, from which differences are no multiples of it
_EXPLAINED = 0.4  # of the way that uneven stamps add, from which positions and velocities show that they are wrong
_COARSE = 1.0  # standard deviations of a signal that one of its steps covers
_NOISY = 0.5  # of the effort's size
_HELD, _SELDOM = 0.8, 0.2  # part of the messages that repeat the effort before, and time [s] that it stands still


def motion_flaw(samples: JointSamples, order: float) -> Limitation | None:
    """Return what of joint states blurs lines at an order [cycles per output revolution]; None if nothing does."""
    known = np.isfinite(samples.angle)
    times, angle, speed = samples.times[known], samples.angle[known], samples.speed[known]
    if times.size < _FEWEST:
        return None
    moved, apart = np.diff(angle), np.diff(times)
    inside = np.abs(moved) < math.pi  # not from -π to π
    moved, apart, mean = moved[inside], apart[inside], (0.5 * (speed[1:] + speed[:-1]))[inside]
    sizes = np.abs(moved)
    if sizes.any():
        step = float(sizes[sizes > 0.0].min())
        steps, turn = np.rint(sizes / step), order * step / math.sqrt(12.0)
        if turn > _TURN and np.ptp(steps) > 0.0 and float(np.abs(sizes / step - steps).max()) < _WHOLE:
            return blocker(LimitationCode.POSITION_STEPS, step_rad=step, turn_deg=math.degrees(turn))
    uneven = mean * (apart - float(np.median(apart)))  # what jitter makes of the way
    jitter = float(np.std(apart)) / math.sqrt(2.0)
    turn = order * jitter * math.sqrt(float(np.mean(mean**2)))
    if turn > _TURN and norm(moved - mean * apart) > _EXPLAINED * norm(uneven):  # false without velocities
        return blocker(LimitationCode.MOTION_JITTER, jitter_ms=1e3 * jitter, turn_deg=math.degrees(turn))
    return None


def effort_flaw(samples: JointSamples) -> Limitation | None:
    """Return what makes efforts unfit for a measured torque; None if nothing does."""
    known = np.isfinite(samples.effort)
    times, effort, forward = samples.times[known], samples.effort[known], samples.speed[known] > 0.0
    if times.size < _FEWEST:
        return None
    reverses = forward[1:] != forward[:-1]  # there friction changes its sign, and a constant effort with it
    changes = int(np.count_nonzero(np.diff(effort)[~reverses]))
    held = float(times[-1] - times[0]) / max(changes, 1)
    if 0 < changes < (1.0 - _HELD) * effort.size and held > _SELDOM:
        return blocker(LimitationCode.EFFORT_HELD, held_s=held)
    noise = robust_std(np.diff(effort, 2)) / math.sqrt(6.0)
    if noise > _NOISY * math.sqrt(float(np.mean(effort**2))):
        return blocker(LimitationCode.EFFORT_NOISY, std_nm=noise)
    return None


def vibration_flaw(values: FloatArray) -> Limitation | None:
    """Return what makes a vibration [rad/s²], shape (N,), with NaN where bad, too coarse; None if it is not."""
    values = values[np.isfinite(values)]
    if values.size < _FEWEST:
        return None
    levels = np.unique(values)
    if not 1 < levels.size < values.size // _FEWEST:
        return None
    step = float(np.median(np.diff(levels)))
    if step < _COARSE * float(np.std(values)):
        return None
    return blocker(LimitationCode.VIBRATION_STEPS, step=step, levels=levels.size)

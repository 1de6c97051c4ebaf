"""A health-check move: strokes there and back whose speeds carry the first pair of lines where they tell most.

That is around the natural frequency: there a stiffness that fluctuates and a transmission error answer differently,
and both stand out of the motor's ripple, which slow motion shows alone. Different speeds distinguish a line from a
tone, both directions show friction, and the longest travel separates the two splines best. The slowest strokes come
first, then faster ones up through the resonance and back: far below it the lines show torque and stiffness as they are,
so that the estimate is near the truth by the time the resonance comes.
"""

import itertools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..errors import ParameterError
from ..orders.joint_segment import HIGHEST_SHARE, LOWEST_FREQUENCY
from ..settings import JointSettings

BAND = (0.5, 1.3)
"""Frequencies of the first pair, as parts of the natural frequency, between which the strokes' top speeds lie."""

SPEEDS = 5
"""Top speeds, evenly spaced by their logarithm; each is driven there and back."""

FEWEST = 3
"""Strokes there and back below which the travel is shortened."""

_SHORTER = 0.9


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveLimits:
    """What a joint may do.

    Attributes
    ----------
    lower, upper : float
        Ends of the travel [rad].
    speed, acceleration : float
        [rad/s], [rad/s²]
    """

    lower: float
    upper: float
    speed: float
    acceleration: float

    def __post_init__(self) -> None:
        """Refuse limits within which nothing can move."""
        finite = all(map(math.isfinite, (self.lower, self.upper, self.speed, self.acceleration)))
        if not finite or self.lower >= self.upper or min(self.speed, self.acceleration) <= 0.0:
            raise ParameterError(
                f"travel from {self.lower:g} to {self.upper:g} rad at {self.speed:g} rad/s and {self.acceleration:g} "
                "rad/s² is no motion; the upper end must lie above the lower one, speed and acceleration above 0"
            )


class Move(NamedTuple):
    """Corners of a motion whose acceleration is constant in between: a cubic interpolation reproduces it exactly."""

    times: FloatArray
    """[s], from 0"""
    positions: FloatArray
    """[rad]"""
    velocities: FloatArray
    """[rad/s]"""


def plan_move(settings: JointSettings, limits: MoveLimits, seconds: float) -> Move:
    """Plan strokes that fill a time.

    Raises
    ------
    ParameterError
        If the joint cannot turn fast enough for its lines to show, or the time is too short for two strokes.
    """
    slowest, fastest = top_speeds(settings, limits)
    travel = whole = limits.upper - limits.lower
    peaks = np.geomspace(slowest, fastest, SPEEDS)
    while len(rising := sorted(_fitting(peaks, travel, limits, seconds))) < FEWEST and travel > 0.05 * whole:
        travel *= _SHORTER
    if not rising:
        raise ParameterError(f"{seconds:g} s are too short for two strokes at {fastest:.3g} rad/s; allow more time")
    start = 0.5 * (limits.lower + limits.upper - travel)
    times, positions, velocities = [0.0], [start], [0.0]
    for peak in [*rising[::2], *rising[1::2][::-1]]:
        for sign in (1.0, -1.0):
            ramp = peak / limits.acceleration
            hold = travel / peak - ramp
            for duration, velocity in ((ramp, sign * peak), (hold, sign * peak), (ramp, 0.0)):
                if duration > 1e-9:
                    times.append(times[-1] + duration)
                    positions.append(positions[-1] + 0.5 * (velocities[-1] + velocity) * duration)
                    velocities.append(velocity)
    slower = seconds / times[-1]
    return Move(slower * np.array(times), np.array(positions), np.array(velocities) / slower)


def top_speeds(settings: JointSettings, limits: MoveLimits) -> tuple[float, float]:
    """Return the slowest and the fastest top speed [rad/s] at which the first pair tells something.

    Raises
    ------
    ParameterError
        If the joint may not turn that fast.
    """
    lower_line, upper_line = settings.reducer.output_orders
    standing = settings.analysis.minimum_speed * math.tau / 60.0 / settings.reducer.reduction
    if settings.sensorless:
        standing = max(standing, LOWEST_FREQUENCY * math.tau / lower_line)
    natural = settings.dynamics.natural_frequency
    high = min(BAND[1] * natural, HIGHEST_SHARE * settings.input.expected_rate)
    fastest = min(high * math.tau / upper_line, limits.speed)
    if fastest <= 2.0 * standing:
        raise ParameterError(
            f"at up to {limits.speed:g} rad/s the lines stay below {limits.speed * upper_line / math.tau:.3g} Hz, too "
            "slow to tell anything; allow more speed, or a higher rate in input.expected_rate"
        )
    # Below the resonance the lines are weaker, but they are there
    slowest = min(BAND[0] * natural * math.tau / lower_line, 0.5 * fastest)
    return max(slowest, 1.5 * standing), fastest


def _fitting(peaks: FloatArray, travel: float, limits: MoveLimits, seconds: float) -> list[float]:
    """Top speeds of the strokes there and back that fit into a time: all in turn, the fastest first."""
    total, fitting = 0.0, list[float]()
    for peak in itertools.cycle(np.minimum(peaks[::-1], math.sqrt(limits.acceleration * travel)).tolist()):
        total += 2.0 * (travel / peak + peak / limits.acceleration)
        if total > seconds:
            break
        fitting.append(peak)
    return fitting


def trajectory_yaml(move: Move, joint: str) -> str:
    """Write a move as a ``trajectory_msgs/JointTrajectory`` in YAML."""
    lines = [f"joint_names: [{joint}]", "points:"]
    for time, position, velocity in zip(*(column.tolist() for column in move), strict=True):
        nanoseconds = round(1e9 * time)
        lines += [
            f"- positions: [{position:.6f}]",
            f"  velocities: [{velocity:.6f}]",
            f"  time_from_start: {{sec: {nanoseconds // 10**9}, nanosec: {nanoseconds % 10**9}}}",
        ]
    return "\n".join(lines) + "\n"

"""Where to look for other solutions, and on which data: the cost has local minima in load, lag and resonance."""

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..segment.segment import Segment
from .gauss_newton import BETTER, Fit, Problem
from .noise import NoiseFloor
from .unknowns import Unknowns

START_LOADS = tuple(1.5 * cmath.exp(0.5j * math.pi * quarter) for quarter in range(4))
"""Loads twice per output revolution, in units of the reference torque."""

START_FREQUENCIES = (-1.2, -0.8, -0.4, 0.4, 0.8, 1.2)
"""ln fn relative to the one given, in its standard deviations."""

DELAY_STEP = 3e-3
"""Distance [s] between starts for the lag of the clocks."""

NEWEST = 3.0
"""Motion [s] of the newest segments on which other solutions are tried."""


def newest_segments(segments: Sequence[Segment]) -> list[Segment]:
    """Return the newest ones, as many as other solutions are tried on, the newest first."""
    newest = [segments[-1]]
    for segment in segments[-2::-1]:
        if sum(s.duration for s in newest) + segment.duration > NEWEST:
            break
        newest.append(segment)
    return newest


def load_start(unknowns: Unknowns, load: complex) -> FloatArray:
    """Return values without any defects, all that is given being right, and with a load twice per output revolution."""
    start = unknowns.zero()
    start[unknowns.load_line(2)] = load.real, load.imag
    return start


def load_starts(unknowns: Unknowns) -> list[FloatArray]:
    """Starts for the load, whose phase has local minima."""
    return [load_start(unknowns, load) for load in (0.0, *START_LOADS)]


def other_starts(unknowns: Unknowns, std: FloatArray) -> list[FloatArray]:
    """Starts for a natural frequency that is not the one given, by its standard deviation among those of all."""
    return _shifted(unknowns, unknowns.frequency, float(std[unknowns.frequency]) * np.asarray(START_FREQUENCIES))


def delay_starts(unknowns: Unknowns, std: FloatArray) -> list[FloatArray]:
    """Starts for clocks that do not agree."""
    steps = int(0.75 * float(std[unknowns.delay]) / DELAY_STEP)
    return _shifted(unknowns, unknowns.delay, DELAY_STEP * np.r_[-steps:0, 1 : steps + 1])


def _shifted(unknowns: Unknowns, place: int, shifts: FloatArray) -> list[FloatArray]:
    return [np.where(unknowns.mask(place), shift, 0.0) for shift in shifts if shift]


def signal_level(segments: Sequence[Segment]) -> NoiseFloor:
    """White noise as strong as the whole signal: where a fit starts."""
    densities = [2.0 * s.period * float(np.mean(s.transform(s.acceleration[:, None]) ** 2)) / s.fill for s in segments]
    return NoiseFloor.white(max(float(np.mean(densities)), 1e-30))


def multistart_newest(problem: Problem, starts: Sequence[FloatArray], *, rounds: int) -> list[tuple[Problem, Fit]]:
    """Solve from several starts on the newest data; return the solutions, the best first, with their floors."""
    newest = newest_segments(problem.segments)
    return replace(problem, segments=newest, floor=signal_level(newest)).multistart(starts, rounds=rounds)


def is_better(problem: Problem, fit: Fit, values: FloatArray) -> bool:
    """Whether a fit explains its data better than other values do, beyond what more freedom brings.

    The likelihood is that of white noise whose variance is at its own best.
    """
    present = problem.at(values)
    freedom = fit.equations.freedom
    return 0.5 * freedom * math.log(present.equations.cost / max(fit.equations.cost, 1e-300)) > BETTER

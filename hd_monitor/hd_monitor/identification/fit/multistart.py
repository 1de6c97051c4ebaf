"""Where to look for other solutions, and on which data: the cost has local minima in load, lag and resonance."""

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..segment.segment import Segment
from .gauss_newton import Fit, Problem
from .noise import NoiseFloor
from .unknowns import Unknowns

START_LOADS = tuple(1.5 * cmath.exp(0.5j * math.pi * quarter) for quarter in range(4))
"""Loads twice per output revolution, in units of the reference torque."""

START_FREQUENCIES = (-0.12, -0.08, -0.04, 0.04, 0.08, 0.12)
"""ln fn relative to the one given."""

START_DELAYS = (-0.012, -0.006, -0.003, 0.003, 0.006, 0.012)
"""Lags [s] between the clocks."""

NEWEST = 4.5
"""Motion [s] of the newest segments on which other solutions are tried."""

BETTER = 30.0
"""Logarithm of the likelihood ratio by which another solution must beat the present one on them to be followed."""


def newest_segments(segments: Sequence[Segment]) -> list[Segment]:
    """Return the newest ones, as many as other solutions are tried on, the newest first."""
    newest = [segments[-1]]
    for segment in segments[-2::-1]:
        if sum(s.duration for s in newest) + segment.duration > NEWEST:
            break
        newest.append(segment)
    return newest


def load_start(unknowns: Unknowns, values: FloatArray, load: complex) -> FloatArray:
    """Return values without any defects, and with a load twice per output revolution."""
    start = values * ~unknowns.mask(unknowns.stiffness, unknowns.load, unknowns.displacement)
    start[unknowns.load_line(2)] = load.real, load.imag
    return start


def load_starts(unknowns: Unknowns, values: FloatArray, *, thorough: bool) -> list[FloatArray]:
    """Return the best values so far, and starts for the load, whose phase has local minima: all of them, or a few."""
    loads = (0.0, *(START_LOADS if thorough else START_LOADS[::2]))
    return [values, *(load_start(unknowns, values, load) for load in loads)]


def other_starts(unknowns: Unknowns, *, frequency: bool, delay: bool, thorough: bool) -> list[FloatArray]:
    """Starts for what was given and may be wrong: natural frequency and agreement of the clocks.

    Parameters
    ----------
    unknowns : Unknowns
    frequency, delay : bool
        Which of them may be wrong.
    thorough : bool
        Whether to try all starts, or a few.
    """
    first, step = (0, 1) if thorough else (1, 3)
    wanted: list[tuple[int, float]] = []
    if frequency:
        wanted += [(unknowns.frequency, shift) for shift in START_FREQUENCIES[first::step]]
    if delay:
        wanted += [(unknowns.delay, lag) for lag in START_DELAYS[first::step]]
    return [np.where(unknowns.mask(place), value, 0.0) for place, value in wanted]


def signal_level(segments: Sequence[Segment]) -> NoiseFloor:
    """White noise as strong as the whole signal: where a fit starts."""
    densities = [2.0 * s.period * float(np.mean(s.transform(s.acceleration[:, None]) ** 2)) / s.fill for s in segments]
    return NoiseFloor.white(max(float(np.mean(densities)), 1e-30))


def multistart_newest(problem: Problem, starts: Sequence[FloatArray], *, rounds: int) -> tuple[Problem, Fit]:
    """Solve from several starts on the newest data; the problem returned has the floor that belongs to the best fit."""
    newest = newest_segments(problem.segments)
    return replace(problem, segments=newest, floor=signal_level(newest)).multistart(starts, rounds=rounds)


def is_better(problem: Problem, fit: Fit, values: FloatArray) -> bool:
    """Whether a fit explains its data better than other values do, beyond what more freedom brings.

    The likelihood is that of white noise whose variance is at its own best.
    """
    present = problem.at(values)
    freedom = fit.equations.freedom
    return 0.5 * freedom * math.log(present.equations.cost / max(fit.equations.cost, 1e-300)) > BETTER

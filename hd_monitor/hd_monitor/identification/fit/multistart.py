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

_LAG_STEP, _LARGEST_LAG = 1e-3, 2.5  # s; standard deviations
_LAGS = 2  # that are tried

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
    shifts = float(std[unknowns.frequency]) * np.asarray(START_FREQUENCIES)
    return [np.where(unknowns.mask(unknowns.frequency), shift, 0.0) for shift in shifts if shift]


def with_lags(problem: Problem, start: FloatArray, std: FloatArray) -> list[FloatArray]:
    """Return a start without lines, with each lag of the clocks with which lines would explain most of the newest data.

    A lag of the motion turns the spectrum of what is measured against that of the lines, so that one linearisation
    serves every lag.
    """
    u = problem.predictor.unknowns
    steps = int(_LARGEST_LAG * float(std[u.delay]) / _LAG_STEP)
    if not steps:
        return [start]
    lags = _LAG_STEP * np.arange(-steps, steps + 1)
    segments = newest_segments(problem.segments)
    fit = replace(problem, segments=segments, floor=signal_level(segments)).at(start)
    lines = problem.active & u.mask(u.stiffness, u.displacement, u.load)
    scores = np.zeros((lags.size, int(lines.sum())))
    for item in fit.segments:
        bins = item.std.size // 2
        turn = np.exp(-1j * math.tau * np.multiply.outer(lags, item.segment.frequencies))
        turned = turn * (item.residual[:bins] + 1j * item.residual[bins:])
        scores += np.concatenate([turned.real, turned.imag], axis=1) / item.std @ item.derivatives[:, lines]
    information = (fit.equations.information + problem.prior.matrix)[np.ix_(lines, lines)]
    gains = np.einsum("ij,ij->i", scores, np.linalg.lstsq(information, scores.T, rcond=1e-13)[0].T)
    gains -= (lags / std[u.delay]) ** 2
    peaks = [n for n in range(lags.size) if gains[n] == gains[max(n - 2, 0) : n + 3].max()]
    likely = sorted(peaks, key=lambda n: -gains[n])[:_LAGS]
    return [np.where(u.mask(u.delay), lag, start) for lag in lags[likely]]


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

"""Whether the model with other tooth numbers explains the motion better: decides where lines alone do not."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...errors import ParameterError
from ...reducer import Reducer
from ..fit.gauss_newton import Fit, Problem
from ..fit.multistart import START_LOADS, load_start, signal_level
from ..segment.segment import Segment, SegmentBuilder

LONGEST = 1.5
"""Motion [s] of the oldest and of the newest segment that a trial looks at: far apart, few samples tell orders."""

PROOF = 50.0
"""Logarithm of the likelihood ratio by which other teeth must beat those given."""

GAIN = 1.15
"""Variance left with the given teeth over that left with others, from which these are accepted: a tone, smeared over
the orders by a changing speed, can be mimicked in part, but not so far."""

_ROUNDS = 4


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ToothTrial:
    """The circumstances under which tooth numbers are tried.

    Attributes
    ----------
    problem : Problem
        Recent motion as prepared for the fit with the given teeth; its oldest and its newest part are used.
    values : ndarray, shape (unknowns,)
        Best values with the teeth given.
    builder : SegmentBuilder
        Of the segments in `problem`.
    one_speed : bool
        Whether all motion was at one speed, where what looks like a foreign tone may be the line of other teeth.
    """

    problem: Problem
    values: FloatArray
    builder: SegmentBuilder
    one_speed: bool

    def best(self, given: Reducer, others: Sequence[Reducer]) -> Reducer | None:
        """Return the one of some reducers that explains the motion far better than the given one; None if none does.

        The likelihood is that of white noise whose variance is at its own best, over the band that all fits look at.
        """
        # what given teeth need to make up for being wrong, such as another resonance, would only mislead others
        u, active = self.problem.predictor.unknowns, self.problem.active
        plain = replace(self.problem, active=active & ~u.mask(u.frequency, u.damping, u.delay))
        # the same chance for the given ones: their best values so far may be those of a local minimum
        own = [fit for fit in (self._fit(given, self.problem, self.values), self._fit(given, plain)) if fit]
        fits = {other: fit for other in others if (fit := self._fit(other, plain))}
        if not own or not fits:
            return None
        band = min(item.segment.highest_frequency for fit in (*own, *fits.values()) for item in fit.segments)
        power, freedom = min((_power(fit, band) for fit in own), key=lambda left: left[0] / left[1])
        left = {other: _power(fit, band) for other, fit in fits.items()}
        best = min(left, key=lambda other: left[other][0] / left[other][1])
        gain = (power / freedom) / (left[best][0] / left[best][1])
        return best if gain > GAIN and 0.5 * min(freedom, left[best][1]) * math.log(gain) > PROOF else None

    def _fit(self, reducer: Reducer, problem: Problem, start: FloatArray | None = None) -> Fit | None:
        """Fit teeth from a start, or without defects from no load and from one; None where that is not possible."""
        builder = replace(self.builder, reducer=reducer, keep_tones=self.one_speed)
        try:
            segments = [builder.build([record], None) for record in _records(problem.segments)]
            own = replace(problem, segments=segments, floor=signal_level(segments))
            if start is not None:
                return own.solve(start, rounds=_ROUNDS)
            u = problem.predictor.unknowns
            starts = [load_start(u, load) for load in (0.0, START_LOADS[0])]
            return own.multistart(starts, rounds=_ROUNDS)[0][1]
        except (ParameterError, FloatingPointError, np.linalg.LinAlgError):
            return None  # these teeth's lines are too fast for the sampling rate, or nothing fits


def _records(segments: Sequence[Segment]) -> list[Record]:
    """The oldest and the newest part of the motion."""
    oldest, newest = segments[0], segments[-1]
    if len(segments) == 1:
        return [_cut(newest, slice(0, round(2.0 * LONGEST / newest.period)))]
    return [
        _cut(oldest, slice(0, round(LONGEST / oldest.period))),
        _cut(newest, slice(-round(LONGEST / newest.period), None)),
    ]


def _cut(segment: Segment, part: slice) -> Record:
    """A part of a segment, as a record."""
    return Record(
        start=0.0,  # when it was makes no difference
        period=segment.period,
        acceleration=np.where(segment.used, segment.acceleration, np.nan)[part],
        angle=segment.angle[part],
        speed=segment.speed[part],
        torque=segment.at_steps.torque[:: segment.substeps][part],
    )


def _power(fit: Fit, band: float) -> tuple[float, float]:
    """What a fit leaves up to a frequency [Hz]: sum of squares times sample periods, and its degrees of freedom."""
    power = freedom = 0.0
    for item in fit.segments:
        segment = item.segment
        seen = segment.frequencies <= band
        left = item.residual.reshape(2, -1)[:, seen]
        power += segment.period * float(np.sum(left**2))
        freedom += 2.0 * float(np.count_nonzero(seen)) * segment.fill
    return max(power, 1e-300), max(freedom, 1.0)

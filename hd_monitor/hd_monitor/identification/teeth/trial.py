"""How well the model with other tooth numbers explains the same motion: the judge of a suspicion."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import BoolArray, FloatArray
from ...errors import ParameterError
from ...model.parameters import Dynamics
from ...reducer import Reducer
from ..fit.gauss_newton import Fit, Problem
from ..fit.information import Information
from ..fit.linearisation import Predictor
from ..fit.multistart import signal_level
from ..fit.unknowns import Unknowns
from ..segment.segment import Segment, SegmentBuilder

LONGEST = 1.5
"""Motion [s] of the oldest and of the newest segment that a trial looks at: far apart, few samples tell orders."""

_ROUNDS = 4


class Lead(NamedTuple):
    """By how much tooth numbers explain the motion better than those given.

    Attributes
    ----------
    log_odds : float
        Logarithm of the likelihood ratio; -inf where the lines are too fast for the sampling rate.
    gain : float
        Variance that the given teeth leave over the one that these leave.
    """

    log_odds: float
    gain: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ToothTrial:
    """The circumstances under which tooth numbers are tried.

    Attributes
    ----------
    segments : sequence of Segment
        Recent motion as prepared for the fit with the given teeth; its oldest and its newest part are used.
    given : Dynamics
    unknowns : Unknowns
    active : ndarray of bool, shape (unknowns,)
        Unknowns that may move with the teeth given.
    prior : Information
    reference_torque : float
        [N·m]
    values : ndarray, shape (unknowns,)
        Best values with the teeth given.
    load_starts : sequence of complex
        Loads, in units of the reference torque at the second of their orders, from which other teeth start.
    inertial : bool
        Whether the sensor also feels gravity.
    """

    segments: Sequence[Segment]
    given: Dynamics
    unknowns: Unknowns
    active: BoolArray
    prior: Information
    reference_torque: float
    values: FloatArray
    load_starts: Sequence[complex]
    inertial: bool = False

    def leads(self, given: Reducer, others: Sequence[Reducer]) -> tuple[Lead, ...]:
        """Compare other reducers with the one given.

        The likelihood is that of white noise whose variance is at its own best, over the band that all fits look at.
        """
        # what given teeth need to make up for being wrong, another resonance say, would only lead others astray
        u = self.unknowns
        plain = self.active & ~u.mask(u.frequency, u.damping, u.delay)
        fits = [self._fit(reducer, plain, self._starts()) for reducer in others]
        # the same chance for the given ones: their best values so far may be those of a local minimum
        both = [self._fit(given, self.active, None), self._fit(given, plain, self._starts())]
        own = min((fit for fit in both if fit is not None), key=_level, default=None)
        known = [fit for fit in fits if fit is not None]
        if own is None or not known:
            return (Lead(-math.inf, 0.0),) * len(others)
        band = min(item.segment.highest_frequency for fit in (own, *known) for item in fit.segments)
        power, freedom = _power(own, band)
        leads = []
        for fit in fits:
            if fit is None:
                leads.append(Lead(-math.inf, 0.0))
                continue
            left, size = _power(fit, band)
            gain = (power / freedom) / (left / size)
            leads.append(Lead(0.5 * min(freedom, size) * math.log(gain), gain))
        return tuple(leads)

    def _starts(self) -> list[FloatArray]:
        u = self.unknowns
        starts = []
        for load in self.load_starts:
            start = u.zero()
            start[u.torque] = self.values[u.torque]
            start[u.load_line(2)] = load.real, load.imag
            starts.append(start)
        return starts

    def _fit(self, reducer: Reducer, active: BoolArray, starts: Sequence[FloatArray] | None) -> Fit | None:
        """Fit teeth from some starts, or from the best values known; None where that is not possible."""
        builder = SegmentBuilder(
            reducer=reducer,
            harmonics=self.unknowns.harmonics,
            load_orders=self.unknowns.load_orders,
            natural_frequency=self.given.natural_frequency,
            inertial=self.inertial,
            keep_tones=True,  # at one speed they may be these teeth's lines
        )
        try:
            segments = [builder.build([record], None) for record in self._records()]
        except ParameterError:
            return None  # these teeth's lines are too fast for the sampling rate
        problem = Problem(
            segments=segments,
            predictor=Predictor(unknowns=self.unknowns, given=self.given, reference_torque=self.reference_torque),
            prior=self.prior,
            floor=signal_level(segments),
            active=active,
        )
        try:
            if starts is None:
                return problem.solve(self.values, rounds=_ROUNDS)
            return problem.multistart(starts, rounds=_ROUNDS)[1]
        except (FloatingPointError, np.linalg.LinAlgError):
            return None

    def _records(self) -> list[Record]:
        """The oldest and the newest part of the motion."""
        oldest, newest = self.segments[0], self.segments[-1]
        if len(self.segments) == 1:
            return [_cut(newest, slice(0, round(2.0 * LONGEST / newest.period)))]
        return [
            _cut(oldest, slice(0, round(LONGEST / oldest.period))),
            _cut(newest, slice(-round(LONGEST / newest.period), None)),
        ]


def _cut(segment: Segment, part: slice) -> Record:
    """A part of a segment, as a record."""
    return Record(
        start=segment.start,
        period=segment.period,
        acceleration=np.where(segment.used, segment.acceleration, np.nan)[part],
        angle=segment.angle[part],
        speed=segment.speed[part],
        torque=segment.at_steps.torque[:: segment.substeps][part],
    )


def _level(fit: Fit) -> float:
    """Mean square that a fit leaves."""
    power, freedom = _power(fit, math.inf)
    return power / freedom


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

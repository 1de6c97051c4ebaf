"""Which tooth numbers fit: candidate pairs ranked by the evidence for their lines."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from ...limitation import Limitation, LimitationCode, blocker
from ...orders.line_orders import LineOrders
from ...orders.regression import CHANCE, LineFit
from ...reducer import Reducer
from .candidates import Candidate, ToothPair

MARGIN = math.log(1000.0)
"""Difference of log evidence, odds of 1000 to 1, by which the best pair must lead."""

CERTAIN = 1e-6
"""Probability of noise making a line as large, below which it counts where many pairs are looked at."""

FitLines = Callable[[LineOrders], LineFit | None]
"""Fits lines with their reference orders to one part of the data; None where it does not determine them."""


class Ambiguity(StrEnum):
    """Why a ranking is not conclusive."""

    NO_MOTION = "no_motion"
    NO_LINES = "no_lines"
    SECOND_PAIR = "second_pair"
    SINGLE_LINE = "single_line"
    ONE_SPEED = "one_speed"
    ENCODER = "encoder"


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothPairEvidence:
    """The evidence for one pair.

    Attributes
    ----------
    teeth : ToothPair
    log_evidence : float
        Logarithm of the likelihood ratio against noise alone, less a penalty for the number of lines (BIC), summed
        over the pairs of lines that count; -inf if the data do not determine any.
    chance : float
        Probability that noise alone makes the most significant line.
    lines_found : int
        How many lines of a pair stand out of the noise in at least one part of the data, at most.
    pairs_found : int
        Of how many pairs of lines at least one does.
    lines : tuple of float
        Orders [cycles per output revolution] of all that do.
    """

    teeth: ToothPair
    log_evidence: float
    chance: float
    lines_found: int
    pairs_found: int
    lines: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothPairRanking:
    """Candidate pairs by falling evidence.

    Attributes
    ----------
    ranked : tuple of ToothPairEvidence
    as_pair : float
        Log odds of the first pair's two lines against a single line: near 0 if only one stands out, or if the travel
        does not part them.
    travel : float
        Range of the output angle covered [rad].
    speed : float
        Output speed [rad/s] if there was only one; NaN if it varied.
    """

    ranked: tuple[ToothPairEvidence, ...]
    as_pair: float
    travel: float
    speed: float

    @property
    def margin(self) -> float:
        """Difference of the log evidence of the first two."""
        return self.ranked[0].log_evidence - self.ranked[1].log_evidence if len(self.ranked) > 1 else math.inf

    @property
    def ambiguity(self) -> Ambiguity | None:
        """Why the ranking is not conclusive; None if it is.

        It is if both of the first pair's lines stand out, as two and not one, and it leads by odds of at least 1000
        to 1, over motion at more than one speed, and it is not where an encoder's errors lie.
        """
        best = self.ranked[0]
        if not math.isfinite(best.log_evidence):
            return Ambiguity.NO_MOTION
        if not best.lines_found:
            return Ambiguity.NO_LINES
        if self.margin < MARGIN:
            return Ambiguity.SECOND_PAIR
        if best.lines_found < 2 or self.as_pair < MARGIN:
            return Ambiguity.SINGLE_LINE
        if math.isfinite(self.speed):
            return Ambiguity.ONE_SPEED
        return Ambiguity.ENCODER if best.teeth.is_beside_encoder else None

    @property
    def conclusive(self) -> bool:
        """Whether the first pair is the right one beyond reasonable doubt."""
        return self.ambiguity is None

    def lead(self, given: ToothPair) -> float:
        """Log evidence of the first pair less that of the one given, which must be among them."""
        own = self._log_evidence(given)
        return self.ranked[0].log_evidence - own if math.isfinite(own) else 0.0

    def contenders(self, given: ToothPair, margin: float) -> list[ToothPair]:
        """Return the others whose log evidence is at most `margin` below that of the one given."""
        least = self._log_evidence(given) - margin
        return [found.teeth for found in self.ranked if found.teeth != given and found.log_evidence >= least]

    def _log_evidence(self, teeth: ToothPair) -> float:
        return next(found.log_evidence for found in self.ranked if found.teeth == teeth)

    def contradiction(self, given: Reducer) -> Limitation:
        """Return why no part may be named with the teeth given, where the first pair is accepted instead."""
        best = self.ranked[0]
        return contradiction(given, best.teeth, best.lines if self.margin >= MARGIN else ())


def contradiction(given: Reducer, other: ToothPair, lines: Sequence[float] = ()) -> Limitation:
    """Return why no part may be named: other teeth fit, by `lines` of theirs, or some near these if there are none."""
    code = LimitationCode.TEETH_CONTRADICTED if lines else LimitationCode.TEETH_CONTRADICTED_VAGUELY
    return blocker(
        code,
        given=f"{given.flexspline_teeth}/{given.circular_spline_teeth}",
        other=f"{other.flexspline:g}/{other.circular_spline:g}",
        lines=", ".join(f"{line:g}" for line in lines),
    )


def rank(
    candidates: Sequence[Candidate], parts: Sequence[FitLines], *, travel: float = math.nan, speed: float = math.nan
) -> ToothPairRanking:
    """Rank candidates by the evidence for their lines, summed over parts of the data.

    Parameters
    ----------
    candidates : sequence of Candidate
    parts : sequence of callable
        Fit lines to parts of the data that do not add up coherently, directions of motion for example.
    travel : float
        Range of the output angle [rad].
    speed : float
        Output speed [rad/s] if there was only one; NaN if it varied.
    """
    found = {candidate.teeth: _evidence(candidate, parts) for candidate in candidates}
    ranked = sorted(found.values(), key=lambda evidence: (-evidence.log_evidence, evidence.teeth))
    best = ranked[0]
    return ToothPairRanking(
        ranked=tuple(ranked),
        as_pair=_odds_as_pair(LineOrders.of_pair(best.teeth.lines()), parts) if best.lines_found else 0.0,
        travel=travel,
        speed=speed,
    )


def _evidence(candidate: Candidate, parts: Sequence[FitLines]) -> ToothPairEvidence:
    """Sum the evidence for a candidate's lines over parts and multiples."""
    total, chances, found, determined = 0.0, {}, {}, {}
    for k in candidate.multiples:
        fits = _fits(LineOrders.of_pair(candidate.teeth.lines(k)), parts)
        if not fits:
            continue
        determined[k] = sum(fit.log_evidence for fit in fits)
        chance = np.minimum(np.min([fit.chances for fit in fits], axis=0) * 2 * len(fits), 1.0)
        chances[k] = float(chance.min())
        found[k] = [order for order, own in zip(candidate.teeth.lines(k), chance, strict=True) if own < CHANCE]
    if any(found.values()):
        further = [LineOrders.of_pair(candidate.teeth.lines(k)) for k in candidate.further]
        total = sum(fit.log_evidence for orders in further for fit in _fits(orders, parts))
    return ToothPairEvidence(
        teeth=candidate.teeth,
        log_evidence=total + sum(determined.values()) if determined else -math.inf,
        chance=min(chances.values(), default=1.0),
        lines_found=max(map(len, found.values()), default=0),
        pairs_found=sum(map(bool, found.values())),
        lines=tuple(order for lines in found.values() for order in lines),
    )


def _fits(orders: LineOrders, parts: Sequence[FitLines]) -> list[LineFit]:
    """Fit lines to every part that determines them."""
    return [fit for part in parts if (fit := part(orders)) is not None]


def _log_evidence(orders: LineOrders, parts: Sequence[FitLines]) -> float:
    return sum(fit.log_evidence for fit in _fits(orders, parts))


def _odds_as_pair(pair: LineOrders, parts: Sequence[FitLines]) -> float:
    """Logarithm of the odds for two lines against a single one, at either place or between: what travel must part."""
    lower, upper = pair.lines
    single = [replace(pair, lines=np.array([order])) for order in np.arange(lower, upper + 1.0)]
    return _log_evidence(pair, parts) - max(0.0, *(_log_evidence(orders, parts) for orders in single))


def shows_two_lines(candidate: Candidate, parts: Sequence[FitLines]) -> bool:
    """Whether both lines of a pair stand out with what is between and beside them fitted along: no tone makes two."""
    for k in candidate.multiples:
        lower, upper = candidate.teeth.lines(k)
        orders = LineOrders.of_pair(candidate.teeth.lines(k), motor=np.arange(lower - 2.0, upper + 3.0))
        if any(fit.chances.max() < CERTAIN for fit in _fits(orders, parts)):
            return True
    return False

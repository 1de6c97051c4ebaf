"""Which tooth numbers fit: candidate pairs ranked by the evidence for their lines."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

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
    """

    ranked: tuple[ToothPairEvidence, ...]

    @property
    def margin(self) -> float:
        """Difference of the log evidence of the first two."""
        return self.ranked[0].log_evidence - self.ranked[1].log_evidence if len(self.ranked) > 1 else math.inf

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
        other=str(other),
        lines=", ".join(f"{line:g}" for line in lines),
    )


def rank(candidates: Sequence[Candidate], parts: Sequence[FitLines]) -> ToothPairRanking:
    """Rank candidates by the evidence for their lines, summed over parts of the data.

    Parameters
    ----------
    candidates : sequence of Candidate
    parts : sequence of callable
        Fit lines to parts of the data that do not add up coherently, directions of motion for example.
    """
    evidence = [_evidence(candidate, parts) for candidate in candidates]
    return ToothPairRanking(ranked=tuple(sorted(evidence, key=lambda found: (-found.log_evidence, found.teeth))))


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
        total = sum(_log_evidence(LineOrders.of_pair(candidate.teeth.lines(k)), parts) for k in candidate.further)
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


def odds_as_pair(teeth: ToothPair, parts: Sequence[FitLines]) -> float:
    """Logarithm of the odds for two lines against a single one, at either place or between: what travel must part."""
    pair = LineOrders.of_pair(teeth.lines())
    single = [replace(pair, lines=np.array([order])) for order in np.arange(pair.lines[0], pair.lines[1] + 1.0)]
    return _log_evidence(pair, parts) - max(0.0, *(_log_evidence(orders, parts) for orders in single))


def shows_two_lines(candidate: Candidate, parts: Sequence[FitLines]) -> bool:
    """Whether both lines of a pair stand out with what is between and beside them fitted along: no tone makes two."""
    for k in candidate.multiples:
        lower, upper = candidate.teeth.lines(k)
        orders = LineOrders.of_pair(candidate.teeth.lines(k), motor=np.arange(lower - 2.0, upper + 3.0))
        if any(fit.chances.max() < CERTAIN for fit in _fits(orders, parts)):
            return True
    return False

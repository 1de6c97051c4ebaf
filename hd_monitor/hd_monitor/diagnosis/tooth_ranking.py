"""What a ranking of tooth pairs over whole recordings proves, in words for a technician."""

import math
from dataclasses import dataclass

from ..identification.teeth.candidates import ToothPair
from ..identification.teeth.ranking import MARGIN, ToothPairRanking


@dataclass(frozen=True, slots=True, kw_only=True)
class ConcludedRanking(ToothPairRanking):
    """Candidate pairs by falling evidence, and whether the first is the right one beyond reasonable doubt.

    Attributes
    ----------
    as_pair : float
        Log odds of the first pair's two lines against a single line: near 0 if only one stands out, or if the travel
        does not separate them.
    travel : float
        Range of the output angle covered [rad].
    speed : float
        Output speed [rad/s] if there was only one; NaN if it varied.
    """

    as_pair: float
    travel: float
    speed: float

    @property
    def conclusive(self) -> bool:
        """Whether the first pair is the right one beyond reasonable doubt."""
        return self._ambiguity() is None

    @property
    def statement(self) -> str:
        """The conclusion in one sentence."""
        if ambiguity := self._ambiguity():
            return ambiguity
        odds = (
            f"by odds of 10^{self.margin / math.log(10.0):.0f} to 1" if len(self.ranked) > 1 else "being the only one"
        )
        return f"{self.ranked[0].teeth} teeth fit best, {odds}; the mount does not show in the lines"

    def _ambiguity(self) -> str | None:
        """Why the ranking is not conclusive; None if two lines of a clear leader stand out, clear of other causes."""
        best, travel = self.ranked[0], f"{math.degrees(self.travel):.0f}° of travel"
        if not math.isfinite(best.log_evidence):
            return (
                "No motion in which lines could show: let the joint turn faster, or publish its states at a higher rate"
            )
        if not best.lines_found:
            return (
                f"No tooth pair's lines stand out of the noise, not even those of {best.teeth}, which fit best: "
                "record longer"
            )
        if self.margin < MARGIN:
            why = f"{self.ranked[1].teeth} nearly as well (odds {math.exp(self.margin):.0f} to 1 over {travel})"
        elif double := self._double():
            why = (
                f"the line at {best.lines[0]:g} is once per motor revolution of {double}, both of whose lines stand out"
            )
        elif lower := self._lower():
            why = f"their lines belong to the second group of {lower}, both of whose first lines stand out"
        elif listed := self._listed():
            why = f"catalogues list {listed} beside them, which with a tone in the other line's place look the same"
        elif best.lines_found < 2 or self.as_pair < MARGIN:
            why = f"a single line explains {travel} nearly as well, and may be something else's"
        elif math.isfinite(self.speed):
            why = (
                f"at one speed ({self.speed:.2g} rad/s) a fixed frequency of the machine looks the same: vary the speed"
            )
        elif best.teeth.is_beside_encoder:
            why = "an encoder's own errors come at these orders too"
        else:
            return None
        return f"{best.teeth} teeth fit best but {why}: not conclusive"

    def _lower(self) -> ToothPair | None:
        """Pair whose second group, its lines' doubles and sum, holds both lines of the leader; None if none does."""
        best = set(self.ranked[0].teeth)
        full = (found.teeth for found in self.ranked if found.lines_found == 2)
        return next((pair for pair in full if best <= {2.0 * pair[0], sum(pair), 2.0 * pair[1]}), None)

    def _listed(self) -> ToothPair | None:
        """Pair in catalogues that shares a line found with a leader that is in none; None if there is none."""
        best = self.ranked[0]
        if best.teeth.is_in_catalogue:
            return None
        listed = (found.teeth for found in self.ranked if found.teeth.is_in_catalogue)
        return next((pair for pair in listed if set(pair) & set(best.teeth) & set(best.lines)), None)

    def _double(self) -> ToothPair | None:
        """Pair of about twice the teeth whose motor explains the leader's only line; None if there is none."""
        best = self.ranked[0]
        if best.lines_found != 1:
            return None
        full = {found.teeth for found in self.ranked if found.lines_found == 2}
        return next((pair for pair in best.teeth.doubled() if pair in full and 2.0 * best.lines[0] in pair), None)

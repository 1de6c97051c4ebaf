"""Whether the directions of motion agree on a spline, and in words why not: the sensorless mode's rule of evidence."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from ...orders.pair import CHANCE, PairEstimate
from ...reducer import LinePair

AGREEMENT = 0.9
"""Confidence that each direction alone must have in the spline that is named."""


BETTER_TEETH = math.log(1e4)
"""Difference of log evidence, odds of 10 000 to 1, by which other teeth must lead; several are compared."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DirectionEvidence:
    """The first line pair in one direction of motion, or in one part of the time if there is one direction only.

    Attributes
    ----------
    name : str
        ``'forward'`` (rising position), ``'reverse'``, or these with ``'first half'`` and ``'second half'``.
    amplitude, std : LinePair
        Peak amplitudes in the signal's unit and their standard deviations.
    chance : LinePair
        Probability of noise alone making lines this large.
    dominance : LinePair
        Confidence that each spline's line is the larger one, by more than ``diagnosis.both_ratio`` allows.
    rival : float or None
        Order beside the pair with a significant line larger than both [cycles per output revolution], if there is one.
    segments, samples : int
        Segments and rows used.
    """

    name: str
    amplitude: LinePair
    std: LinePair
    chance: LinePair
    dominance: LinePair
    rival: float | None
    segments: int
    samples: int

    @classmethod
    def of(cls, name: str, estimate: PairEstimate, ratio: float, segments: int) -> "DirectionEvidence":
        """Sum up an estimate; `ratio` is ``diagnosis.both_ratio``."""
        return cls(
            name=name,
            amplitude=estimate.amplitude,
            std=estimate.std,
            chance=estimate.chance,
            dominance=estimate.dominance(ratio),
            rival=estimate.rival,
            segments=segments,
            samples=estimate.rows,
        )

    @property
    def found(self) -> bool:
        """Whether at least one of the two lines stands out of the noise."""
        return min(self.chance) < CHANCE

    @property
    def alike(self) -> bool:
        """Whether the two lines are surely about the same size: neither is the larger one."""
        return max(self.dominance) <= 1.0 - AGREEMENT

    def __str__(self) -> str:
        """Say what was found, in words."""
        cs, fs = (f"{size:.3g} ± {std:.1g}" for size, std in zip(self.amplitude, self.std, strict=True))
        return f"{self.name}: {cs} and {fs}"


def pooled_dominance(directions: Sequence[DirectionEvidence]) -> LinePair:
    """Confidence of all directions together that each spline dominates (Stouffer's sum of normal deviates)."""
    each = np.array([direction.dominance for direction in directions])
    deviates = norm.ppf(np.clip(each, 1e-12, 1.0 - 1e-12))
    return LinePair(*norm.cdf(deviates.sum(axis=0) / np.sqrt(len(directions))).tolist())


def other_teeth(lead: float, pair: LinePair, chances: Sequence[LinePair], given: LinePair) -> tuple[str, ...]:
    """Say that other tooth numbers fit better, if they do; only both of their lines are evidence, one fits two pairs.

    Parameters
    ----------
    lead : float
        Log evidence of the other teeth less that of those given, summed over the directions.
    pair : LinePair
        Orders of the other teeth's lines [cycles per output revolution].
    chances : sequence of LinePair
        Probability, by direction, of noise alone making each of them.
    given : LinePair
        Orders of the lines of the teeth given.
    """
    both = all(min(chance) < CHANCE for chance in zip(*chances, strict=True))
    if lead < BETTER_TEETH or not both:
        return ()
    other, own = (f"{lines.circular_spline:g}/{lines.flexspline:g}" for lines in (pair, given))
    return (
        f"Check the tooth numbers: lines stand at {pair.circular_spline:g} and {pair.flexspline:g} cycles per output "
        f"revolution, where {other} teeth have them but the {own} given do not both; correct "
        "reducer.flexspline_teeth and reducer.circular_spline_teeth, for with wrong ones no part can be named",
    )


def reasons_against_naming(
    directions: Sequence[DirectionEvidence], lines: LinePair, confidence: float
) -> tuple[str, ...]:
    """Reasons why no spline may be named on this evidence, for a technician; none if one, or both, may be.

    Parameters
    ----------
    directions : sequence of DirectionEvidence
    lines : LinePair
        Orders of the pair [cycles per output revolution].
    confidence : float
        ``diagnosis.confidence``, asked of all directions together; each one alone must have `AGREEMENT`.
    """
    pair = f"{lines.circular_spline:g} and {lines.flexspline:g} cycles per output revolution"
    if len(directions) < 2:
        return ("One stroke only so far: what it shows must come back in others, the other direction best of all",)
    reasons = []
    rivals = [direction.rival for direction in directions if direction.rival is not None]
    if len(rivals) == len(directions):
        reasons.append(
            f"The signal has a stronger line at about {rivals[0]:.0f} than at {pair}: "
            "check reducer.flexspline_teeth and reducer.circular_spline_teeth"
        )
    silent = [direction.name for direction in directions if not direction.found]
    if silent:
        reasons.append(
            f"No line at {pair} stands out of the noise ({'; '.join(silent)}): more motion lowers the noise floor"
        )
        return tuple(reasons)
    each = np.min([direction.dominance for direction in directions], axis=0)
    named = (each >= AGREEMENT) & (np.array(pooled_dominance(directions)) >= confidence)
    if not named.any() and not all(direction.alike for direction in directions):
        leaders = {direction.amplitude.circular_spline > direction.amplitude.flexspline for direction in directions}
        why = "are not told apart surely enough" if len(leaders) == 1 else "do not agree on the larger line"
        shown = "; ".join(str(direction) for direction in directions)
        who = "The lines" if len(leaders) == 1 else "The directions"
        reasons.append(f"{who} at {pair} {why} ({shown}): more motion in both directions may tell")
    return tuple(reasons)

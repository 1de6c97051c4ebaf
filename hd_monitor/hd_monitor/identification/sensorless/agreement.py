"""Whether the directions of motion agree on a spline: the sensorless mode's rule of evidence."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm
from scipy.stats import t as t_distribution

from ...limitation import Limitation, LimitationCode, blocker
from ...orders.pooling import GroupFit
from ...orders.regression import CHANCE, LineFit
from ...reducer import LinePair

AGREEMENT = 0.9
"""Confidence that each direction alone must have in the spline that is named."""


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
    def of(cls, group: GroupFit, ratio: float) -> "DirectionEvidence":
        """Sum up the fit of the pair to a group of segments; `ratio` is ``diagnosis.both_ratio``."""
        fit = group.fit
        return cls(
            name=group.name,
            amplitude=LinePair(*fit.amplitudes.tolist()),
            std=LinePair(*fit.amplitude_stds.tolist()),
            chance=LinePair(*fit.chances.tolist()),
            dominance=dominance(fit, ratio),
            rival=fit.rival,
            segments=len(group.segments),
            samples=fit.rows,
        )

    @property
    def found(self) -> bool:
        """Whether at least one of the two lines stands out of the noise."""
        return min(self.chance) < CHANCE

    @property
    def alike(self) -> bool:
        """Whether the two lines are surely about the same size: neither is the larger one."""
        return max(self.dominance) <= 1.0 - AGREEMENT


def dominance(fit: LineFit, ratio: float) -> LinePair:
    """Confidence, one-sided, that each line of a pair is larger than the other one divided by `ratio`."""
    covariance = fit.amplitude_covariance
    confidence = []
    for weights in ((ratio, -1.0), (-1.0, ratio)):
        w = np.array(weights)
        deviation = math.sqrt(max(float(w @ covariance @ w), 1e-300))
        confidence.append(float(t_distribution.cdf(float(w @ fit.amplitudes) / deviation, fit.freedom)))
    return LinePair(*confidence)


def pooled_dominance(directions: Sequence[DirectionEvidence]) -> LinePair:
    """Confidence of all directions together that each spline dominates (Stouffer's sum of normal deviates)."""
    each = np.array([direction.dominance for direction in directions])
    deviates = norm.ppf(np.clip(each, 1e-12, 1.0 - 1e-12))
    return LinePair(*norm.cdf(deviates.sum(axis=0) / np.sqrt(len(directions))).tolist())


def disagreements(
    directions: Sequence[DirectionEvidence], lines: LinePair, confidence: float
) -> tuple[Limitation, ...]:
    """Reasons why no spline may be named on this evidence; none if one, or both, may be.

    Parameters
    ----------
    directions : sequence of DirectionEvidence
        At most two.
    lines : LinePair
        Orders of the pair [cycles per output revolution].
    confidence : float
        ``diagnosis.confidence``, which all directions together must have; each one alone must have `AGREEMENT`.
    """
    if len(directions) < 2:
        return (blocker(LimitationCode.ONE_STROKE),)
    pair = {"order": lines.circular_spline, "next_order": lines.flexspline}
    reasons = []
    rivals = [direction.rival for direction in directions if direction.rival is not None]
    if len(rivals) == len(directions):
        reasons.append(blocker(LimitationCode.STRONGER_LINE_BESIDE, order_beside=rivals[0], **pair))
    silent = [direction.name for direction in directions if not direction.found]
    if silent:
        return (*reasons, blocker(LimitationCode.NO_LINE_FOUND, directions="; ".join(silent), **pair))
    each = np.min([direction.dominance for direction in directions], axis=0)
    named = (each >= AGREEMENT) & (np.array(pooled_dominance(directions)) >= confidence)
    if not named.any() and not all(direction.alike for direction in directions):
        leaders = {direction.amplitude.circular_spline > direction.amplitude.flexspline for direction in directions}
        code = LimitationCode.LINES_TOO_SIMILAR if len(leaders) == 1 else LimitationCode.DIRECTIONS_DISAGREE
        shown = _amplitudes("first", directions[0]) | _amplitudes("second", directions[1])
        reasons.append(blocker(code, **pair, **shown))
    return tuple(reasons)


def _amplitudes(place: str, direction: DirectionEvidence) -> dict[str, float | str]:
    """A direction's amplitudes and their standard deviations, in the signal's unit, as values of a limitation."""
    values: dict[str, float | str] = {place: direction.name}
    for line, size, std in zip(("line", "next_line"), direction.amplitude, direction.std, strict=True):
        values |= {f"{place}_{line}": size, f"{place}_{line}_std": std}
    return values

"""Whether directions of motion and recordings agree on a spline: the sensorless mode's rule of evidence."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from ...limitation import Limitation, LimitationCode, blocker
from ...orders.pooling import GroupFit
from ...orders.regression import CHANCE, LineFit
from ...reducer import LinePair
from ...settings.groups import DiagnosisSettings

SURE = 0.9
"""Confidence from which a direction is sure that neither line is the larger one, or a recording contradicts others."""

_NO_PHASE = LinePair(0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class DirectionEvidence:
    """A line pair in one direction of motion of one recording, or in part of its time if there is one direction only.

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
    k : int
        Number of the pair.
    phase : LinePair
        Phases of the lines at the joint's zero [rad].
    correlation : float
        Of the errors of the two amplitudes.
    noise : float
        Standard deviation of what the fit leaves of a sample, in the signal's unit.
    floor : float
        Noise power beside the lines over that of white noise.
    travel : float
        Range of the output angle [rad].
    speed : float
        Mean output speed [rad/s].
    seconds : float
        Motion used [s].
    """

    name: str
    amplitude: LinePair
    std: LinePair
    chance: LinePair
    dominance: LinePair
    rival: float | None
    segments: int
    samples: int
    k: int = 1
    phase: LinePair = _NO_PHASE
    correlation: float = 0.0
    noise: float = math.nan
    floor: float = math.nan
    travel: float = 0.0
    speed: float = math.nan
    seconds: float = 0.0

    @classmethod
    def of(cls, group: GroupFit, ratio: float, k: int = 1) -> "DirectionEvidence":
        """Sum up the fit of the k-th pair to a group of segments; `ratio` is ``diagnosis.both_ratio``."""
        fit, segments = group.fit, group.segments
        covariance = fit.amplitude_covariance
        angle = np.concatenate([segment.angle for segment in segments])
        return cls(
            name=group.name,
            amplitude=LinePair(*fit.amplitudes.tolist()),
            std=LinePair(*fit.amplitude_stds.tolist()),
            chance=LinePair(*fit.chances.tolist()),
            dominance=dominance(fit, ratio),
            rival=fit.rival,
            segments=len(segments),
            samples=fit.rows,
            k=k,
            phase=LinePair(*np.angle(fit.phasors).tolist()),
            correlation=float(covariance[0, 1] / math.sqrt(covariance[0, 0] * covariance[1, 1])),
            noise=fit.noise,
            floor=fit.floor,
            travel=float(np.ptp(angle)),
            speed=float(np.concatenate([segment.speed for segment in segments]).mean()),
            seconds=sum(segment.duration for segment in segments),
        )

    @property
    def found(self) -> bool:
        """Whether at least one of the two lines stands out of the noise."""
        return min(self.chance) < CHANCE

    @property
    def alike(self) -> bool:
        """Whether the two lines are surely about the same size: neither is the larger one."""
        return max(self.dominance) <= 1.0 - SURE

    @property
    def leader(self) -> str:
        """Spline whose line is the larger one."""
        return "circular_spline" if self.amplitude.circular_spline > self.amplitude.flexspline else "flexspline"

    @property
    def covariance(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Covariance of the two amplitudes, the circular spline's first."""
        cross = self.correlation * self.std[0] * self.std[1]
        return (self.std[0] ** 2, cross), (cross, self.std[1] ** 2)


def dominance(fit: LineFit, ratio: float) -> LinePair:
    """Confidence, one-sided, that each line of a pair is larger than the other one divided by `ratio`."""
    covariance = fit.amplitude_covariance
    confidence = []
    for weights in ((ratio, -1.0), (-1.0, ratio)):
        w = np.array(weights)
        deviation = math.sqrt(max(float(w @ covariance @ w), 1e-300))
        confidence.append(float(scipy.stats.t.cdf(float(w @ fit.amplitudes) / deviation, fit.freedom)))
    return LinePair(*confidence)


def pooled_dominance(evidence: Sequence[DirectionEvidence]) -> LinePair:
    """Confidence of all together that each spline dominates (Stouffer's sum of normal deviates)."""
    each = np.array([direction.dominance for direction in evidence])
    deviates = scipy.stats.norm.ppf(np.clip(each, 1e-12, 1.0 - 1e-12))
    return LinePair(*scipy.stats.norm.cdf(deviates.sum(axis=0) / np.sqrt(len(evidence))).tolist())


def pooled_chance(evidence: Sequence[DirectionEvidence]) -> LinePair:
    """Probability of noise alone making lines as large as in all together (Fisher's method)."""
    each = np.clip([direction.chance for direction in evidence], 1e-300, 1.0)
    return LinePair(*scipy.stats.chi2.sf(-2.0 * np.log(each).sum(axis=0), 2 * len(evidence)).tolist())


def pooled(evidence: Sequence[DirectionEvidence]) -> DirectionEvidence:
    """Sum up one direction over recordings.

    Amplitudes are averaged by their precision. Where recordings differ by more than their noise, as pose, load and
    temperature make them, the standard deviations are widened by that.
    """
    if len(evidence) == 1:
        return evidence[0]
    amplitude = np.array([direction.amplitude for direction in evidence])
    variance = np.array([direction.std for direction in evidence]) ** 2
    weights = 1.0 / variance.sum(axis=1)
    weights /= weights.sum()
    mean = weights @ amplitude
    excess = ((amplitude - mean) ** 2 / variance).sum(axis=0) / (len(evidence) - 1)
    std = np.sqrt(weights**2 @ variance * np.maximum(excess, 1.0))
    rivals = Counter(direction.rival for direction in evidence if direction.rival is not None)
    usual, count = rivals.most_common(1)[0] if rivals else (None, 0)
    return replace(
        max(evidence, key=lambda direction: direction.samples),
        amplitude=LinePair(*mean.tolist()),
        std=LinePair(*std.tolist()),
        chance=pooled_chance(evidence),
        dominance=pooled_dominance(evidence),
        rival=usual if 2 * count > len(evidence) else None,
        segments=sum(direction.segments for direction in evidence),
        samples=sum(direction.samples for direction in evidence),
        seconds=sum(direction.seconds for direction in evidence),
        travel=max(direction.travel for direction in evidence),
    )


def by_direction(evidence: Sequence[DirectionEvidence]) -> tuple[DirectionEvidence, ...]:
    """Sum up the recordings of each direction; parts of the time count as directions where none has both."""
    names = {direction.name for direction in evidence}
    kept = names & {"forward", "reverse"} or names
    return tuple(pooled([d for d in evidence if d.name == name]) for name in sorted(kept))


def disagreements(
    evidence: Sequence[DirectionEvidence], lines: LinePair, limits: DiagnosisSettings
) -> tuple[Limitation, ...]:
    """Reasons why no spline may be named on this evidence; none if one, or both, may be.

    Parameters
    ----------
    evidence : sequence of DirectionEvidence
        Of one pair, from any number of recordings.
    lines : LinePair
        Orders of the pair [cycles per output revolution].
    limits : DiagnosisSettings
        With the confidence that all together must have, and the ratio from which both splines are named.

    Notes
    -----
    Evidence adds up: a direction or a recording with a strong line carries a weak one that agrees. Directions whose
    larger lines are different splines' forbid a name, and so does a recording that is sure of the other spline.
    """
    directions = by_direction(evidence)
    if len(directions) < 2:
        return (blocker(LimitationCode.ONE_STROKE),)
    pair = {"order": lines.circular_spline, "next_order": lines.flexspline}
    reasons = []
    rivals = [direction.rival for direction in directions if direction.rival is not None]
    if len(rivals) == len(directions):
        reasons.append(blocker(LimitationCode.STRONGER_LINE_BESIDE, order_beside=rivals[0], **pair))
    if 2.0 * min(pooled_chance(directions)) >= CHANCE:
        silent = "; ".join(direction.name for direction in directions if not direction.found)
        return (*reasons, blocker(LimitationCode.NO_LINE_FOUND, directions=silent, **pair))
    if all(direction.alike for direction in directions):
        return tuple(reasons)
    shown = _amplitudes("first", directions[0]) | _amplitudes("second", directions[1])
    if len({direction.leader for direction in directions}) > 1:
        reasons.append(blocker(LimitationCode.DIRECTIONS_DISAGREE, **pair, **shown))
    elif (other := _contradiction(evidence, directions[0].leader)) is not None:
        own = max(evidence, key=lambda piece: getattr(piece.dominance, directions[0].leader))
        opposed = _amplitudes("first", own) | _amplitudes("second", other)
        reasons.append(blocker(LimitationCode.RECORDINGS_DISAGREE, **pair, **opposed))
    elif not _clear(directions, limits):
        reasons.append(blocker(LimitationCode.LINES_TOO_SIMILAR, **pair, **shown))
    return tuple(reasons)


def _clear(directions: Sequence[DirectionEvidence], limits: DiagnosisSettings) -> bool:
    """Whether all directions together are sure of the larger line, and show it larger than `both_ratio` allows."""
    low, high = sorted(np.square([direction.amplitude for direction in directions]).sum(axis=0).tolist())
    return max(pooled_dominance(directions)) >= limits.confidence and low < limits.both_ratio**2 * high


def _contradiction(evidence: Sequence[DirectionEvidence], leader: str) -> DirectionEvidence | None:
    """Piece of evidence that is sure of the other spline, beyond what so many would show by chance."""
    other = "flexspline" if leader == "circular_spline" else "circular_spline"
    surest = max(evidence, key=lambda piece: getattr(piece.dominance, other))
    return surest if getattr(surest.dominance, other) >= 1.0 - (1.0 - SURE) / len(evidence) else None


def _amplitudes(place: str, direction: DirectionEvidence) -> dict[str, float | str]:
    """A direction's amplitudes and their standard deviations, in the signal's unit, as values of a limitation."""
    values: dict[str, float | str] = {place: direction.name}
    for line, size, std in zip(("line", "next_line"), direction.amplitude, direction.std, strict=True):
        values |= {f"{place}_{line}": size, f"{place}_{line}_std": std}
    return values

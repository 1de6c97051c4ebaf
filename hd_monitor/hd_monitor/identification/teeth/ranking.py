"""Which tooth numbers fit a recording: candidate pairs ranked by the evidence for their lines."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...acquisition.record import JointSamples, Record
from ...errors import ParameterError
from ...orders.joint_segment import JointSegment, JointSegmentCutter, one_speed, samples_of_records
from ...orders.line_orders import LineOrders
from ...orders.regression import CHANCE, Products, solve
from ...orders.scan import OrderScan
from ...reducer import WAVE_GENERATOR_LOBES, LinePair

TOOTH_RANGE = (60, 320)
"""Flexspline teeth looked at: reductions 30 to 160, as catalogues have them."""

MARGIN = math.log(1000.0)
"""Difference of log evidence, odds of 1000 to 1, by which the best pair must lead."""

ENCODER_ORDERS = (64, 128, 256, 512)
"""Periods per revolution of common encoders, whose interpolation errors show as lines, with sidebands beside."""


class ToothPair(NamedTuple):
    """Teeth of the flexspline, z1, and of the circular spline, z2."""

    flexspline: int
    circular_spline: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothPairEvidence:
    """What speaks for one pair.

    Attributes
    ----------
    teeth : ToothPair
    log_evidence : float
        Logarithm of the likelihood ratio against noise alone, less a penalty for the number of lines (BIC); the lines
        at multiples of the pair and at the motor's orders that follow from it count in.
    chance : float
        Probability that noise alone makes the more significant one of the pair's two first lines.
    lines_found : int
        How many of the two first lines stand out of the noise in at least one direction.
    """

    teeth: ToothPair
    log_evidence: float
    chance: float
    lines_found: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothPairRanking:
    """Candidate pairs by falling evidence.

    Attributes
    ----------
    ranked : tuple of ToothPairEvidence
    margin : float
        Difference of the log evidence of the first two.
    as_pair : float
        Log odds of the first pair's two lines against a single line: near 0 if only one stands out, or if the travel
        does not part them.
    conclusive : bool
        True if both of the first pair's lines stand out, as two and not one, and it leads by odds of at least 1000 to
        1, over motion at more than one speed, and it is not where an encoder's errors lie.
    statement : str
        One sentence for a technician.
    travel : float
        Range of the output angle covered [rad].
    """

    ranked: tuple[ToothPairEvidence, ...]
    margin: float
    as_pair: float
    conclusive: bool
    statement: str
    travel: float


def rank_tooth_pairs(
    data: JointSamples | Iterable[Record],
    *,
    source: str = "joint_effort",
    candidates: Iterable[tuple[int, int]] | None = None,
    minimum_speed: float = 0.03,
) -> ToothPairRanking:
    """Rank candidate tooth pairs by the evidence for their lines in a recording.

    Parameters
    ----------
    data : JointSamples or iterable of Record
        Joint states, or accelerations with the joint's angle.
    source : str
        For joint states: ``'joint_effort'`` or ``'joint_velocity'``, the field that is the vibration signal.
    candidates : iterable of (int, int), optional
        Flexspline and circular-spline teeth; by default every pair of `TOOTH_RANGE` with two teeth of difference.
    minimum_speed : float
        Output speed [rad/s] below which the joint counts as standing.

    Returns
    -------
    ToothPairRanking

    Raises
    ------
    ParameterError
        If there are no candidates, or one of them does not differ by two teeth.

    Notes
    -----
    The orders per output revolution are the tooth numbers themselves in both mounts, so the ranking cannot tell the
    mount. Pairs that share a line, as 198/200 and 200/202 do, are told apart only if both lines stand out.
    """
    pairs = [ToothPair(*pair) for pair in candidates] if candidates is not None else default_candidates()
    if not pairs:
        raise ParameterError("there is no candidate tooth pair to look for; leave `candidates` out for all of them")
    for pair in pairs:
        if pair.circular_spline - pair.flexspline != WAVE_GENERATOR_LOBES:
            raise ParameterError(f"{pair.flexspline}/{pair.circular_spline} teeth do not differ by 2: not looked for")
    wanted = {order for pair in pairs for order in _surroundings(pair)}
    orders = np.arange(max(min(wanted), 2), max(wanted) + 1)
    if isinstance(data, JointSamples):
        samples = data
    else:
        samples, source = samples_of_records(data), "joint_effort"
    span = float(min(pair.flexspline for pair in pairs)), float(max(pair.circular_spline for pair in pairs))
    cutter = JointSegmentCutter(source, span, minimum_speed)
    segments = cutter.add(samples) + cutter.finish()
    scan = OrderScan(segments, orders)
    rankings = [_rank(pairs, scan, scan.by_direction(), segments)]
    if not rankings[0].conclusive and any(found.lines_found for found in rankings[0].ranked):
        # Amplitudes and phases that change with the speed, as near a resonance, do not add up over segments.
        parts = scan.by_parts()
        rankings += [_rank(pairs, scan, parts, segments)] if parts else []
    return max(rankings, key=lambda ranking: (ranking.conclusive, ranking.ranked[0].log_evidence))


def _rank(
    pairs: Sequence[ToothPair], scan: OrderScan, parts: Sequence[Products], segments: Sequence[JointSegment]
) -> ToothPairRanking:
    """Rank with the segments pooled in these parts."""
    ranked = sorted(
        (_evidence(pair, scan, parts) for pair in pairs), key=lambda found: (-found.log_evidence, found.teeth)
    )
    travel = float(np.ptp(np.concatenate([segment.angle for segment in segments]))) if segments else 0.0
    margin = ranked[0].log_evidence - ranked[1].log_evidence if len(ranked) > 1 else math.inf
    best = ranked[0]
    speed = one_speed(segments)
    as_pair = _odds_as_pair(best.teeth, scan, parts) if best.lines_found else 0.0
    clear = best.lines_found == 2 and min(margin, as_pair) >= MARGIN
    return ToothPairRanking(
        ranked=tuple(ranked),
        margin=margin,
        as_pair=as_pair,
        conclusive=clear and not math.isfinite(speed) and not _beside_encoder(best.teeth),
        statement=_statement(ranked, margin, as_pair, travel, speed),
        travel=travel,
    )


def default_candidates() -> list[ToothPair]:
    """Every pair with two teeth of difference whose reduction catalogues have."""
    return [ToothPair(teeth, teeth + 2) for teeth in range(TOOTH_RANGE[0], TOOTH_RANGE[1] + 1)]


def _lines(pair: ToothPair, k: float) -> LinePair:
    """Orders [cycles per output revolution] of the k-th pair of lines; k = 1/2 are the motor's, in either mount."""
    return LinePair(k * pair.flexspline, k * pair.circular_spline)


def _surroundings(pair: ToothPair) -> tuple[int, int]:
    """Lowest and highest order that the fit of a pair looks at."""
    lowest = LineOrders.of_pair(_lines(pair, 0.5)).reference_orders.min()
    return math.floor(lowest), math.ceil(LineOrders.of_pair(_lines(pair, 1.0)).reference_orders.max())


def _evidence(pair: ToothPair, scan: OrderScan, parts: Sequence[Products]) -> ToothPairEvidence:
    """Sum the evidence for a pair's lines over parts and, once it shows itself, over its multiples in the range."""
    fits = [fit for part in parts if (fit := solve(part, _around(_lines(pair, 1.0)))) is not None]
    if not fits:
        return ToothPairEvidence(teeth=pair, log_evidence=-math.inf, chance=1.0, lines_found=0)
    chances = np.minimum(np.min([fit.chances for fit in fits], axis=0) * 2 * len(fits), 1.0)
    found = int(np.count_nonzero(chances < CHANCE))
    total = sum(fit.log_evidence for fit in fits)
    multiples = [0.5, *range(2, scan.highest // pair.circular_spline + 1)] if found else []
    for k in multiples:
        more = (solve(part, _around(_lines(pair, k))) for part in parts)
        total += sum(fit.log_evidence for fit in more if fit is not None)
    return ToothPairEvidence(teeth=pair, log_evidence=total, chance=float(chances.min()), lines_found=found)


def _odds_as_pair(pair: ToothPair, scan: OrderScan, parts: Sequence[Products]) -> float:
    """Logarithm of the odds for two lines against a single one, at either place or between: what travel must part."""
    single = np.zeros(len(_between(pair)))
    both = 0.0
    for part in parts:
        fit = solve(part, _around(_lines(pair, 1.0)))
        both += fit.log_evidence if fit is not None else 0.0
        for number, order in enumerate(_between(pair)):
            alone = solve(part, _around(_lines(pair, 1.0), only=order))
            single[number] += alone.log_evidence if alone is not None else 0.0
    return both - max(float(single.max()), 0.0)


def _between(pair: ToothPair) -> range:
    """Orders of single lines that a pair could be mistaken for."""
    return range(pair.flexspline, pair.circular_spline + 1)


def _around(lines: LinePair, only: float | None = None) -> LineOrders:
    """The pair with its reference orders, or a single line in its place."""
    orders = LineOrders.of_pair(lines)
    return orders if only is None else replace(orders, lines=np.array([float(only)]))


def _beside_encoder(pair: ToothPair) -> bool:
    """Whether a pair's lines lie where an encoder's own errors would."""
    return any(pair.flexspline - 1 <= order <= pair.circular_spline + 1 for order in ENCODER_ORDERS)


def _statement(ranked: Sequence[ToothPairEvidence], margin: float, as_pair: float, travel: float, speed: float) -> str:
    """Say what the ranking is worth."""
    best = ranked[0]
    name = f"{best.teeth.flexspline}/{best.teeth.circular_spline}"
    if not math.isfinite(best.log_evidence):
        return "No motion in which lines could show: let the joint turn faster, or publish its states at a higher rate"
    if not best.lines_found:
        return f"No tooth pair's lines stand out of the noise, not even those of {name}, which fit best: record longer"
    if margin < MARGIN:
        second = f"{ranked[1].teeth.flexspline}/{ranked[1].teeth.circular_spline}"
        why = f"{second} nearly as well (odds {math.exp(margin):.0f} to 1 over {math.degrees(travel):.0f}° of travel)"
    elif best.lines_found < 2 or as_pair < MARGIN:
        why = (
            f"a single line explains {math.degrees(travel):.0f}° of travel nearly as well, and may be something else's"
        )
    elif math.isfinite(speed):
        why = f"at one speed ({speed:.2g} rad/s) a fixed frequency of the machine looks the same: vary the speed"
    elif _beside_encoder(best.teeth):
        why = "an encoder's own errors come at these orders too"
    else:
        rest = f"by odds of 10^{margin / math.log(10.0):.0f} to 1" if math.isfinite(margin) else "being the only one"
        return f"{name} teeth fit best, {rest}; the mount does not show in the lines"
    return f"{name} teeth fit best but {why}: not conclusive"

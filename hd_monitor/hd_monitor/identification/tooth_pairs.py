"""Which tooth numbers fit a recording: candidate pairs ranked by the evidence for their lines."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..acquisition.record import JointSamples, Record
from ..errors import ParameterError
from ..reducer import WAVE_GENERATOR_LOBES, LinePair
from .pair_evidence import CHANCE, LineSolution, line_chances, solve_lines
from .stroke_sums import Gram, PairOrders, project, trend_columns
from .strokes import HIGHEST_SHARE, LOWEST_FREQUENCY, Stroke, StrokeCutter, one_speed, samples_of_records
from .whitening import learn_whitening, settled, whiten

FloatArray = npt.NDArray[np.float64]
Orders = npt.NDArray[np.int64]

TOOTH_RANGE = (60, 320)
"""Flexspline teeth looked at: reductions 30 to 160, as catalogues have them."""

MARGIN = math.log(1000.0)
"""Difference of log evidence, odds of 1000 to 1, by which the best pair must lead."""

ENCODER_ORDERS = (64, 128, 256, 512)
"""Periods per revolution of common encoders, whose interpolation errors show as lines, with sidebands beside."""

CLIP = 4.0
"""Robust standard deviations at which the whitened signal is clipped before any line is known."""

TREND_ORDER = 10.0
"""Knots of the trend per output revolution: no candidate's line is anywhere near."""


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
    as_pair : float
        Logarithm of the odds for two lines against a single one at either place or between: what travel must part.
    chance : float
        Probability that noise alone makes the more significant one of the pair's two first lines.
    lines_found : int
        How many of the two first lines stand out of the noise in at least one direction.
    """

    teeth: ToothPair
    log_evidence: float
    as_pair: float
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
    conclusive : bool
        True if the first pair's lines stand out, as two and not one, and it leads by odds of at least 1000 to 1, over
        motion at more than one speed, and it is not where an encoder's errors lie.
    statement : str
        One sentence for a technician.
    travel : float
        Range of the output angle covered [rad].
    """

    ranked: tuple[ToothPairEvidence, ...]
    margin: float
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
    cutter = StrokeCutter(source, span, minimum_speed)
    strokes = cutter.add(samples) + cutter.finish()
    scans = _scan(strokes, orders.astype(np.float64))
    ranked = sorted(
        (_evidence(pair, scans, orders) for pair in pairs), key=lambda found: (-found.log_evidence, found.teeth)
    )
    travel = float(np.ptp(np.concatenate([stroke.angle for stroke in strokes]))) if strokes else 0.0
    margin = ranked[0].log_evidence - ranked[1].log_evidence if len(ranked) > 1 else math.inf
    best = ranked[0]
    speed = one_speed(strokes)
    clear = best.lines_found > 0 and min(margin, best.as_pair) >= MARGIN
    conclusive = clear and not math.isfinite(speed) and not _beside_encoder(best.teeth)
    return ToothPairRanking(
        ranked=tuple(ranked),
        margin=margin,
        conclusive=conclusive,
        statement=_statement(ranked, margin, travel, speed),
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
    lowest = PairOrders.around(_lines(pair, 0.5)).placebos.min()
    return math.floor(lowest), math.ceil(PairOrders.around(_lines(pair, 1.0)).placebos.max())


def _scan(strokes: Sequence[Stroke], orders: FloatArray) -> list[Gram]:
    """Sums over the strokes, for each direction, with every order of a range as a line and then the signal."""
    trend = [trend_columns(stroke, TREND_ORDER) for stroke in strokes]
    flat = [project(own, stroke.values[:, None])[:, 0] for own, stroke in zip(trend, strokes, strict=True)]
    coefficients = learn_whitening(flat)
    scans = []
    for direction in (1, -1):
        total, rows, weight = np.zeros((2 * orders.size + 1, 2 * orders.size + 1)), 0, 0.0
        for own, stroke in zip(trend, strokes, strict=True):
            good = settled(stroke.starts, coefficients)
            count = int(np.count_nonzero(good))
            if stroke.direction != direction or count < 4 * own.shape[1]:
                continue
            frequency = np.multiply.outer(stroke.speed, orders) / math.tau
            band = (frequency >= LOWEST_FREQUENCY) & (frequency <= HIGHEST_SHARE * stroke.rate)
            columns = np.column_stack([stroke.columns(orders) * np.tile(band, 2), stroke.values - stroke.values.mean()])
            columns = project(whiten(coefficients, own)[good], whiten(coefficients, columns)[good])
            limit = CLIP * float(np.median(np.abs(columns[:, -1]))) / 0.6745
            columns[:, -1] = np.clip(columns[:, -1], -limit, limit)
            power = float(columns[:, -1] @ columns[:, -1]) / count
            if power > 0.0:
                total += columns.T @ columns / power
                rows, weight = rows + count, weight + count / power
        if rows:
            scans.append(Gram(products=total, rows=rows, noise=math.sqrt(rows / weight)))
    return scans


def _evidence(pair: ToothPair, scans: Sequence[Gram], scanned: Orders) -> ToothPairEvidence:
    """Sum the evidence for a pair's lines over directions and multiples, as far as the scan goes."""
    chances, own, others = [], 0.0, 0.0
    single = np.zeros(len(_between(pair)))
    for scan in scans:
        first = _solve(_around(_lines(pair, 1.0)), scan, scanned)
        if first is None:
            continue
        chances.append(line_chances(first))
        own += first.log_evidence
        for number, order in enumerate(_between(pair)):
            alone = _solve(_around(_lines(pair, 1.0), only=order), scan, scanned)
            single[number] += alone.log_evidence if alone is not None else 0.0
        k = 0.5
        while k * pair.circular_spline <= scanned[-1]:
            more = _solve(_around(_lines(pair, k)), scan, scanned) if k != 1.0 else None
            others += more.log_evidence if more is not None else 0.0
            k = 1.0 if k < 1.0 else k + 1.0
    if not chances:
        return ToothPairEvidence(teeth=pair, log_evidence=-math.inf, as_pair=-math.inf, chance=1.0, lines_found=0)
    corrected = np.minimum(np.min(chances, axis=0) * 2 * len(chances), 1.0)
    found = int(np.count_nonzero(corrected < CHANCE))
    return ToothPairEvidence(
        teeth=pair,
        log_evidence=own + (others if found else 0.0),
        as_pair=own - max(float(single.max()), 0.0),
        chance=float(corrected.min()),
        lines_found=found,
    )


def _between(pair: ToothPair) -> range:
    """Orders of single lines that a pair could be mistaken for."""
    return range(pair.flexspline, pair.circular_spline + 1)


def _around(lines: LinePair, only: float | None = None) -> PairOrders:
    """The pair with its placebo orders, or a single line in its place."""
    orders = PairOrders.around(lines)
    return orders if only is None else replace(orders, lines=np.array([float(only)]))


def _solve(orders: PairOrders, scan: Gram, scanned: Orders) -> LineSolution | None:
    """Fit lines with their placebo orders out of a scan; None where it does not hold or determine them."""
    placebos = orders.placebos[(orders.placebos >= scanned[0]) & (orders.placebos <= scanned[-1])]
    wanted = np.concatenate([orders.lines, placebos])
    if orders.lines.min() < scanned[0] or orders.lines.max() > scanned[-1] or (wanted != np.rint(wanted)).any():
        return None
    place = np.rint(wanted).astype(np.int64) - scanned[0]
    lines, floor = place[: orders.lines.size], place[orders.lines.size :]
    index = np.concatenate([lines, lines + scanned.size, floor, floor + scanned.size, [2 * scanned.size]])
    return solve_lines(scan.products[np.ix_(index, index)], replace(orders, placebos=placebos))


def _beside_encoder(pair: ToothPair) -> bool:
    """Whether a pair's lines lie where an encoder's own errors would."""
    return any(pair.flexspline - 1 <= order <= pair.circular_spline + 1 for order in ENCODER_ORDERS)


def _statement(ranked: Sequence[ToothPairEvidence], margin: float, travel: float, speed: float) -> str:
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
    elif best.as_pair < MARGIN:
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

"""How much of a line follows the torque: a varying stiffness makes all of it do so, a transmission error none."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from ...arrays import BoolArray, FloatArray, IntArray
from ...orders.joint_segment import JointSegment
from ...orders.line_orders import LineOrders
from ...orders.pooling import GroupFit
from ...orders.regression import Products, pool, solve_normal
from ...orders.segment_products import products_of_columns, trend_columns
from ...orders.whitening import settled, whiten
from ...reducer import LinePair

CONFIDENCE = 0.95
"""Probability with which an interval holds the true share."""

_MIXTURES = np.linspace(0.0, 0.5 * math.pi, 91)
"""Angles whose squared sine is the share."""

_PHASES = np.linspace(0.0, math.tau, 48, endpoint=False)
"""Between the two parts of a line [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueShare:
    """Part of a line's power that follows the transmitted torque, and its 95 % interval.

    Attributes
    ----------
    spline : str
        ``'circular_spline'`` or ``'flexspline'``, whose first line it is.
    share, low, high : float
    """

    spline: str
    share: float
    low: float
    high: float

    @property
    def reading(self) -> str:
        """Which of the two dominates: ``'stiffness'``, ``'transmission_error'``, or ``'either'``."""
        if self.low > 0.5:
            return "stiffness"
        return "transmission_error" if self.high < 0.5 else "either"


def torque_shares(groups: Sequence[GroupFit], orders: LineOrders, coefficients: FloatArray) -> tuple[TorqueShare, ...]:
    """Fit each line of a pair as a part in proportion to the torque plus a constant one.

    Parameters
    ----------
    groups : sequence of GroupFit
        Segments of effort, with the pair as fitted to them.
    orders : LineOrders
        Of that pair.
    coefficients : ndarray
        The whitening's.

    Returns
    -------
    tuple of TorqueShare
        The circular spline's and the flexspline's; empty without both directions, or where the torque hardly swings.

    Notes
    -----
    The torque is the slow part of the effort itself, less what changes with the direction and in proportion to the
    speed: most friction acts on the motor's side of the teeth. Only by both directions can it be known. They share
    nothing but the share; where they differ by more than their noise the interval is widened by that. At 0 and 1 one
    part's phasor vanishes, in each direction, so that the interval allows for so many numbers; between, it is too wide
    rather than too narrow.
    """
    if {group.segments[0].direction for group in groups} != {1, -1}:
        return ()
    torques = _transmitted([segment for group in groups for segment in group.segments], orders.trend)
    fitted = [_fitted(group, orders, coefficients, [next(torques) for _ in group.segments]) for group in groups]
    parts = [part for part in fitted if part is not None]
    if len(parts) < len(groups):
        return ()
    shares = []
    for number, spline in enumerate(LinePair._fields):
        misfits = [_misfits(*_of_line(number, orders.lines.size, *part)) for part in parts]
        shares.append(_share(spline, np.sum(misfits, axis=0), len(parts)))
    return tuple(shares)


def _transmitted(segments: Sequence[JointSegment], trend: float) -> Iterator[FloatArray]:
    """Yield each segment's torque without friction, over the root mean square of all."""
    slow, columns = [], []
    for segment in segments:
        terms = trend_columns(segment, trend)
        slow.append(terms @ np.linalg.lstsq(terms, segment.values, rcond=None)[0])
        gravity = [np.ones(segment.angle.size), *(f(k * segment.angle) for k in (1, 2) for f in (np.cos, np.sin))]
        friction = [segment.direction * np.ones(segment.angle.size), segment.direction * segment.speed]
        columns.append(np.column_stack([*gravity, *friction]))
    solution = np.linalg.lstsq(np.concatenate(columns), np.concatenate(slow), rcond=None)[0]
    free = [torque - own[:, -2:] @ solution[-2:] for torque, own in zip(slow, columns, strict=True)]
    size = math.sqrt(float(np.mean(np.concatenate(free) ** 2)))
    yield from (torque / max(size, 1e-300) for torque in free)


def _fitted(
    group: GroupFit, orders: LineOrders, coefficients: FloatArray, torques: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray] | None:
    """Coefficients of the lines times the torque, the lines and the motor's, cosines first, and their covariance."""
    twice = replace(orders, lines=np.tile(orders.lines, 2), reference_orders=np.empty(0))
    following = np.zeros(twice.every.size, dtype=np.bool_)
    following[: orders.lines.size] = True
    total: Products | None = pool(
        products
        for segment, torque in zip(group.segments, torques, strict=True)
        if (products := _products(segment, torque, twice, following, coefficients)) is not None
    )
    normal = None if total is None else solve_normal(total.matrix, twice.fitted_columns)
    return None if normal is None else (normal[0], normal[1] * group.fit.floor)


def _products(
    segment: JointSegment, torque: FloatArray, orders: LineOrders, following: BoolArray, coefficients: FloatArray
) -> Products | None:
    good, trend = settled(segment.starts, coefficients), trend_columns(segment, orders.trend)
    if np.count_nonzero(good) < 2 * (trend.shape[1] + orders.fitted_columns.size):
        return None
    columns = segment.columns(orders.every)
    columns[:, np.tile(following, 2)] *= torque[:, None]
    columns = np.column_stack([columns, segment.values - segment.values.mean()])
    return products_of_columns(whiten(coefficients, columns)[good], whiten(coefficients, trend)[good], orders)


def _of_line(number: int, lines: int, solution: FloatArray, covariance: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Of one line: the following part's real and imaginary part, then the other's, and their covariance."""
    half = solution.size // 2
    place: IntArray = np.array([number, half + number, lines + number, half + lines + number])
    return solution[place], covariance[np.ix_(place, place)]


def _misfits(parts: FloatArray, covariance: FloatArray) -> FloatArray:
    """Least chi-squared of a line's two parts, (4,), for every one of `_MIXTURES`, whatever size and phases."""
    weight = np.linalg.inv(covariance)
    turn = np.stack([[np.cos(_PHASES), -np.sin(_PHASES)], [np.sin(_PHASES), np.cos(_PHASES)]])
    shape = (_MIXTURES.size, _PHASES.size, 2, 2)
    following = np.sin(_MIXTURES)[:, None, None, None] * np.moveaxis(turn, -1, 0)
    constant = np.cos(_MIXTURES)[:, None, None, None] * np.eye(2)
    basis = np.concatenate([np.broadcast_to(following, shape), np.broadcast_to(constant, shape)], axis=2)
    score = np.einsum("apij,ik,k->apj", basis, weight, parts)
    information = np.einsum("apij,ik,apkl->apjl", basis, weight, basis)
    explained = np.einsum("apj,apj->ap", score, np.linalg.solve(information, score[..., None])[..., 0])
    return np.asarray(parts @ weight @ parts - explained.max(axis=1))


def _share(spline: str, misfits: FloatArray, groups: int) -> TorqueShare:
    best = int(np.argmin(misfits))
    limit = misfits[best] + float(scipy.stats.chi2.ppf(CONFIDENCE, 2 * groups)) * max(1.0, misfits[best] / (groups - 1))
    shares = np.sin(_MIXTURES) ** 2
    inside = shares[misfits <= limit]
    return TorqueShare(spline=spline, share=float(shares[best]), low=float(inside.min()), high=float(inside.max()))

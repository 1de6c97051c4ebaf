"""Segments whitened, freed from their trend, and summed up in Gram matrices that add up over segments."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from ..arrays import FloatArray
from ..reducer import LinePair
from .joint_segment import HIGHEST_SHARE, JointSegment
from .whitening import settled, whiten

REFERENCE_PAIRS = 12
"""Reference pairs of orders around a pair, one line separation apart: the noise floor is what a fit finds there."""

FLOOR_REACH = 0.15
"""Part of the pair's order within which they stay, five in any case."""

TREND_CYCLES = 5.0
"""Cycles of the first pair between two knots of the trend: a spline of that flexibility cannot follow the lines."""

CLIP = 2.5
"""Robust standard deviations beyond which a residual is clipped."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PairOrders:
    """Orders [cycles per output revolution] that are fitted or looked at together.

    Attributes
    ----------
    lines : ndarray, shape (2,)
        The circular spline's and the flexspline's; or any number of lines, where others are tried.
    nuisance : ndarray
        Lines of the motor, fitted along.
    reference_orders : ndarray
        Where there is no line.
    trend : float
        Order up to which the trend follows the signal.
    separation : float
        Distance of the two lines.
    """

    lines: FloatArray
    nuisance: FloatArray
    reference_orders: FloatArray
    trend: float
    separation: float

    @classmethod
    def around(cls, pair: LinePair, k: int = 1, motor: Iterable[float] = ()) -> "PairOrders":
        """Choose reference orders around the k-th multiple of the first `pair`, away from the motor's orders."""
        trend = pair.circular_spline / TREND_CYCLES
        pair = LinePair(k * pair.circular_spline, k * pair.flexspline)
        separation = pair.flexspline - pair.circular_spline
        count = max(5, min(REFERENCE_PAIRS, int(FLOOR_REACH * pair.circular_spline / separation)))
        offsets = separation * np.arange(1.0, count + 1.0)
        reference_orders = np.concatenate([pair.circular_spline - offsets[::-1], pair.flexspline + offsets])
        others = np.array([order for order in motor if min(abs(order - line) for line in pair) > 1e-6])
        clear = reference_orders > separation
        for order in others:
            clear &= np.abs(reference_orders - order) > 0.5 * separation
        return cls(
            lines=np.array(pair),
            nuisance=others,
            reference_orders=reference_orders[clear],
            trend=trend,
            separation=separation,
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Gram:
    """Inner products of a segment's whitened columns (lines, motor, reference_orders, signal), in units of its noise.

    Gram matrices of segments add up to that of all segments together; nothing else of a segment need be kept.
    """

    products: FloatArray
    rows: int
    noise: float


def gram_of_segment(segment: JointSegment, orders: PairOrders, coefficients: FloatArray) -> Gram | None:
    """Whiten a segment, take its trend off and sum it up; None if it is too short for that."""
    slow = segment.speed * orders.lines[-1] <= HIGHEST_SHARE * segment.rate * 2.0 * np.pi
    good = settled(segment.starts, coefficients) & slow
    trend = trend_columns(segment, orders.trend)
    if np.count_nonzero(good) < 2 * (trend.shape[1] + 2 * (orders.lines.size + orders.nuisance.size)):
        return None
    columns = np.concatenate(
        [
            segment.columns(orders.lines),
            segment.columns(orders.nuisance),
            segment.columns(orders.reference_orders),
            segment.values[:, None] - segment.values.mean(),
        ],
        axis=1,
    )
    columns = project(whiten(coefficients, trend)[good], whiten(coefficients, columns)[good])
    fitted = 2 * (orders.lines.size + orders.nuisance.size)
    signal, freedom = columns[:, -1], np.count_nonzero(good) - trend.shape[1] - fitted
    fit, residual = clipped_fit(columns[:, :fitted], signal)
    noise = float(np.sqrt(residual @ residual / freedom))
    if not noise > 0.0:
        return None
    columns[:, -1] = fit + residual
    columns /= noise
    return Gram(products=columns.T @ columns, rows=int(np.count_nonzero(good)), noise=noise)


def residual_of_segment(segment: JointSegment, orders: PairOrders) -> FloatArray:
    """What trend and lines leave of a segment's signal, shape (rows,): what the whitening is learnt from."""
    parts = [segment.columns(orders.lines), segment.columns(orders.nuisance), segment.values[:, None]]
    columns = project(trend_columns(segment, orders.trend), np.concatenate(parts, axis=1))
    fit, _ = clipped_fit(columns[:, :-1], columns[:, -1])
    return np.asarray(columns[:, -1] - fit)


def trend_columns(segment: JointSegment, order: float) -> FloatArray:
    """Cubic splines in the angle, shape (rows, terms), with so many knots per revolution: friction, gravity, servo."""
    angle = segment.angle
    span = float(np.ptp(angle))
    pieces = max(1, round(span * order / (2.0 * np.pi)))
    knots = np.concatenate([np.zeros(3), np.linspace(0.0, 1.0, pieces + 1), np.ones(3)])
    place = np.clip((angle - angle.min()) / span, 0.0, 1.0) if span > 0.0 else np.zeros(angle.size)
    return np.asarray(BSpline.design_matrix(place, knots, 3).toarray(), dtype=np.float64)


def project(trend: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns less what the trend's columns explain of them."""
    left, sizes, _ = np.linalg.svd(trend, full_matrices=False)
    left = left[:, sizes > 1e-6 * sizes[0]]
    return np.asarray(columns - left @ (left.T @ columns))


def clipped_fit(columns: FloatArray, signal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fit and residual of the columns, the residual clipped by Huber's rule so that spikes lose their pull.

    The residual is divided by the share of rows that are not clipped: with it, the formulas of plain least squares
    hold for the sum of the two.
    """
    basis, _ = np.linalg.qr(columns)
    fit = basis @ (basis.T @ signal)
    residual = signal - fit
    for _ in range(10):
        limit = CLIP * float(np.median(np.abs(residual))) / 0.6745
        clipped = np.clip(residual, -limit, limit)
        share = max(float(np.mean(np.abs(residual) <= limit)), 0.5)
        step = basis @ (basis.T @ clipped) / share
        fit = fit + step
        residual = signal - fit
        if float(step @ step) < 1e-8 * float(clipped @ clipped):
            break
    return fit, np.clip(residual, -limit, limit) / share

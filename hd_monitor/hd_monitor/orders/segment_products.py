"""Products of joint segments: whitened, freed from their trend and from spikes."""

import numpy as np
from scipy.interpolate import BSpline

from ..arrays import FloatArray
from .joint_segment import HIGHEST_SHARE, JointSegment
from .line_orders import LineOrders
from .regression import Products
from .samples import clipped_fit, products_of_columns, project
from .whitening import settled, whiten


def products_of_segment(segment: JointSegment, orders: LineOrders, coefficients: FloatArray) -> Products | None:
    """Whiten a segment, take its trend off and multiply its columns; None if it is too short or too fast for that."""
    slow = segment.speed * orders.lines[-1] <= HIGHEST_SHARE * segment.rate * 2.0 * np.pi
    good = settled(segment.starts, coefficients) & slow
    trend = trend_columns(segment, orders.trend)
    if np.count_nonzero(good) < 2 * (trend.shape[1] + orders.fitted_columns.size):
        return None
    columns = np.column_stack([segment.columns(orders.every), segment.values - segment.values.mean()])
    return products_of_columns(whiten(coefficients, columns)[good], whiten(coefficients, trend)[good], orders)


def residual_of_segment(segment: JointSegment, orders: LineOrders) -> FloatArray:
    """What trend and lines leave of a segment's signal, shape (rows,): what the whitening is learnt from."""
    lines = segment.columns(np.concatenate([orders.lines, orders.nuisance]))
    columns = project(trend_columns(segment, orders.trend), np.column_stack([lines, segment.values]))
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

"""Products of joint segments: whitened, freed from their trend and from spikes."""

import math

import numpy as np
import scipy

from ..arrays import FloatArray
from ..robust import clip
from .joint_segment import HIGHEST_SHARE, JointSegment
from .line_orders import LineOrders
from .orthonormal import project
from .regression import Products
from .whitening import settled, whiten

CLIP = 2.5
"""Robust standard deviations beyond which a residual is clipped; costs 1 % of efficiency on Gaussian noise."""

ROUNDS = 10
"""Rounds of Huber's iteration at most; it converges geometrically, the faster the fewer the outliers."""


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
    return np.asarray(scipy.interpolate.BSpline.design_matrix(place, knots, 3).toarray(), dtype=np.float64)


def products_of_columns(columns: FloatArray, trend: FloatArray, orders: LineOrders) -> Products | None:
    """Take a trend off columns, spikes off the last one, which is the signal, and multiply them.

    Parameters
    ----------
    columns : ndarray, shape (rows, 2 * orders + 1)
        More than there are terms and fitted columns.
    trend : ndarray, shape (rows, terms)
    orders : LineOrders
        What the columns are; what its lines do not explain and sticks out is a spike.

    Returns
    -------
    Products or None
        None if nothing is left of the signal.
    """
    fitted = orders.fitted_columns
    freedom = len(columns) - trend.shape[1] - fitted.size
    columns = project(trend, columns)
    fit, residual = clipped_fit(columns[:, fitted], columns[:, -1])
    noise = math.sqrt(float(residual @ residual) / freedom)
    if not noise > 0.0:
        return None
    columns[:, -1] = fit + residual
    columns /= noise
    return Products(orders=orders.every, matrix=columns.T @ columns, rows=len(columns), noise=noise)


def clipped_fit(columns: FloatArray, signal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fit and residual of the columns, the residual clipped by Huber's rule so that spikes lose their pull.

    The residual is divided by the share of rows that are not clipped: with it, the formulas of plain least squares
    hold for the sum of the two.
    """
    basis, _ = np.linalg.qr(columns)
    fit = basis @ (basis.T @ signal)
    for _ in range(ROUNDS):
        residual = signal - fit
        clipped = clip(residual, CLIP)
        share = max(float(np.mean(clipped == residual)), 0.5)
        step = basis @ (basis.T @ clipped) / share
        fit = fit + step
        if float(step @ step) < 1e-8 * float(clipped @ clipped):
            break
    return fit, clip(signal - fit, CLIP) / share

"""Regression on lines from samples at hand: trends taken off, spikes clipped."""

import math

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray
from ..errors import ParameterError
from ..robust import clip
from .line_orders import LineOrders
from .orthonormal import orthonormal
from .regression import LineFit, Products, line_columns, solve

CLIP = 2.5
"""Robust standard deviations beyond which a residual is clipped; costs 1 % of efficiency on Gaussian noise."""

ROUNDS = 10
"""Rounds of Huber's iteration at most; it converges geometrically, the faster the fewer the outliers."""


def fit_lines(
    values: npt.ArrayLike, angle: npt.ArrayLike, orders: npt.ArrayLike, *, trend: npt.ArrayLike | None = None
) -> LineFit:
    """Fit lines of known order to a signal against an angle.

    Parameters
    ----------
    values : array_like, shape (samples,)
        The signal, any unit; NaN where missing.
    angle : array_like, shape (samples,)
        Angle of each sample [rad]: the output's or the wave generator's, as long as `orders` count its revolutions.
    orders : array_like, shape (lines,)
        Cycles per revolution of `angle`: the pairs, and whatever else is there (combination lines).
    trend : array_like, shape (samples, columns), optional
        What else the signal may contain and is not a line (friction, gravity); by default a constant and a drift.

    Returns
    -------
    LineFit
        One noise floor holds for all lines: fit lines that are far apart one group at a time.

    Raises
    ------
    ParameterError
        If shapes disagree, an order is there twice, or the samples and the travel do not determine the lines.

    Examples
    --------
    >>> import numpy as np
    >>> angle = np.linspace(0.0, np.pi / 2, 2000)
    >>> values = 0.5 * np.cos(160 * angle + 1.0) + 0.2 * np.cos(162 * angle)
    >>> np.round(fit_lines(values, angle, [160, 162]).amplitudes, 6)
    array([0.5, 0.2])
    """
    values, angle = np.asarray(values, dtype=np.float64), np.asarray(angle, dtype=np.float64)
    lines = np.atleast_1d(np.asarray(orders, dtype=np.float64))
    drift = np.column_stack([np.ones(values.size), np.linspace(-1.0, 1.0, values.size)])
    slow = drift if trend is None else np.asarray(trend, dtype=np.float64)
    _check(values, angle, lines, slow)
    used = np.isfinite(values) & np.isfinite(angle) & np.isfinite(slow).all(axis=1)
    travel = float(np.ptp(angle[used])) if used.any() else 0.0
    fit = None
    if travel > 0.0:
        wanted = LineOrders.around(lines, math.tau / travel)
        columns = np.column_stack([line_columns(angle[used], wanted.every), values[used]])
        products = products_of_columns(columns, slow[used], wanted)
        fit = solve(products, wanted) if products is not None else None
    if fit is None:
        raise ParameterError(
            f"{np.count_nonzero(used)} samples over {math.degrees(travel):.3g}° do not tell the orders "
            f"{', '.join(f'{order:g}' for order in lines)} apart, or not from the trend; record a longer motion"
        )
    return fit


def _check(values: FloatArray, angle: FloatArray, orders: FloatArray, trend: FloatArray) -> None:
    """Refuse what is not a regression problem."""
    if values.ndim != 1 or angle.shape != values.shape:
        raise ParameterError(f"values {values.shape} and angle {angle.shape} must be of one length: one each a sample")
    if orders.ndim != 1 or not orders.size or not (np.isfinite(orders).all() and (orders > 0.0).all()):
        raise ParameterError(f"orders = {orders} are not a list of lines; give positive cycles per revolution")
    if np.unique(orders).size < orders.size:
        raise ParameterError(f"orders = {orders} name a line twice, which leaves it no amplitude of its own")
    if trend.ndim != 2 or len(trend) != values.size:
        raise ParameterError(f"trend {trend.shape} does not fit {values.size} values: one row a sample")


def products_of_columns(columns: FloatArray, trend: FloatArray, orders: LineOrders) -> Products | None:
    """Take a trend off columns, spikes off the last one, which is the signal, and multiply them.

    Parameters
    ----------
    columns : ndarray, shape (rows, 2 * orders + 1)
    trend : ndarray, shape (rows, terms)
    orders : LineOrders
        What the columns are; what its lines do not explain and sticks out is a spike.

    Returns
    -------
    Products or None
        None if nothing is left of the signal, or there are too few rows.
    """
    fitted = orders.fitted_columns
    freedom = len(columns) - trend.shape[1] - fitted.size
    if freedom < 1:
        return None
    columns = project(trend, columns)
    fit, residual = clipped_fit(columns[:, fitted], columns[:, -1])
    noise = math.sqrt(float(residual @ residual) / freedom)
    if not noise > 0.0:
        return None
    columns[:, -1] = fit + residual
    columns /= noise
    return Products(orders=orders.every, matrix=columns.T @ columns, rows=len(columns), noise=noise)


def project(trend: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns less what the trend's columns explain of them."""
    directions = orthonormal(trend)
    return np.asarray(columns - directions @ (directions.T @ columns))


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

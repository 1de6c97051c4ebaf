"""Lines at known orders of a joint's rotation by least squares: right at any speed and in short travel.

The signal is taken for ``Re sum_l phasors[l] exp(i orders[l] angle)`` plus noise. All that a fit needs are inner
products of columns: those of the lines wanted, of the lines fitted along, of reference orders, where there is no line,
and of the signal (:class:`Products`). They add up over data; :func:`solve` is the one place where they are solved.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy

from ..arrays import ComplexArray, FloatArray, IntArray
from .line_orders import LineOrders

CHANCE = 1e-3
"""Probability of noise making a line as large, below which the line counts as found."""

LEAST_FREEDOM = 5.0
"""Degrees of freedom of the noise floor below which there is no estimate."""

NEAR = 6.0
"""Spacings over which the reference orders' weight falls to half: amplitudes that vary show as skirts near by."""

WORST_CONDITION = 1e8
"""Condition number of the normal equations above which they do not determine the lines."""

_SAME = 1e-6  # cycles per revolution


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Products:
    """Inner products of the columns of lines and of the signal: all that need be kept of data.

    Attributes
    ----------
    orders : ndarray, shape (orders,)
        Cycles per revolution.
    matrix : ndarray, shape (2 * orders + 1, 2 * orders + 1)
        Of their :func:`line_columns` and, last, of the signal; each over `noise`.
    rows : int
        Samples behind it.
    noise : float
        Standard deviation of their noise, in the signal's unit.
    """

    orders: FloatArray
    matrix: FloatArray
    rows: int
    noise: float = 1.0

    def places(self, orders: FloatArray) -> IntArray:
        """Where some orders, shape (N,), are among those held; -1 for those that are not."""
        distance = np.abs(np.subtract.outer(orders, self.orders))
        return np.where(distance.min(axis=1) < _SAME, distance.argmin(axis=1), -1)


def pool(parts: Iterable[Products]) -> Products | None:
    """Add up products for the same orders, coherently in the absolute angle; None if there are none."""
    total: Products | None = None
    for part in parts:
        if total is None:
            total = part
            continue
        rows = total.rows + part.rows
        noise = math.sqrt(rows / (total.rows / total.noise**2 + part.rows / part.noise**2))
        total = Products(orders=total.orders, matrix=total.matrix + part.matrix, rows=rows, noise=noise)
    return total


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LineFit:
    """Lines fitted to products.

    Attributes
    ----------
    phasors : ndarray of complex, shape (lines,)
        Peak amplitude and phase (at angle zero) of every line, in the signal's unit.
    covariance : ndarray, shape (2 * lines, 2 * lines)
        Of the phasors' real parts, then their imaginary parts, from the noise floor.
    floor : float
        Noise power at the reference orders over that of white noise; above 1 where lines' amplitudes vary.
    freedom : float
        Degrees of freedom behind `floor`.
    noise : float
        Standard deviation of what the fit leaves of a sample, over the whole band, in the signal's unit.
    rows : int
        Samples used.
    reference_orders : ndarray, shape (references,)
    found, left : ndarray, shape (references,)
        At each of them, after the fit is subtracted: squared product with the signal, and with itself.
    """

    phasors: ComplexArray
    covariance: FloatArray
    floor: float
    freedom: float
    noise: float
    rows: int
    reference_orders: FloatArray
    found: FloatArray
    left: FloatArray

    @property
    def amplitudes(self) -> FloatArray:
        """Peak amplitudes, shape (lines,)."""
        return np.abs(self.phasors)

    @property
    def amplitude_covariance(self) -> FloatArray:
        """Covariance of the amplitudes, shape (lines, lines): of the components along the phasors."""
        angle = np.angle(self.phasors)
        along = np.concatenate([np.diag(np.cos(angle)), np.diag(np.sin(angle))])
        return np.asarray(along.T @ self.covariance @ along)

    @property
    def amplitude_stds(self) -> FloatArray:
        """Standard deviations of the amplitudes, shape (lines,)."""
        return np.sqrt(np.diag(self.amplitude_covariance))

    @property
    def explained(self) -> float:
        """Power that the lines explain, in units of the floor: twice their number by chance."""
        parts = np.concatenate([self.phasors.real, self.phasors.imag])
        return float(parts @ np.linalg.solve(self.covariance, parts))

    @property
    def log_evidence(self) -> float:
        """Logarithm of the likelihood ratio against noise alone, less a penalty for the number of lines (BIC)."""
        parameters = 2 * self.phasors.size
        total = self.freedom + parameters
        return 0.5 * total * math.log1p(self.explained / self.freedom) - 0.5 * parameters * math.log(total)

    @property
    def chances(self) -> FloatArray:
        """Probability, for each line, that noise alone makes it this large (F test against the reference orders)."""
        line, parts = np.arange(self.phasors.size), np.stack([self.phasors.real, self.phasors.imag], axis=1)
        own = self.covariance.reshape(2, line.size, 2, line.size)[:, line, :, line]
        ratios = (parts * np.linalg.solve(own, parts[:, :, None])[:, :, 0]).sum(axis=1) / 2.0
        return np.asarray(scipy.stats.f.sf(ratios, 2, self.freedom))

    @property
    def rival(self) -> float | None:
        """Reference order with a significant line that is larger than all those fitted; None if there is none."""
        best = int(np.argmax(np.where(self.left > 0.0, self.found / np.where(self.left > 0.0, self.left, 1.0), 0.0)))
        rest = np.arange(self.left.size) != best
        if not self.found[rest].any():
            return None
        ratio = float(self.found[best] / self.left[best] / (self.found[rest].sum() / self.left[rest].sum()))
        by_chance = rest.size * float(scipy.stats.f.sf(ratio, 2, 2 * (rest.size - 1)))
        larger = 2.0 * math.sqrt(self.found[best]) / float(self.left[best]) > float(self.amplitudes.max())
        return float(self.reference_orders[best]) if by_chance < CHANCE and larger else None


def line_columns(angle: npt.ArrayLike, orders: npt.ArrayLike) -> FloatArray:
    """Columns cos(order angle), then -sin(order angle): their coefficients are the phasors' real and imaginary parts.

    Parameters
    ----------
    angle : array_like, shape S
        Angle [rad].
    orders : array_like, shape (lines,)
        Cycles per revolution of that angle.

    Returns
    -------
    ndarray, shape S + (2 * lines,)
    """
    phase = np.multiply.outer(np.asarray(angle, dtype=np.float64), np.asarray(orders, dtype=np.float64))
    return np.concatenate([np.cos(phase), -np.sin(phase)], axis=-1)


def solve_normal(
    matrix: FloatArray, fitted: IntArray, worst_condition: float = WORST_CONDITION
) -> tuple[FloatArray, FloatArray] | None:
    """Solve normal equations for some of their columns; the last column is the signal.

    Parameters
    ----------
    matrix : ndarray, shape (columns + 1, columns + 1)
        Inner products.
    fitted : ndarray of int
        Columns to be fitted.
    worst_condition : float
        Condition number, of the columns scaled to equal size, above which they are not determined.

    Returns
    -------
    tuple of ndarray or None
        Coefficients and the inverse of the columns' products (their covariance in units of the noise's variance); None
        if the data do not determine them.
    """
    own = matrix[np.ix_(fitted, fitted)]
    size = np.sqrt(np.maximum(np.diag(own), 0.0))
    if not size.all():
        return None
    scaled = own / np.multiply.outer(size, size)
    if not np.linalg.cond(scaled) < worst_condition:
        return None
    inverse = np.linalg.inv(scaled) / np.multiply.outer(size, size)
    return inverse @ matrix[fitted, -1], inverse


def solve(products: Products, wanted: LineOrders) -> LineFit | None:
    """Fit lines, with those of their reference orders that the products hold; None if these do not determine them.

    Notes
    -----
    The floor is measured where it matters, at reference orders around the lines, since vibration is nowhere white.
    With residual maker M and reference columns C, ``|C' M signal|²`` has under white noise the expectation ``variance ·
    trace(C' M C)``; dividing by that trace corrects exactly for what the fit has taken away, and ``trace² / |C' M C|²``
    is Satterthwaite's number of degrees of freedom. White noise is thereby assumed within the reference range only.

    Two lines that are ``d`` resolutions apart (a resolution is one cycle over the travel) inflate each other's variance
    by ``1 / (1 - sinc² d)``: known orders cost that little; unknown frequencies would cost up to a thousand times more.
    """
    held = products.places(wanted.reference_orders) >= 0
    orders = replace(wanted, reference_orders=wanted.reference_orders[held])
    place = products.places(orders.every)
    if (place < 0).any():
        return None
    index = np.concatenate([place, place + products.orders.size, [2 * products.orders.size]])
    matrix, lines = products.matrix[np.ix_(index, index)], orders.lines.size
    fitted, beside = orders.fitted_columns, orders.reference_columns
    normal = solve_normal(matrix, fitted)
    if normal is None:
        return None
    solution, inverse = normal
    cross = matrix[np.ix_(beside, fitted)]
    left = matrix[np.ix_(beside, beside)] - cross @ inverse @ cross.T
    found = (matrix[beside, -1] - cross @ solution) ** 2
    distance = np.abs(np.subtract.outer(orders.reference_orders, orders.lines)).min(axis=1) / orders.spacing
    weights = np.tile(1.0 / (1.0 + (distance / NEAR) ** 2), 2)
    trace = float(weights @ np.diag(left))
    if not trace > 0.0:
        return None
    floor = float(weights @ found) / trace
    freedom = trace**2 / float(weights @ left**2 @ weights)
    if freedom < LEAST_FREEDOM or not floor > 0.0:
        return None
    half = fitted.size // 2
    parts = np.concatenate([np.arange(lines), half + np.arange(lines)])
    return LineFit(
        phasors=solution[:lines] + 1j * solution[half : half + lines],
        covariance=inverse[np.ix_(parts, parts)] * floor,
        floor=floor,
        freedom=freedom,
        noise=products.noise,
        rows=products.rows,
        reference_orders=orders.reference_orders,
        found=found.reshape(2, -1).sum(axis=0),
        left=np.diag(left).reshape(2, -1).sum(axis=0),
    )

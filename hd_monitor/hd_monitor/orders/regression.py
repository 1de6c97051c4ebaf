"""Line amplitudes by least squares with known orders in the joint's angle: right at any speed and in short travel."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import solve_triangular

from ..arrays import ComplexArray, FloatArray
from ..errors import ParameterError

HUBER = 2.5
"""Residuals beyond this many robust standard deviations are clipped; costs 1 % of efficiency on Gaussian noise."""

ROUNDS = 50
"""Rounds of Huber's iteration at most; it converges geometrically, the faster the fewer the outliers."""

FLOOR_ORDERS = 12
"""Reference orders on either side of a group of lines at which the noise floor is measured."""

FLOOR_REACH = 0.2
"""Part of an order within which reference orders stay, as long as there are three on either side."""

DEPENDENT = 1e-9
"""Least size, relative to its own, of the part of a column that the others do not explain."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LineFit:
    """Amplitudes and phases of lines at known orders, ``values ~ Re sum_l phasors[l] exp(i orders[l] angle)``.

    Attributes
    ----------
    orders : ndarray, shape (lines,)
        Cycles per revolution of the angle.
    phasors : ndarray of complex, shape (lines,)
        Peak amplitude and phase (at angle zero) of every line, in the values' unit.
    covariance : ndarray, shape (2 * lines, 2 * lines)
        Of the phasors' real parts, then their imaginary parts, from the measured noise floor.
    noise_std : ndarray, shape (lines,)
        Standard deviation of one sample of white noise as strong as the floor around each line.
    floor_freedom : ndarray, shape (lines,)
        Effective degrees of freedom behind `noise_std`: 2 for every independent reference order.
    residual_std : float
        Standard deviation of what the fit leaves, over the whole band.
    samples : int
        Samples used; those that are not finite are left out.
    outliers : int
        Samples whose residual was clipped.
    travel : float
        Range of the angle covered [rad].
    """

    orders: FloatArray
    phasors: ComplexArray
    covariance: FloatArray
    noise_std: FloatArray
    floor_freedom: FloatArray
    residual_std: float
    samples: int
    outliers: int
    travel: float

    @property
    def amplitudes(self) -> FloatArray:
        """Peak amplitudes, shape (lines,)."""
        return np.abs(self.phasors)

    @property
    def amplitude_stds(self) -> FloatArray:
        """Standard deviations of the amplitudes, shape (lines,): of the component along each phasor."""
        lines = self.orders.size
        angles = np.angle(self.phasors)
        return np.array(
            [
                np.sqrt(max(direction @ self._block(line) @ direction, 0.0))
                for line, direction in enumerate(np.column_stack([np.cos(angles), np.sin(angles)]))
            ]
        ).reshape(lines)

    def chi_square(self, line: int) -> float:
        """Squared size of a line in units of its covariance: chi-square with 2 degrees of freedom if there is none."""
        parts = np.array([self.phasors[line].real, self.phasors[line].imag])
        return float(parts @ np.linalg.solve(self._block(line), parts))

    def _block(self, line: int) -> FloatArray:
        index = [line, line + self.orders.size]
        return self.covariance[np.ix_(index, index)]


def line_columns(angle: npt.ArrayLike, orders: npt.ArrayLike) -> FloatArray:
    """Columns cos(order angle), then -sin(order angle): their coefficients are the phasors' real and imaginary parts.

    Parameters
    ----------
    angle : array_like, shape (samples,)
        Angle [rad].
    orders : array_like, shape (lines,)
        Cycles per revolution of that angle.

    Returns
    -------
    ndarray, shape (samples, 2 * lines)
    """
    phase = np.multiply.outer(np.asarray(angle, dtype=np.float64), np.asarray(orders, dtype=np.float64))
    return np.concatenate([np.cos(phase), -np.sin(phase)], axis=1)


def fit_lines(
    values: npt.ArrayLike,
    angle: npt.ArrayLike,
    orders: npt.ArrayLike,
    *,
    trend_degree: int = 1,
    nuisance: npt.ArrayLike | None = None,
    weights: npt.ArrayLike | None = None,
    robust: bool = True,
    floor_orders: int = FLOOR_ORDERS,
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
    trend_degree : int
        Degree of the polynomial in time (sample number) that is fitted along; -1 for none.
    nuisance : array_like, shape (samples, columns), optional
        More that the signal may contain and that is no line (friction, gravity): fitted along, not reported.
    weights : array_like, shape (samples,), optional
        Relative inverse variances of the samples.
    robust : bool
        Clip residuals by Huber's rule, so that spikes lose their pull.
    floor_orders : int
        Reference orders on either side of the lines, one resolution apart, at which the noise floor is measured.

    Returns
    -------
    LineFit

    Raises
    ------
    ParameterError
        If shapes disagree, an order is there twice, or the samples and the travel do not determine the lines.

    Notes
    -----
    The floor is measured where it matters, at reference orders around each group of lines, since vibration is nowhere
    white. With residual maker M and reference columns C, ``|C' M values|²`` has under white noise the expectation
    ``variance · trace(C' M C)``; dividing by that trace corrects exactly for what the fit has taken away, and
    ``trace² / |C' M C|²`` is Satterthwaite's number of degrees of freedom. White noise is thereby not assumed over
    the band, only within the reference range.

    Two lines that are ``d`` resolutions apart (a resolution is one cycle over the travel) inflate each other's variance
    by ``1 / (1 - sinc² d)``: known orders cost that little; unknown frequencies would cost up to a thousand times more.

    Examples
    --------
    >>> import numpy as np
    >>> angle = np.linspace(0.0, np.pi / 2, 2000)
    >>> values = 0.5 * np.cos(160 * angle + 1.0) + 0.2 * np.cos(162 * angle)
    >>> np.round(np.abs(fit_lines(values, angle, [160, 162]).phasors), 6)
    array([0.5, 0.2])
    """
    values, angle = np.asarray(values, dtype=np.float64), np.asarray(angle, dtype=np.float64)
    orders = np.atleast_1d(np.asarray(orders, dtype=np.float64))
    given = np.ones(values.shape) if weights is None else np.asarray(weights, dtype=np.float64)
    extra = np.empty((values.size, 0)) if nuisance is None else np.asarray(nuisance, dtype=np.float64)
    _check(values, angle, orders, given, extra)
    used = np.isfinite(values) & np.isfinite(angle) & np.isfinite(extra).all(axis=1) & (given > 0.0)
    time = np.linspace(-1.0, 1.0, values.size)[used]
    trend = np.polynomial.legendre.legvander(time, max(trend_degree, 0))[:, : trend_degree + 1]
    values, angle, extra = values[used], angle[used], np.concatenate([trend, extra[used]], axis=1)
    travel = float(np.ptp(angle)) if angle.size else 0.0
    freedom = values.size - 2 * orders.size - extra.shape[1]
    if freedom < 1 or travel <= 0.0:
        raise ParameterError(
            f"{values.size} samples over {np.degrees(travel):.3g}° do not determine {orders.size} lines and "
            f"{extra.shape[1]} other terms; record a longer motion"
        )
    scale = np.sqrt(given[used] / given[used].mean())
    basis, triangle = _factorise(line_columns(angle, orders) * scale[:, None], extra * scale[:, None], orders, travel)
    fit, residual, outliers = _huber(basis, values * scale, robust)
    # Huber's estimate is plain least squares of the fit plus the clipped residuals, if these are divided by the share
    # of samples that are not clipped: with them in the residuals' place the formulas of least squares hold.
    residual /= max(1.0 - outliers / values.size, 0.5)
    floors, floor_freedom = np.empty(orders.size), np.empty(orders.size)
    for group, reference in _reference_orders(orders, travel, floor_orders):
        columns = line_columns(angle, reference) * scale[:, None]
        columns -= basis @ (basis.T @ columns)
        trace = float(np.sum(columns * columns))
        if trace > 0.0:
            floors[group] = float(np.sum((columns.T @ residual) ** 2)) / trace
            floor_freedom[group] = trace**2 / float(np.sum((columns.T @ columns) ** 2))
        else:
            floors[group], floor_freedom[group] = float(residual @ residual) / freedom, freedom
    solution = solve_triangular(triangle, basis[:, -2 * orders.size :].T @ fit)
    inverse = solve_triangular(triangle, np.eye(2 * orders.size))
    stds = np.sqrt(np.tile(floors, 2))
    return LineFit(
        orders=orders,
        phasors=solution[: orders.size] + 1j * solution[orders.size :],
        covariance=stds[:, None] * (inverse @ inverse.T) * stds,
        noise_std=np.sqrt(floors),
        floor_freedom=floor_freedom,
        residual_std=float(np.sqrt(residual @ residual / freedom)),
        samples=int(values.size),
        outliers=outliers,
        travel=travel,
    )


def _check(
    values: FloatArray, angle: FloatArray, orders: FloatArray, weights: FloatArray, nuisance: FloatArray
) -> None:
    """Refuse what is no regression problem."""
    if values.ndim != 1 or angle.shape != values.shape:
        raise ParameterError(f"values {values.shape} and angle {angle.shape} must be of one length: one each a sample")
    if orders.ndim != 1 or not orders.size or not (np.isfinite(orders).all() and (orders > 0.0).all()):
        raise ParameterError(f"orders = {orders} are no list of lines; give positive cycles per revolution")
    if np.unique(orders).size < orders.size:
        raise ParameterError(f"orders = {orders} name a line twice, which leaves it no amplitude of its own")
    if weights.shape != values.shape or nuisance.ndim != 2 or len(nuisance) != values.size:
        raise ParameterError(
            f"weights {weights.shape} and nuisance {nuisance.shape} do not fit {values.size} values: one row a sample"
        )
    if not (weights >= 0.0).all():
        raise ParameterError("weights are relative inverse variances, never negative or NaN; 0 leaves a sample out")


def _factorise(
    lines: FloatArray, extra: FloatArray, orders: FloatArray, travel: float
) -> tuple[FloatArray, FloatArray]:
    """Orthonormal basis (the other terms' directions, then the lines') and the triangle of the lines' part."""
    directions = np.empty((len(lines), 0))
    if extra.shape[1]:
        norms = np.linalg.norm(extra, axis=0)
        left, sizes, _ = np.linalg.svd(extra / np.where(norms > 0.0, norms, 1.0), full_matrices=False)
        directions = left[:, sizes > DEPENDENT * sizes[0]]
    clean = lines - directions @ (directions.T @ lines)
    own, triangle = np.linalg.qr(clean)
    if np.abs(np.diag(triangle)).min() < DEPENDENT * np.linalg.norm(lines, axis=0).max():
        raise ParameterError(
            f"{np.degrees(travel):.3g}° of travel at this sampling do not tell the orders "
            f"{', '.join(f'{order:g}' for order in orders)} apart, or not from the trend; record a longer motion"
        )
    return np.concatenate([directions, own], axis=1), triangle


def _huber(basis: FloatArray, values: FloatArray, robust: bool) -> tuple[FloatArray, FloatArray, int]:
    """Fitted values, clipped residuals and how many were clipped (Huber's iteration with modified residuals)."""
    fit = basis @ (basis.T @ values)
    residual, outliers = values - fit, 0
    for _ in range(ROUNDS if robust else 0):
        limit = HUBER * float(np.median(np.abs(residual))) / 0.6745
        if limit <= 1e-12 * float(np.abs(values).max()):
            break
        clipped = np.clip(residual, -limit, limit)
        outliers = int(np.count_nonzero(np.abs(residual) > limit))
        step = basis.T @ clipped / max(1.0 - outliers / values.size, 0.5)
        if np.linalg.norm(step) < 1e-6 * limit:
            return fit, clipped, outliers
        fit = fit + basis @ step
        residual = values - fit
    return fit, residual, outliers


def _reference_orders(orders: FloatArray, travel: float, count: int) -> list[tuple[npt.NDArray[np.intp], FloatArray]]:
    """Groups of neighbouring lines, each with the orders around it, one resolution apart, where no line is."""
    resolution = 2.0 * np.pi / travel
    by_order = np.argsort(orders)
    cuts = np.flatnonzero(np.diff(orders[by_order]) > count * resolution) + 1
    groups = []
    for group in np.split(by_order, cuts):
        lowest, highest = float(orders[group].min()), float(orders[group].max())
        reach = min(count, max(3, int(FLOOR_REACH * lowest / resolution))) + 1
        reference = np.arange(lowest - reach * resolution, highest + (reach + 0.5) * resolution, resolution)
        clear = np.abs(np.subtract.outer(reference, orders)).min(axis=1) > 0.99 * resolution
        groups.append((group, reference[clear & (reference > resolution)]))
    return groups

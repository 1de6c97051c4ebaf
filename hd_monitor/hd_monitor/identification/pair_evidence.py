"""What strokes say about one line pair, pooled: amplitudes with covariance, significance, the noise floor beside."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import BSpline
from scipy.stats import f as f_distribution
from scipy.stats import t as t_distribution

from ..reducer import LinePair
from .strokes import HIGHEST_SHARE, Stroke
from .whitening import settled, whiten

FloatArray = npt.NDArray[np.float64]

PLACEBOS = 12
"""Placebo pairs of orders around a pair, one line separation apart: the noise floor is what a fit finds there."""

FLOOR_REACH = 0.15
"""Part of the pair's order within which they stay, five in any case."""

TREND_CYCLES = 5.0
"""Cycles of the first pair between two knots of the trend: a spline of that flexibility cannot follow the lines."""

CLIP = 2.5
"""Robust standard deviations beyond which a residual is clipped."""

CHANCE = 1e-3
"""Probability of noise making a line as large, below which the line counts as found."""

LEAST_FREEDOM = 5.0
"""Degrees of freedom of the noise floor below which there is no estimate."""

NEAR = 6.0
"""Line separations over which the noise floor's weight falls to half: amplitudes that vary show as skirts near by."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PairOrders:
    """Orders [cycles per output revolution] that are fitted or looked at together.

    Attributes
    ----------
    lines : ndarray, shape (2,)
        The circular spline's and the flexspline's.
    nuisance : ndarray
        Lines of the motor, fitted along.
    placebos : ndarray
        Where there is no line.
    trend : float
        Order up to which the trend follows the signal.
    """

    lines: FloatArray
    nuisance: FloatArray
    placebos: FloatArray
    trend: float

    @classmethod
    def around(cls, pair: LinePair, k: int = 1, motor: Iterable[float] = ()) -> "PairOrders":
        """Choose the placebo orders around the k-th multiple of the first `pair`, off it and off the motor's orders."""
        trend = pair.circular_spline / TREND_CYCLES
        pair = LinePair(k * pair.circular_spline, k * pair.flexspline)
        separation = pair.flexspline - pair.circular_spline
        count = max(5, min(PLACEBOS, int(FLOOR_REACH * pair.circular_spline / separation)))
        offsets = separation * np.arange(1.0, count + 1.0)
        placebos = np.concatenate([pair.circular_spline - offsets[::-1], pair.flexspline + offsets])
        others = np.array([order for order in motor if min(abs(order - line) for line in pair) > 1e-6])
        clear = placebos > separation
        for order in others:
            clear &= np.abs(placebos - order) > 0.5 * separation
        return cls(lines=np.array(pair), nuisance=others, placebos=placebos[clear], trend=trend)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Gram:
    """Inner products of a stroke's whitened columns (lines, motor, placebos, signal), in units of its noise.

    Gram matrices of strokes add up to that of all strokes together; nothing else of a stroke need be kept.
    """

    products: FloatArray
    rows: int
    noise: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PairEstimate:
    """A pair of lines in one direction of motion.

    Attributes
    ----------
    phasors : ndarray of complex, shape (2,)
        Circular spline's and flexspline's line, in the signal's unit.
    covariance : ndarray, shape (4, 4)
        Of the two real parts, then the two imaginary parts.
    freedom : float
        Degrees of freedom behind the noise floor.
    floor : float
        Noise power at the placebo orders over that of white noise; above 1 where lines' amplitudes vary.
    noise : float
        Standard deviation of the whitened signal, in its unit.
    rows : int
    explained : float
        Power that the pair explains, in units of the noise floor: 4 by chance.
    rival : float
        Order beside the pair at which there is a significant line larger than both; NaN if there is none.
    """

    phasors: npt.NDArray[np.complex128]
    covariance: FloatArray
    freedom: float
    floor: float
    noise: float
    rows: int
    explained: float
    rival: float

    @property
    def amplitude(self) -> LinePair:
        """Peak amplitudes, in the signal's unit."""
        return LinePair(*np.abs(self.phasors).tolist())

    @property
    def std(self) -> LinePair:
        """Standard deviations of the amplitudes."""
        return LinePair(*np.sqrt(np.diag(self.amplitude_covariance)).tolist())

    @property
    def amplitude_covariance(self) -> FloatArray:
        """Covariance of the two amplitudes, shape (2, 2)."""
        angle = np.angle(self.phasors)
        along = np.concatenate([np.diag(np.cos(angle)), np.diag(np.sin(angle))])
        return np.asarray(along.T @ self.covariance @ along)

    @property
    def chance(self) -> LinePair:
        """Probability that noise alone makes a line this large (F test against the placebo orders)."""
        values = []
        for line in (0, 1):
            index = [line, line + 2]
            parts = np.array([self.phasors[line].real, self.phasors[line].imag])
            ratio = float(parts @ np.linalg.solve(self.covariance[np.ix_(index, index)], parts)) / 2.0
            values.append(float(f_distribution.sf(ratio, 2, self.freedom)))
        return LinePair(*values)

    def dominance(self, ratio: float) -> LinePair:
        """Confidence, one-sided, that each spline's line is larger than the other one's divided by `ratio`."""
        cs, fs = self.amplitude
        covariance = self.amplitude_covariance
        confidence = []
        for weights, excess in (((ratio, -1.0), ratio * cs - fs), ((-1.0, ratio), ratio * fs - cs)):
            w = np.array(weights)
            deviation = float(np.sqrt(max(w @ covariance @ w, 1e-300)))
            confidence.append(float(t_distribution.cdf(excess / deviation, self.freedom)))
        return LinePair(*confidence)


def gram_of_stroke(stroke: Stroke, orders: PairOrders, coefficients: FloatArray) -> Gram | None:
    """Whiten a stroke, take its trend off and sum it up; None if it is too short for that."""
    slow = stroke.speed * orders.lines[-1] <= HIGHEST_SHARE * stroke.rate * 2.0 * np.pi
    good = settled(stroke.starts, coefficients) & slow
    trend = trend_columns(stroke, orders)
    if np.count_nonzero(good) < 2 * (trend.shape[1] + 2 * (orders.lines.size + orders.nuisance.size)):
        return None
    columns = np.concatenate(
        [
            stroke.columns(orders.lines),
            stroke.columns(orders.nuisance),
            stroke.columns(orders.placebos),
            stroke.values[:, None] - stroke.values.mean(),
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


def residual_of_stroke(stroke: Stroke, orders: PairOrders) -> FloatArray:
    """What trend and lines leave of a stroke's signal, shape (rows,): what the whitening is learnt from."""
    columns = [stroke.columns(orders.lines), stroke.columns(orders.nuisance), stroke.values[:, None]]
    columns = project(trend_columns(stroke, orders), np.concatenate(columns, axis=1))
    fit, _ = clipped_fit(columns[:, :-1], columns[:, -1])
    return np.asarray(columns[:, -1] - fit)


def trend_columns(stroke: Stroke, orders: PairOrders) -> FloatArray:
    """Cubic splines in the angle, shape (rows, terms): friction, gravity and the servo's slow work."""
    angle = stroke.angle
    span = float(np.ptp(angle))
    pieces = max(1, round(span * orders.trend / (2.0 * np.pi)))
    knots = np.concatenate([np.zeros(3), np.linspace(0.0, 1.0, pieces + 1), np.ones(3)])
    place = np.clip((angle - angle.min()) / span, 0.0, 1.0) if span > 0.0 else np.zeros(angle.size)
    return np.asarray(BSpline.design_matrix(place, knots, 3).toarray(), dtype=np.float64)


def project(trend: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns less what the trend's columns explain of them."""
    left, sizes, _ = np.linalg.svd(trend, full_matrices=False)
    left = left[:, sizes > 1e-6 * sizes[0]]
    return np.asarray(columns - left @ (left.T @ columns))


def clipped_fit(columns: FloatArray, signal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fit and residual of the columns, the residual clipped by Huber's rule so that spikes lose their pull."""
    basis, _ = np.linalg.qr(columns)
    fit = basis @ (basis.T @ signal)
    residual = signal - fit
    for _ in range(10):
        limit = CLIP * float(np.median(np.abs(residual))) / 0.6745
        clipped = np.clip(residual, -limit, limit)
        step = basis @ (basis.T @ clipped)
        fit = fit + step
        residual = signal - fit
        if float(step @ step) < 1e-8 * float(clipped @ clipped):
            break
    return fit, np.clip(residual, -limit, limit)


def estimate_pair(grams: Sequence[Gram], orders: PairOrders) -> PairEstimate | None:
    """Pool strokes of one direction, coherently in the absolute angle; None if they do not determine the pair."""
    if not grams:
        return None
    total: FloatArray = np.sum(np.stack([gram.products for gram in grams]), axis=0)
    rows = sum(gram.rows for gram in grams)
    fitted = 2 * (orders.lines.size + orders.nuisance.size)
    own, floors = total[:fitted, :fitted], slice(fitted, -1)
    if np.linalg.cond(own) > 1e8:
        return None
    inverse = np.linalg.inv(own)
    # Order of the columns: real parts of the lines, imaginary parts, then the motor's; the last one is the signal.
    solution = inverse @ total[:fitted, -1]
    cross = total[floors, :fitted]
    left = total[floors, floors] - cross @ inverse @ cross.T
    found = total[floors, -1] - cross @ solution
    distance = np.abs(np.subtract.outer(orders.placebos, orders.lines)).min(axis=1) / np.ptp(orders.lines)
    weights = np.tile(1.0 / (1.0 + (distance / NEAR) ** 2), 2)
    trace = float(weights @ np.diag(left))
    floor = float(weights @ found**2) / trace
    freedom = trace**2 / float(weights @ left**2 @ weights)
    if freedom < LEAST_FREEDOM:
        return None
    phasors = solution[:2] + 1j * solution[2:4]
    covariance = inverse[:4, :4] * floor
    noise = float(np.sqrt(rows / sum(gram.rows / gram.noise**2 for gram in grams)))
    return PairEstimate(
        phasors=phasors,
        covariance=covariance,
        freedom=freedom,
        floor=floor,
        noise=noise,
        rows=rows,
        explained=float(solution[:4] @ np.linalg.solve(covariance, solution[:4])),
        rival=_rival(found, np.diag(left), orders.placebos, float(np.abs(phasors).max())),
    )


def _rival(found: FloatArray, own: FloatArray, orders: FloatArray, largest: float) -> float:
    """Order of a line among the placebo orders that is larger than the pair's and no accident; NaN if there is none."""
    power = (found**2).reshape(2, -1).sum(axis=0)
    size = own.reshape(2, -1).sum(axis=0)
    best = int(np.argmax(power / size))
    rest = np.arange(orders.size) != best
    ratio = float(power[best] / size[best] / (power[rest].sum() / size[rest].sum()))
    by_chance = orders.size * float(f_distribution.sf(ratio, 2, 2 * (orders.size - 1)))
    amplitude = 2.0 * float(np.sqrt(power[best])) / float(size[best])
    return float(orders[best]) if by_chance < CHANCE and amplitude > largest else float("nan")

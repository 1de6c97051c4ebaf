"""What segments say about one line pair, pooled: amplitudes with covariance, significance, the noise floor beside."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import f as f_distribution
from scipy.stats import t as t_distribution

from ..arrays import ComplexArray, FloatArray
from ..reducer import LinePair
from .gram import Gram, PairOrders

CHANCE = 1e-3
"""Probability of noise making a line as large, below which the line counts as found."""

LEAST_FREEDOM = 5.0
"""Degrees of freedom of the noise floor below which there is no estimate."""

NEAR = 6.0
"""Line separations over which the noise floor's weight falls to half: amplitudes that vary show as skirts near by."""


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
        Noise power at the reference orders over that of white noise; above 1 where lines' amplitudes vary.
    noise : float
        Standard deviation of the whitened signal, in its unit.
    rows : int
    explained : float
        Power that the pair explains, in units of the noise floor: 4 by chance.
    rival : float or None
        Order beside the pair at which there is a significant line larger than both; None if there is none.
    """

    phasors: ComplexArray
    covariance: FloatArray
    freedom: float
    floor: float
    noise: float
    rows: int
    explained: float
    rival: float | None

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
    def log_evidence(self) -> float:
        """Logarithm of the likelihood ratio against noise alone, less a penalty for the number of lines (BIC)."""
        return _log_evidence(self.explained, self.freedom, self.phasors.size)

    @property
    def chance(self) -> LinePair:
        """Probability that noise alone makes a line this large (F test against the reference orders)."""
        return LinePair(*line_chances(self))

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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LineSolution:
    """Lines fitted from sums: phasors, their covariance (real parts, then imaginary ones), and the floor behind it.

    `explained` is the power they explain in units of the floor; `left` and `found` are the reference columns' products
    with each other and with the signal, once the fit is taken off.
    """

    phasors: ComplexArray
    covariance: FloatArray
    floor: float
    freedom: float
    explained: float
    left: FloatArray
    found: FloatArray

    @property
    def log_evidence(self) -> float:
        """Logarithm of the likelihood ratio against noise alone, less a penalty for the number of lines (BIC)."""
        return _log_evidence(self.explained, self.freedom, self.phasors.size)


def _log_evidence(explained: float, freedom: float, lines: int) -> float:
    """Likelihood ratio's logarithm, the noise floor being unknown, less the penalty for two parameters a line."""
    parameters = 2 * lines
    total = freedom + parameters
    return 0.5 * total * math.log1p(explained / freedom) - 0.5 * parameters * math.log(total)


def solve_lines(products: FloatArray, orders: PairOrders) -> LineSolution | None:
    """Fit the lines of `orders`, one or several, from their Gram matrix; None if it does not determine them."""
    lines = orders.lines.size
    fitted = 2 * (lines + orders.nuisance.size)
    own, floors = products[:fitted, :fitted], slice(fitted, -1)
    if np.diag(own).min() <= 0.0 or not np.linalg.cond(own) < 1e8:
        return None
    inverse = np.linalg.inv(own)
    # Order of the columns: real parts of the lines, imaginary parts, then the motor's; the last one is the signal.
    solution = inverse @ products[:fitted, -1]
    cross = products[floors, :fitted]
    left = products[floors, floors] - cross @ inverse @ cross.T
    found = products[floors, -1] - cross @ solution
    distance = np.abs(np.subtract.outer(orders.reference_orders, orders.lines)).min(axis=1) / orders.separation
    weights = np.tile(1.0 / (1.0 + (distance / NEAR) ** 2), 2)
    trace = float(weights @ np.diag(left))
    if not trace > 0.0:
        return None
    floor = float(weights @ found**2) / trace
    freedom = trace**2 / float(weights @ left**2 @ weights)
    if freedom < LEAST_FREEDOM or not floor > 0.0:
        return None
    covariance = inverse[: 2 * lines, : 2 * lines] * floor
    parts = solution[: 2 * lines]
    return LineSolution(
        phasors=parts[:lines] + 1j * parts[lines:],
        covariance=covariance,
        floor=floor,
        freedom=freedom,
        explained=float(parts @ np.linalg.solve(covariance, parts)),
        left=left,
        found=found,
    )


def estimate_pair(grams: Sequence[Gram], orders: PairOrders) -> PairEstimate | None:
    """Pool segments of one direction, coherently in the absolute angle; None if they do not determine the pair."""
    if not grams:
        return None
    total: FloatArray = np.sum(np.stack([gram.products for gram in grams]), axis=0)
    fit = solve_lines(total, orders)
    if fit is None:
        return None
    rows = sum(gram.rows for gram in grams)
    return PairEstimate(
        phasors=fit.phasors,
        covariance=fit.covariance,
        freedom=fit.freedom,
        floor=fit.floor,
        noise=float(np.sqrt(rows / sum(gram.rows / gram.noise**2 for gram in grams))),
        rows=rows,
        explained=fit.explained,
        rival=_rival(fit, orders.reference_orders),
    )


def line_chances(fit: LineSolution | PairEstimate) -> tuple[float, ...]:
    """Probability, for each line, that noise alone makes it this large (F test against the reference orders)."""
    lines, chances = fit.phasors.size, []
    for line in range(lines):
        index = [line, line + lines]
        parts = np.array([fit.phasors[line].real, fit.phasors[line].imag])
        ratio = float(parts @ np.linalg.solve(fit.covariance[np.ix_(index, index)], parts)) / 2.0
        chances.append(float(f_distribution.sf(ratio, 2, fit.freedom)))
    return tuple(chances)


def _rival(fit: LineSolution, orders: FloatArray) -> float | None:
    """Order of a line among the reference orders that is larger than the pair's and no accident; None without one."""
    power = (fit.found**2).reshape(2, -1).sum(axis=0)
    size = np.diag(fit.left).reshape(2, -1).sum(axis=0)
    best = int(np.argmax(np.where(size > 0.0, power / np.where(size > 0.0, size, 1.0), 0.0)))
    rest = np.arange(orders.size) != best
    if not power[rest].any():
        return None
    ratio = float(power[best] / size[best] / (power[rest].sum() / size[rest].sum()))
    by_chance = orders.size * float(f_distribution.sf(ratio, 2, 2 * (orders.size - 1)))
    larger = 2.0 * float(np.sqrt(power[best])) / float(size[best]) > float(np.abs(fit.phasors).max())
    return float(orders[best]) if by_chance < CHANCE and larger else None

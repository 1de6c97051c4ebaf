"""How probable each component and each cause is, given the readings with their joint uncertainty."""

import functools
from typing import NamedTuple

import numpy as np
import scipy

from ..arrays import FloatArray
from ..identification.result import Identification
from ..reducer import LinePair
from ..settings import DiagnosisSettings
from .verdict import Cause, Component

_DRAWS = 4096
_INDEPENDENT = 0.999  # correlations nearer to 1 are cut, so that the two indexes never merge into one


class Probabilities(NamedTuple):
    """Probability of each component; they add up to 1."""

    none: float
    circular_spline: float
    flexspline: float
    both: float

    def of(self, component: Component) -> float:
        """Return the probability of one of the four components."""
        return float(getattr(self, component.value))


def name_component(index: LinePair, limit: float, both_ratio: float) -> Component:
    """Name the component that the severity of both splines calls for, were it exact.

    ``none`` while both are below the limit; otherwise the larger one, or ``both`` where the smaller is above the
    limit too and at least `both_ratio` of the larger.
    """
    smaller, larger = sorted(index)
    if larger < limit:
        return Component.NONE
    if smaller >= limit and smaller >= both_ratio * larger:
        return Component.BOTH
    return Component.CIRCULAR_SPLINE if index.circular_spline > index.flexspline else Component.FLEXSPLINE


def severity(evidence: Identification, limits: DiagnosisSettings) -> LinePair:
    """Worse reading of each spline as a stiffness index: a transmission error counts by its part of the warn limit."""
    if evidence.transmission_error is None:
        return evidence.index
    errors = _scaled(evidence.transmission_error, limits)
    return LinePair(*map(max, evidence.index, errors))


def component_probabilities(evidence: Identification, limits: DiagnosisSettings, limit: float) -> Probabilities:
    """Probability of each component, given the evidence and the limit [index] in force."""
    return _shares(_distribution(evidence, limits), limit, limits.both_ratio)


def index_probabilities(evidence: Identification, limits: DiagnosisSettings, limit: float) -> Probabilities:
    """Probability of each component by the stiffness indexes alone."""
    return _shares(_of_indexes(evidence), limit, limits.both_ratio)


def beyond(evidence: Identification, limits: DiagnosisSettings, limit: float) -> LinePair:
    """Probability that a spline's index or its transmission error is beyond the limit [index] in force."""
    return LinePair(*((_draws(_distribution(evidence, limits)) >= limit).any(axis=0).mean(axis=1).tolist()))


def find_cause(evidence: Identification, limits: DiagnosisSettings, limit: float) -> Cause:
    """Tell which reading of the worse spline exceeds the limit [index] in force, as surely as a part must be named."""
    if evidence.transmission_error is None:
        return Cause.STIFFNESS
    errors = _scaled(evidence.transmission_error, limits)
    spline = int(np.argmax(severity(evidence, limits)))
    stiffness, error = _exceeding(_distribution(evidence, limits), limit, spline)
    if max(stiffness, error) < limits.confidence:
        return Cause.EITHER
    return Cause.STIFFNESS if evidence.index[spline] >= errors[spline] else Cause.TRANSMISSION_ERROR


class _Distribution(NamedTuple):
    """Readings as stiffness indexes: both splines' indexes, then their transmission errors if there are any."""

    size: tuple[float, ...]
    std: tuple[float, ...]
    correlation: tuple[tuple[float, ...], ...]


def _scaled(error: LinePair, limits: DiagnosisSettings) -> tuple[float, float]:
    scale = limits.warn_index / limits.warn_transmission_error
    return scale * error.circular_spline, scale * error.flexspline


def _distribution(evidence: Identification, limits: DiagnosisSettings) -> _Distribution:
    error, std, correlation = evidence.transmission_error, evidence.transmission_error_std, evidence.correlation
    if error is None or std is None or correlation is None:
        return _of_indexes(evidence)
    return _Distribution(
        (*evidence.index, *_scaled(error, limits)),
        (*evidence.index_std, *_scaled(std, limits)),
        tuple(map(tuple, correlation.tolist())),
    )


def _of_indexes(evidence: Identification) -> _Distribution:
    r = evidence.index_correlation
    return _Distribution(tuple(evidence.index), tuple(evidence.index_std), ((1.0, r), (r, 1.0)))


@functools.lru_cache(maxsize=16)  # the evidence often stays the same from one period to the next
def _shares(readings: _Distribution, limit: float, both_ratio: float) -> Probabilities:
    """Share of the readings' joint distribution that calls for each component."""
    cs, fs = _draws(readings).max(axis=0)
    larger, smaller = np.maximum(cs, fs), np.minimum(cs, fs)
    named = larger >= limit
    both = named & (smaller >= limit) & (smaller >= both_ratio * larger)
    single = named & ~both
    counts = (~named).sum(), (single & (cs > fs)).sum(), (single & (cs <= fs)).sum(), both.sum()
    return Probabilities(*(float(count) / cs.size for count in counts))


@functools.lru_cache(maxsize=16)
def _exceeding(readings: _Distribution, limit: float, spline: int) -> tuple[float, float]:
    """Probabilities that the index and the transmission error of a spline exceed the limit."""
    stiffness, error = (_draws(readings)[:, spline] >= limit).mean(axis=1)
    return float(stiffness), float(error)


def _draws(readings: _Distribution) -> FloatArray:
    """Draws of the joint distribution (Gaussian, cut at 0), shape (kinds of reading, splines, draws).

    They are a fixed low-discrepancy set of points, so the same evidence always gives the same probabilities, to about
    1e-3.
    """
    size, std, correlation = readings
    cut = np.clip(correlation, -_INDEPENDENT, _INDEPENDENT)
    np.fill_diagonal(cut, 1.0)
    values, vectors = np.linalg.eigh(cut)
    if values[0] <= 0.0:  # several correlations near 1 need not agree with each other
        cut = (vectors * np.maximum(values, 1.0 - _INDEPENDENT)) @ vectors.T
        cut /= np.sqrt(np.outer(cut.diagonal(), cut.diagonal()))
    normal = np.linalg.cholesky(cut) @ _standard_normal(len(size))
    draws = np.asarray(size)[:, None] + np.asarray(std)[:, None] * normal
    return np.maximum(draws, 0.0).reshape(-1, 2, _DRAWS)


@functools.cache
def _standard_normal(dimensions: int) -> FloatArray:
    """Independent standard normal coordinates of an additive-recurrence point set, shape (dimensions, draws)."""
    ratio = float(
        scipy.optimize.brentq(lambda x: x ** (dimensions + 1) - x - 1.0, 1.0, 2.0, xtol=1e-15)
    )  # the plastic number for 2
    n = np.arange(_DRAWS) + 0.5
    return np.stack([scipy.special.ndtri(np.mod(n / ratio**power, 1.0)) for power in range(1, dimensions + 1)])

"""How probable each component is, given two indexes with their joint uncertainty."""

import functools
import math
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from ..arrays import FloatArray
from ..identification.result import Identification
from ..reducer import LinePair
from .verdict import Component

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
    """Name the component that two indexes call for, were they exact.

    ``none`` while both are below the limit; otherwise the larger one, or ``both`` where the smaller is above the
    limit too and at least `both_ratio` of the larger.
    """
    smaller, larger = sorted(index)
    if larger < limit:
        return Component.NONE
    if smaller >= limit and smaller >= both_ratio * larger:
        return Component.BOTH
    return Component.CIRCULAR_SPLINE if index.circular_spline > index.flexspline else Component.FLEXSPLINE


def component_probabilities(evidence: Identification, limit: float, both_ratio: float) -> Probabilities:
    """Probability of each component, given the evidence and the limits in force; see :func:`_share`."""
    return _share(evidence.index, evidence.index_std, evidence.index_correlation, limit, both_ratio)


@functools.lru_cache(maxsize=16)  # the evidence often stays the same from one period to the next
def _share(index: LinePair, index_std: LinePair, correlation: float, limit: float, both_ratio: float) -> Probabilities:
    """Share of the indexes' joint distribution (Gaussian, cut at 0) that calls for each component.

    The integral is a sum over a fixed low-discrepancy set of points, so the same evidence always gives the same
    probabilities, to about 1e-3.
    """
    first, second = _standard_normal()
    r = min(max(correlation, -_INDEPENDENT), _INDEPENDENT)
    cs = index.circular_spline + index_std.circular_spline * first
    fs = index.flexspline + index_std.flexspline * (r * first + math.sqrt(1.0 - r * r) * second)
    cs, fs = np.maximum(cs, 0.0), np.maximum(fs, 0.0)
    larger, smaller = np.maximum(cs, fs), np.minimum(cs, fs)
    named = larger >= limit
    both = named & (smaller >= limit) & (smaller >= both_ratio * larger)
    single = named & ~both
    counts = (~named).sum(), (single & (cs > fs)).sum(), (single & (cs <= fs)).sum(), both.sum()
    return Probabilities(*(float(count) / first.size for count in counts))


@functools.cache
def _standard_normal() -> tuple[FloatArray, FloatArray]:
    """Two independent standard normal coordinates of an additive-recurrence (R2) point set."""
    plastic = 1.324717957244746
    n = np.arange(_DRAWS) + 0.5
    return ndtri(np.mod(n / plastic, 1.0)), ndtri(np.mod(n / plastic**2, 1.0))

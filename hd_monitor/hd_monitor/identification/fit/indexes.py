"""From phasors to a size for each spline, with the bias that noise brings removed and their joint uncertainty."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ...arrays import FloatArray
from ...reducer import LinePair
from .unknowns import Unknowns

_EXPLAINED = 2.7
"""Standard deviations that noise alone seldom (in 2.5 %) lifts the square of an index to: 2.4 to 2.8 by its freedom."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Indexes:
    """Root-sum-square β of both splines, their standard deviations and the correlation of the two."""

    index: LinePair
    std: LinePair
    correlation: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Errors:
    """Transmission errors [arcmin peak to peak] of both splines, and their standard deviations.

    `correlation`, shape (4, 4), is that of the errors of estimation of both indexes and both transmission errors, the
    circular spline's first.
    """

    size: LinePair
    std: LinePair
    correlation: FloatArray


def stiffness_indexes(
    unknowns: Unknowns, values: FloatArray, covariance: FloatArray, systematic: FloatArray | None = None
) -> Indexes:
    """Stiffness indexes: the sizes of Gaussian β; for the parameters see :func:`sizes_of`."""
    size, std, correlation = sizes_of((unknowns.circular_spline, unknowns.flexspline), values, covariance, systematic)
    return Indexes(index=LinePair(*size), std=LinePair(*std), correlation=float(correlation[0, 1]))


def transmission_errors(
    unknowns: Unknowns, values: FloatArray, covariance: FloatArray, systematic: FloatArray | None = None
) -> Errors | None:
    """Transmission errors of both splines; None where none are fitted. For the parameters see :func:`sizes_of`."""
    if not unknowns.transmission_error:
        return None
    stiffness = (unknowns.circular_spline, unknowns.flexspline)
    errors = (unknowns.circular_spline_error, unknowns.flexspline_error)
    size, std, correlation = sizes_of((*stiffness, *errors), values, covariance, systematic)
    return Errors(size=LinePair(*size[2:]), std=LinePair(*std[2:]), correlation=correlation)


def sizes_of(
    parts: Sequence[slice], values: FloatArray, covariance: FloatArray, systematic: FloatArray | None = None
) -> tuple[list[float], list[float], FloatArray]:
    """Sizes of the Gaussian phasors of some parts, their standard deviations and correlation matrix.

    Parameters
    ----------
    parts : sequence of slice
        Places of each part's phasors among the unknowns.
    values : ndarray, shape (unknowns,)
    covariance : ndarray, shape (unknowns, unknowns)
        Of the errors by noise, which lift the sum of the squares.
    systematic : ndarray or None, shape (unknowns, unknowns)
        Covariance of further errors, which widen the uncertainty but do not lift the sum: what the data leave to the
        prior, as lines that the sensor does not hear, and what the model leaves out.

    Notes
    -----
    For an estimate z of phasors β with covariance C, ``|z|² - tr C`` estimates |β|² without bias, and
    ``4 z·C z - 2 tr C²`` the variance of that. Further errors of covariance F add their mean square about |z|²,
    ``4 z·F z + 2 tr F² + (tr F)²``. The size is the root, 0 where it is negative. Its standard deviation
    is the usual one far from zero; near zero it is taken such that the size plus its standard deviation is the root
    of |β|² plus *its* standard deviation, and that the 95 % interval holds 0 as long as noise alone explains |β|².
    """
    z = [values[part] for part in parts]
    further = np.zeros_like(covariance) if systematic is None else systematic
    sizes, std, spread = [], [], []
    for own_z, part in zip(z, parts, strict=True):
        own = covariance[part, part]
        square = max(float(own_z @ own_z) - float(np.trace(own)), 0.0)
        noise = 2.0 * float(np.sum(own * own))
        variance = max(4.0 * float(own_z @ own @ own_z) - noise, noise)
        wide = further[part, part]
        variance += 4.0 * float(own_z @ wide @ own_z) + 2.0 * float(np.sum(wide * wide)) + float(np.trace(wide)) ** 2
        root, deviation = math.sqrt(square), math.sqrt(variance)
        sizes.append(root)
        spread.append(deviation)
        # 2 root std + std² = deviation has this solution; it tends to deviation / (2 root)
        size = deviation / (root + math.sqrt(square + deviation)) if deviation > 0.0 else 0.0
        std.append(max(size, root / 1.96) if square < _EXPLAINED * math.sqrt(noise) else size)
    correlation = np.eye(len(parts))
    for (i, a), (j, b) in combinations(enumerate(parts), 2):
        product = spread[i] * spread[j]
        joint = 4.0 * float(z[i] @ (covariance[a, b] + further[a, b]) @ z[j])
        correlation[i, j] = correlation[j, i] = np.clip(joint / product, -1.0, 1.0) if product > 0.0 else 0.0
    return sizes, std, correlation

"""From β phasors to the two splines' indexes, with the bias that noise brings removed and their joint uncertainty."""

import math
from dataclasses import dataclass

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


def stiffness_indexes(
    unknowns: Unknowns, values: FloatArray, covariance: FloatArray, systematic: FloatArray | None = None
) -> Indexes:
    """Indexes of Gaussian β.

    Parameters
    ----------
    unknowns : Unknowns
    values : ndarray, shape (unknowns,)
    covariance : ndarray, shape (unknowns, unknowns)
        Of the errors by noise, which lift the sum of the squares.
    systematic : ndarray or None, shape (unknowns, unknowns)
        Covariance of further errors, which widen the uncertainty but of whose sign nothing is known.

    Returns
    -------
    Indexes

    Notes
    -----
    For an estimate z of β with covariance C, ``|z|² - tr C`` estimates |β|² without bias, and
    ``4 z·C z - 2 tr C²`` the variance of that. The index is its root, 0 where it is negative. Its standard deviation
    is the usual one far from zero; near zero it is taken such that the index plus its standard deviation is the root
    of |β|² plus *its* standard deviation, and that the 95 % interval holds 0 as long as noise alone explains |β|².
    """
    parts = unknowns.circular_spline, unknowns.flexspline
    z = [values[part] for part in parts]
    c = [[covariance[a, b] for b in parts] for a in parts]
    further = np.zeros_like(covariance) if systematic is None else systematic
    s = [[further[a, b] for b in parts] for a in parts]
    index, std, spread = [], [], []
    for i in range(2):
        own = c[i][i]
        square = max(float(z[i] @ z[i]) - float(np.trace(own)), 0.0)
        noise = 2.0 * float(np.sum(own * own))
        variance = max(4.0 * float(z[i] @ own @ z[i]) - noise, noise) + 4.0 * float(z[i] @ s[i][i] @ z[i])
        root, deviation = math.sqrt(square), math.sqrt(variance)
        index.append(root)
        spread.append(deviation)
        # 2 root std + std² = deviation has this solution; it tends to deviation / (2 root)
        size = deviation / (root + math.sqrt(square + deviation)) if deviation > 0.0 else 0.0
        std.append(max(size, root / 1.96) if square < _EXPLAINED * math.sqrt(noise) else size)
    product = spread[0] * spread[1]
    joint = 4.0 * float(z[0] @ (c[0][1] + s[0][1]) @ z[1])
    correlation = float(np.clip(joint / product, -1.0, 1.0)) if product > 0.0 else 0.0
    return Indexes(index=LinePair(*index), std=LinePair(*std), correlation=correlation)

"""Orthonormal directions: used to remove from signals what they share with others."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray

_DEPENDENT = 1e-10  # of the largest square below which a direction is nothing but rounding


def orthonormal(columns: npt.NDArray[np.floating[Any]]) -> FloatArray:
    """Return orthonormal directions that span the columns, shape (samples, directions); dependent columns give fewer.

    They follow from the columns' products with each other, at a fraction of what a decomposition of the columns takes.
    """
    scaled = columns / (np.linalg.norm(columns, axis=0) + 1e-300)
    squares, directions = np.linalg.eigh(scaled.T @ scaled)
    kept = squares > _DEPENDENT * squares[-1]
    return np.asarray(scaled @ (directions[:, kept] / np.sqrt(squares[kept])))


def project(trend: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns, shape (samples, columns), less what the trend's columns explain of them."""
    directions = orthonormal(trend)
    return np.asarray(columns - directions @ (directions.T @ columns))

"""Whitening of a signal's background by a short autoregressive filter, learnt from the signal itself."""

from collections.abc import Sequence

import numpy as np
import scipy

from ..arrays import BoolArray, FloatArray
from ..robust import clip

TAPS = 8
"""Samples that the filter looks back: enough for servo noise, few enough to lose little at a segment's start."""

CLIP = 3.0
"""Robust standard deviations beyond which a residual is clipped."""


def learn_whitening(residuals: Sequence[FloatArray], taps: int = TAPS) -> FloatArray:
    """Learn the prediction-error filter of the background that the residuals show.

    Parameters
    ----------
    residuals : sequence of ndarray
        Segments of signal without lines and trends; each counts by its length, whatever its level.
    taps : int
        Order of the autoregression.

    Returns
    -------
    ndarray, shape (taps + 1,)
        Filter coefficients, the first one 1 (Yule-Walker equations, so that the background's model is stable).
    """
    covariance = np.zeros(taps + 1)
    for residual in residuals:
        if residual.size <= 2 * taps:
            continue
        calm = clip(residual, CLIP)
        power = float(calm @ calm)
        if power > 0.0:
            covariance += [calm.size / power * float(calm[lag:] @ calm[: calm.size - lag]) for lag in range(taps + 1)]
    if covariance[0] <= 0.0:
        return np.concatenate([[1.0], np.zeros(taps)])
    covariance[0] *= 1.0 + 1e-6
    return np.concatenate([[1.0], -np.asarray(scipy.linalg.solve_toeplitz(covariance[:-1], covariance[1:]))])


def whiten(coefficients: FloatArray, columns: FloatArray) -> FloatArray:
    """Filter every column, shape (rows, columns); rows that look back over a start are to be left out."""
    return np.asarray(scipy.signal.lfilter(coefficients, [1.0], columns, axis=0), dtype=np.float64)


def settled(starts: BoolArray, coefficients: FloatArray) -> BoolArray:
    """Rows, shape (rows,), whose filter looks back on contiguous rows only, where a run begins at every start."""
    row = np.arange(starts.size)
    begin = np.maximum.accumulate(np.where(starts, row, 0))
    return np.asarray(row - begin >= coefficients.size - 1)

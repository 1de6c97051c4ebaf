"""Spread and clipping that a few outliers do not change."""

import numpy as np

from .arrays import FloatArray

PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over the median of its magnitude, 1 / Φ⁻¹(3/4)."""


def robust_std(values: FloatArray) -> float:
    """Estimate the standard deviation of zero-mean values by their median magnitude.

    Parameters
    ----------
    values : ndarray, shape (N,)
        Finite, N ≥ 1; any unit.

    Returns
    -------
    float
        In the same unit; 0 where more than half of the values are 0.

    Examples
    --------
    >>> import numpy as np
    >>> round(robust_std(np.array([-1.0, 1.0, 2.0, -0.5, 1e6])), 4)
    1.4826
    """
    return PER_MEDIAN * float(np.median(np.abs(values)))


def clip(values: FloatArray, deviations: float) -> FloatArray:
    """Limit zero-mean values, shape (N,), to so many robust standard deviations; unchanged where these are 0."""
    limit = deviations * robust_std(values)
    return np.asarray(np.clip(values, -limit, limit)) if limit > 0.0 else values

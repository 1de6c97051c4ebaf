"""The speed at which an identified reducer becomes parametrically unstable."""

import math

import numpy as np
import scipy

from .parameters import ParametricModel
from .stability import growth_rate

_THRESHOLD = 4.0  # of a single β over ζ, at its principal tongue
_SAFETY = 0.85  # part of that threshold below which the sum of the two splines' β is harmless
_SECOND_TONGUE = 2.0  # of the sum of all β over the root of ζ; the second tongue of a single β opens at 2.8
_ACCURACY = 2e-3  # of the speed


def critical_speed(model: ParametricModel) -> float:
    """Lowest wave-generator speed [rpm] at which free vibration grows; inf if there is none.

    Tongues of instability open where a stiffness line, k times the order of a spline, is at 2 fn / m (section 3.4 of
    Gu et al. 2021: the principal instability is m = 1, k = 1). Each that can open at all is searched for its most
    unstable speed, and then for its lower edge.
    """
    pairs = np.zeros(model.harmonics)
    for series in (model.circular_spline, model.flexspline):
        pairs[: len(series.beta)] += np.abs(series.beta)
    total, damping = float(pairs.sum()), model.dynamics.damping_ratio
    centres = [
        2.0 * model.dynamics.natural_frequency / k
        for k, pair in enumerate(pairs.tolist(), start=1)
        if pair + total**2 > _SAFETY * _THRESHOLD * damping
    ]
    if total > _SECOND_TONGUE * math.sqrt(damping):
        centres += [model.dynamics.natural_frequency / k for k in range(1, pairs.size + 1)]
    slow, fast = 60.0 / model.reducer.flexspline_order, 60.0 / model.reducer.circular_spline_order
    width = 0.5 * total
    return min(
        (_lower_edge(model, c * slow * (1.0 - width), c * fast * (1.0 + width)) for c in sorted(set(centres))),
        default=math.inf,
    )


def _lower_edge(model: ParametricModel, lowest: float, highest: float) -> float:
    """Lowest unstable speed between two speeds [rpm]; inf if there is none."""
    peak = scipy.optimize.minimize_scalar(
        lambda speed: -growth_rate(model, speed),
        bounds=(lowest, highest),
        method="bounded",
        options={"xatol": _ACCURACY * lowest},
    )
    if peak.fun >= 0.0:
        return math.inf
    stable, unstable = lowest, float(peak.x)
    while unstable - stable > _ACCURACY * unstable:
        middle = 0.5 * (stable + unstable)
        if growth_rate(model, middle) > 0.0:
            unstable = middle
        else:
            stable = middle
    return unstable

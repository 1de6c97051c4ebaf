"""The identified quantities as numbers with standard deviations and confidence intervals."""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.stats import ncx2, norm

from ..arrays import ComplexArray, FloatArray
from ..identification.fit.indexes import stiffness_indexes
from ..identification.fit.unknowns import Unknowns
from ..identification.result import Identification
from ..settings import Uncertainty

CONFIDENCE = 0.95
"""Probability with which an interval holds the true value."""

LEARNT = 0.5
"""Standard deviation, as a part of the one given, below which the motion determines a value."""

_WIDTH = float(norm.ppf(0.5 + 0.5 * CONFIDENCE))
_CLEAR = 20.0
"""Deviations above zero from which a magnitude's error is Gaussian."""
_ONE = Unknowns(harmonics=1, load_orders=())


class Estimate(NamedTuple):
    """A value, its standard deviation and its 95 % confidence interval, in the value's unit; NaN where unknown."""

    value: float
    std: float
    low: float
    high: float

    @classmethod
    def gaussian(cls, value: float, std: float) -> "Estimate":
        """Estimate of a quantity that is never negative, with a Gaussian error."""
        low = value - _WIDTH * std
        return cls(value, std, 0.0 if low < 0.0 else low, value + _WIDTH * std)

    @classmethod
    def lognormal(cls, value: float, std: float) -> "Estimate":
        """Estimate whose logarithm has a Gaussian error, as fn and ζ."""
        factor = math.exp(_WIDTH * std / value) if value > 0.0 else math.nan
        return cls(value, std, value / factor, value * factor)


class Harmonic(NamedTuple):
    """One β of one spline."""

    k: int
    beta: Estimate
    """Magnitude, a fraction of the mean stiffness, bias from noise removed."""
    phase: float
    """Where the output angle is 0 [rad]; NaN where noise hides it."""
    phase_std: float
    """[rad]"""


def harmonics(found: Identification) -> dict[str, list[Harmonic]]:
    """Magnitude and phase of every identified β, by the spline's name: ``circular_spline`` and ``flexspline``."""

    def of(spline: int, phasors: ComplexArray) -> list[Harmonic]:
        own = [None] * len(phasors) if found.beta_covariance is None else found.beta_covariance[spline]
        return [_harmonic(k, complex(z), c) for k, (z, c) in enumerate(zip(phasors, own, strict=True), start=1)]

    return {"circular_spline": of(0, found.circular_spline), "flexspline": of(1, found.flexspline)}


def magnitude_interval(size: float, std: float) -> tuple[float, float]:
    """Confidence interval of the magnitude of a phasor, exact where its two parts have equal deviations.

    Parameters
    ----------
    size : float
        Magnitude of the estimated phasor, noise included.
    std : float
        Standard deviation of the estimate along the phasor, in the same unit.

    Notes
    -----
    ``(size / std)²`` has the noncentral χ² distribution of two degrees of freedom around the true ``(β / std)²``; the
    bounds are where it leaves half of what is missing from `CONFIDENCE` on either side. Near zero a Gaussian interval
    would hold the truth too seldom.
    """
    if not std > 0.0:
        return size, size
    ratio = size / std
    if not ratio < _CLEAR:
        return size - _WIDTH * std, size + _WIDTH * std

    def bound(share: float) -> float:
        def excess(true: float) -> float:
            return float(ncx2.cdf(ratio**2, 2, max(true, 1e-9) ** 2)) - share

        return float(brentq(excess, 0.0, ratio + 10.0)) * std if excess(0.0) > 0.0 else 0.0

    return bound(0.5 + 0.5 * CONFIDENCE), max(bound(0.5 - 0.5 * CONFIDENCE), std)


def _harmonic(k: int, phasor: complex, covariance: FloatArray | None) -> Harmonic:
    phase = math.atan2(phasor.imag, phasor.real)
    if covariance is None:
        return Harmonic(k, Estimate.gaussian(abs(phasor), math.nan), phase, math.nan)
    size = abs(phasor)
    along, across = np.array([phasor.real, phasor.imag]), np.array([-phasor.imag, phasor.real])
    radial = math.sqrt(float(along @ covariance @ along)) / size if size > 0.0 else 0.0
    values, whole = _ONE.zero(), np.zeros((_ONE.size, _ONE.size))
    values[_ONE.circular_spline] = phasor.real, phasor.imag
    # What lies across the phasor beyond that is the clocks' lag, which turns it
    whole[_ONE.circular_spline, _ONE.circular_spline] = radial**2 * np.eye(2)
    magnitude = stiffness_indexes(_ONE, values, whole)
    beta = Estimate(magnitude.index.circular_spline, magnitude.std.circular_spline, *magnitude_interval(size, radial))
    std = math.sqrt(float(across @ covariance @ across)) / size**2 if size > 0.0 else math.inf
    if not std < 0.5:  # beyond, the error of a phase is no longer Gaussian, and soon it says nothing
        phase = std = math.nan
    return Harmonic(k, beta, phase, std)


def dynamics(found: Identification, given: Uncertainty) -> dict[str, tuple[Estimate, bool]]:
    """Natural frequency [Hz] and damping ratio by their parameters' names, and whether the motion determines them."""
    before = {"natural_frequency": given.natural_frequency, "damping_ratio": given.damping}
    estimates = {name: Estimate.lognormal(getattr(found, name), getattr(found, f"{name}_std")) for name in before}
    return {
        name: (value, not found.blockers and 0.0 < value.std < LEARNT * before[name] * value.value)
        for name, value in estimates.items()
    }

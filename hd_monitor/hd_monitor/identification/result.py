"""What identification hands to diagnosis: the defect indexes of both splines with their uncertainty."""

import functools
import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ..arrays import ComplexArray, FloatArray
from ..limitation import Limitation, LimitationCode
from ..model.critical_speed import critical_speed
from ..model.parameters import ParametricModel
from ..reducer import LinePair
from .checks.something_else import SomethingElse
from .fit.gauss_newton import FitStatus
from .sensorless.agreement import DirectionEvidence
from .sensorless.torque_share import TorqueShare

VAGUE = 0.2
"""Standard deviation of an index over its limit from which it is not known well."""


MOST_UNEXPLAINED = 0.2
"""Amplitude left at the lines, over that explained, beyond which the explanation is not to be trusted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LineEstimate:
    """The k-th line pair as measured: amplitudes of the vibration signal, and their standard deviations.

    The unit is the signal's: rad/s² for accelerations, N·m or A for efforts, rad/s for velocities.
    """

    k: int
    amplitude: LinePair
    std: LinePair


@dataclass(frozen=True, slots=True, kw_only=True)
class Identification:
    """Stiffness indexes of the two splines, jointly Gaussian as far as the data tells.

    Attributes
    ----------
    circular_spline, flexspline : ndarray of complex, shape (harmonics,)
        Phasors βk·exp(j phase), fractions of the mean stiffness; relative ones if `relative`.
    beta_covariance : ndarray or None, shape (2, harmonics, 2, 2)
        Covariance of the real and the imaginary part of every β, the circular spline's first; None where the indexes
        are relative for want of a transfer function (sensorless).
    index : LinePair
        Root-sum-square of the β of each spline (bias from noise removed), fractions, never negative.
    index_std : LinePair
        Their standard deviations.
    index_correlation : float
        Correlation of the two indexes' errors, -1 to 1: near ±1 when the travel hardly separates the lines.
    transmission_error, transmission_error_std : LinePair or None
        Transmission error of each spline [arcmin peak to peak], its harmonics' root-sum-square, and its standard
        deviation; None where none is fitted along.
    correlation : ndarray or None, shape (4, 4)
        Correlation of the errors of both indexes and both transmission errors, the circular spline's first.
    relative : bool
        True if the transmitted torque (or the transfer function) is unknown: then only the ratio of the two indexes
        means something, not their sizes.
    scale_std : float
        Standard deviation of the logarithm of the indexes' scale; inf where nothing tells it.
    lines : tuple of LineEstimate
        The line amplitudes behind the indexes.
    travel : float
        Output travel covered by the samples used [rad].
    samples : int
        Samples used.
    signal_to_noise : float
        Power of the explained vibration over that of the residual [dB].
    misfit : float
        Residual power over the power that the noise floor explains; about 1 if the model is right.
    natural_frequency, natural_frequency_std, damping_ratio, damping_ratio_std : float
        fn [Hz] and ζ, and their standard deviations: 0 where they were given as exact.
    load_fluctuation, load_fluctuation_std : float
        Identified amplitude of the unknown load fluctuation [N·m].
    model : ParametricModel or None
        The reducer as identified, without its load; None where the indexes are relative.
    fit_status : FitStatus or None
        Why the newest fit ended; None where nothing is fitted step by step (sensorless).
    evidence : tuple of DirectionEvidence
        Lines of the newest motion direction by direction; none with a sensor.
    torque_shares : tuple of TorqueShare
        How much of the first pair's lines follows the torque; nothing with a sensor, or where the torque hardly swings.
    something_else : tuple of SomethingElse
        What the model leaves unexplained, the strongest first; nothing without a sensor.
    limitations : tuple of Limitation
        What weakens the result, or forbids naming a part on it.
    """

    circular_spline: ComplexArray
    flexspline: ComplexArray
    index: LinePair
    index_std: LinePair
    index_correlation: float = 0.0
    transmission_error: LinePair | None = None
    transmission_error_std: LinePair | None = None
    correlation: FloatArray | None = None
    relative: bool = False
    scale_std: float = math.inf
    lines: tuple[LineEstimate, ...] = ()
    travel: float = 0.0
    samples: int = 0
    signal_to_noise: float = float("nan")
    misfit: float = float("nan")
    natural_frequency: float = float("nan")
    natural_frequency_std: float = 0.0
    damping_ratio: float = float("nan")
    damping_ratio_std: float = 0.0
    load_fluctuation: float = 0.0
    load_fluctuation_std: float = float("nan")
    model: ParametricModel | None = None
    fit_status: FitStatus | None = None
    limitations: tuple[Limitation, ...] = ()
    beta_covariance: FloatArray | None = None
    evidence: tuple[DirectionEvidence, ...] = ()
    torque_shares: tuple[TorqueShare, ...] = ()
    something_else: tuple[SomethingElse, ...] = ()

    @classmethod
    def none(cls, limitations: tuple[Limitation, ...], *, relative: bool) -> Self:
        """Return the result where nothing could be identified, every number unknown, with the reasons."""
        return cls(
            circular_spline=np.zeros(0, dtype=np.complex128),
            flexspline=np.zeros(0, dtype=np.complex128),
            index=LinePair(math.nan, math.nan),
            index_std=LinePair(math.nan, math.nan),
            natural_frequency_std=math.nan,
            damping_ratio_std=math.nan,
            relative=relative,
            load_fluctuation=math.nan,
            limitations=limitations,
        )

    def limited(self, limitation: Limitation) -> Self:
        """Return the result with one more limitation, which weakens it at most: what was known before stands."""
        return replace(self, limitations=(*self.limitations, replace(limitation, blocks=False)))

    def explained(self, cause: Limitation) -> Self:
        """Return the result with the cause of what forbids naming a part, in place of its consequences."""
        return replace(self, limitations=(replace(cause, blocks=True), *self.doubts))

    def is_hidden_by_misfit(self, limit: float) -> bool:
        """Whether the indexes would be known well, beside their `limit`, if the model explained the vibration."""
        widened, std = self._widened, max(self.index_std)
        return self.is_unexplained or bool(widened and std > VAGUE * limit >= std / float(widened.values["factor"]))

    @property
    def is_unexplained(self) -> bool:
        """Whether the model leaves so much at the lines that no uncertainty makes up for it."""
        return bool(self._widened and float(self._widened.values["unexplained"]) > MOST_UNEXPLAINED)

    @property
    def _widened(self) -> Limitation | None:
        return next((one for one in self.doubts if one.code is LimitationCode.UNCERTAINTY_WIDENED), None)

    @property
    def doubts(self) -> tuple[Limitation, ...]:
        """Limitations that only weaken the result."""
        return tuple(limitation for limitation in self.limitations if not limitation.blocks)

    @property
    def blockers(self) -> tuple[Limitation, ...]:
        """Limitations that forbid naming a part."""
        return tuple(limitation for limitation in self.limitations if limitation.blocks)

    @property
    def critical_speed(self) -> float:
        """Lowest wave-generator speed [rpm] at which `model` is parametrically unstable; inf if none, NaN without it.

        Computed on access: it takes as long as the identification of some seconds of motion.
        """
        return math.nan if self.model is None else _critical_speed(self.model)


_critical_speed = functools.lru_cache(maxsize=16)(critical_speed)

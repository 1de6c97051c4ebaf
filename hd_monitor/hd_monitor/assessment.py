"""What a monitor says at one time: the verdict and everything behind it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .acquisition.quality import Quality
from .acquisition.record import JointSamples, Record, join_records
from .change import Growth
from .contract import NANOSECONDS
from .diagnosis.inputs import InputState
from .diagnosis.verdict import Component, Verdict
from .identification.result import Identification
from .orders.rms_curve import SpeedBin
from .orders.zoom import ZoomSpectrum, zoom_spectrum
from .settings import JointSettings

_FEWEST_SAMPLES = 16  # of a stretch worth a picture


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessment:
    """A joint's state at one time.

    Attributes
    ----------
    stamp : int
        The time to which it refers [ns], on the message stamps' clock: a whole multiple of ``analysis.period``.
    settings : JointSettings
        In force at that time.
    verdict : Verdict
        Of the reducer; it outlives its inputs.
    input : InputState
        Whether the inputs arrive.
    evidence_end : int or None
        Stamp of the newest motion behind the verdict [ns]; None where there was none.
    recalled : bool
        Whether the verdict is that of an earlier run, for want of a new one.
    identification : Identification or None
        None as long as nothing could be identified.
    steady_parts : tuple of Record
        The newest stretch at an almost constant speed, in pieces; none while the joint does not turn steadily.
    rms_curve : tuple of SpeedBin
        RMS [m/s²] by speed, since the start, or since the baseline was set.
    rms_growth : float
        Of the RMS against the baseline's at the same speeds, as a fraction; NaN without one.
    line_growth : mapping
        Of each spline's first line against the baseline's; nothing without one, and where the indexes are absolute.
    quality : Quality
        Counters of what came in, since the start.
    speed : float
        Mean magnitude of the wave-generator speed over the last period [rpm]; NaN without joint states.
    rms : float
        RMS over the last period [m/s²] of the tangential acceleration at the sensor's radius; NaN without any.
    records : tuple of Record
        The vibration of the last period with its motion.
    joint_samples : JointSamples or None
        The joint states of the last period; None if it had none.
    torque_source : str
        Where the transmitted torque came from: ``effort``, ``parameter``, ``assumed`` (the parameter stands in for
        efforts that are not measured) or ``unknown``.
    temperature : float
        Of the reducer [°C]; NaN where none is measured.
    extra : tuple of (str, str)
        Further keys and values for the status.
    """

    stamp: int
    settings: JointSettings
    verdict: Verdict
    input: InputState
    evidence_end: int | None
    recalled: bool
    identification: Identification | None
    steady_parts: tuple[Record, ...]
    rms_curve: tuple[SpeedBin, ...]
    rms_growth: float
    line_growth: Mapping[Component, Growth]
    quality: Quality
    speed: float
    rms: float
    torque_source: str = "unknown"
    records: tuple[Record, ...] = ()
    joint_samples: JointSamples | None = None
    temperature: float = math.nan
    extra: tuple[tuple[str, str], ...] = ()

    @property
    def evidence_age(self) -> float:
        """How old the newest motion behind the verdict is [s]; NaN where there was none, or the clock was set back."""
        if self.evidence_end is None or self.evidence_end > self.stamp:
            return math.nan
        return (self.stamp - self.evidence_end) / NANOSECONDS

    @property
    def steady(self) -> Record | None:
        """The newest stretch at an almost constant speed; None while the joint does not turn steadily."""
        return join_records(self.steady_parts) if self.steady_parts else None

    @property
    def strongest_pair(self) -> int:
        """Number k of the line pair with the largest line; 1 if none is known."""
        lines = self.identification.lines if self.identification else ()
        return max(lines, key=lambda line: max(line.amplitude)).k if lines else 1

    @property
    def zoom(self) -> ZoomSpectrum | None:
        """Zoom spectrum of θ'' around the strongest pair at the present speed; computed at each call."""
        steady = self.steady
        if steady is None or int(np.isfinite(steady.acceleration).sum()) < _FEWEST_SAMPLES:
            return None
        reducer = self.settings.reducer
        rpm = abs(float(steady.speed.mean())) * reducer.reduction * 60.0 / math.tau
        for k in (self.strongest_pair, 1):
            around = reducer.line_frequencies(rpm, k)
            if around.flexspline < 0.5 / steady.period:
                return zoom_spectrum(steady.acceleration, steady.period, around=around, k=k)
        return None

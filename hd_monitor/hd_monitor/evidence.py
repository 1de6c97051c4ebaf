"""What a joint's monitor has gathered: identification, RMS curve and the newest steady segment."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .acquisition.agreement import compare_motion
from .acquisition.record import Record
from .acquisition.recorder import AssembledPeriod
from .arrays import FloatArray
from .identification.identifier import Identifier
from .identification.result import Identification
from .identification.sensorless.agreement import DirectionEvidence
from .identification.sensorless.identifier import SensorlessIdentifier
from .limitation import Limitation
from .orders.rms_curve import RmsAccumulator, SpeedBin
from .orders.steady import SteadySegment
from .settings import JointSettings
from .sources import Quantity
from .suspicion import Suspicion

_SLOW_DEGREE = 5  # of the polynomial that removes gravity and rigid motion from a second of an IMU's signal

SomeIdentifier = Identifier | SensorlessIdentifier


def new_identifier(
    settings: JointSettings, *, sparing: bool = True, known: Sequence[tuple[DirectionEvidence, ...]] = ()
) -> SomeIdentifier:
    """Return an identifier without evidence of its own.

    Parameters
    ----------
    settings : JointSettings
    sparing : bool
        Whether to look at part of the motion once it knows enough.
    known : sequence of tuple of DirectionEvidence
        Evidence of earlier motion, from joint states alone; with a sensor the estimate starts anew.
    """
    return SensorlessIdentifier(settings, known) if settings.sensorless else Identifier(settings, sparing=sparing)


def end_recording(identifier: SomeIdentifier) -> None:
    """Use what waits for more motion: nothing joins one recording's end to the next one's beginning."""
    identifier.finish()
    if isinstance(identifier, SensorlessIdentifier):
        identifier.cut()


class Evidence:
    """All evidence from one joint's periods.

    Parameters
    ----------
    settings : JointSettings
    identifier : Identifier or SensorlessIdentifier, optional
        An identifier to continue with, with its evidence.
    """

    def __init__(self, settings: JointSettings, identifier: SomeIdentifier | None = None) -> None:
        self._settings = settings
        self._rpm = settings.reducer.reduction * 60.0 / math.tau
        self._radius = settings.input.sensor_radius
        self._gravity = settings.vibration.gravity
        self._contradiction: Limitation | None = None
        self._suspicion = Suspicion(settings)
        self._rms = RmsAccumulator(settings.analysis.rms_bin_width)
        self._steady = SteadySegment(settings.reducer, settings.analysis.minimum_speed)
        self._identifier = identifier or new_identifier(settings)

    def change(self, settings: JointSettings) -> None:
        """Put other settings in force that leave the evidence valid."""
        self._settings = settings
        self._identifier.change(settings)

    def add(self, period: AssembledPeriod) -> bool:
        """Take in another period; one whose positions and velocities contradict each other is left out.

        Returns
        -------
        bool
            Whether it is evidence: motion that was taken in.
        """
        turns = self.speed(period) >= self._settings.analysis.minimum_speed  # False for NaN
        moves, contradiction = compare_motion(
            period.joint_samples,
            minimum_speed=self._settings.analysis.minimum_speed / self._rpm,
            reduction=self._settings.reducer.reduction,
        )
        interrupted = self._contradiction is not None
        if moves:
            self._contradiction = contradiction
        if self._contradiction is not None:
            return False
        if isinstance(self._identifier, SensorlessIdentifier):
            if len(period.joint_samples):
                self._identifier.add(period.joint_samples)
            return turns
        self._suspicion.add(period)
        for record in period.records:
            if interrupted:
                record, interrupted = replace(record, continues=False), False
            self._rms.add(record.speed * self._rpm, self._tangential(record.acceleration))
            self._steady.add(record)
            self._identifier.add(record)
        if not period.records:
            self._steady.interrupt()
        return turns and bool(period.records) and Quantity.VIBRATION in period.usable

    def finish(self) -> None:
        """Use what is still waiting to become a longer segment."""
        self._identifier.finish()

    @property
    def identification(self) -> Identification | None:
        """What has been identified; None as long as nothing could be."""
        found = self._identifier.estimate()
        if self._contradiction is None:
            return found if found is None or self._settings.sensorless else self._suspicion.qualified(found)
        if found is None:
            return Identification.none((self._contradiction,), relative=self._settings.sensorless)
        return found.limited(self._contradiction)

    def restart_rms_curve(self) -> None:
        """Begin the RMS curve anew."""
        self._rms = RmsAccumulator(self._settings.analysis.rms_bin_width)

    @property
    def rms_curve(self) -> tuple[SpeedBin, ...]:
        """RMS [m/s²] of the vibration against the wave generator's speed."""
        return self._rms.curve()

    @property
    def steady_parts(self) -> tuple[Record, ...]:
        """The newest segment at an almost constant speed, in pieces."""
        return self._steady.parts()

    def speed(self, period: AssembledPeriod) -> float:
        """Mean magnitude of the wave-generator speed in a period [rpm]; NaN without motion."""
        if period.records:
            total = sum(len(record) for record in period.records)
            return sum(float(np.abs(r.speed).sum()) for r in period.records) / total * self._rpm
        joint = period.joint_samples
        if len(joint) < 2:
            return math.nan
        travel = float(np.abs(np.diff(np.unwrap(joint.angle))).sum())
        return travel / float(joint.times[-1] - joint.times[0]) * self._rpm

    def level(self, period: AssembledPeriod) -> float:
        """RMS of a period's vibration at the sensor's radius [m/s²]; NaN without any."""
        values = self._tangential(period.vibration)
        values = values[np.isfinite(values)]
        return math.sqrt(float(values @ values) / values.size) if values.size else math.nan

    def _tangential(self, acceleration: FloatArray) -> FloatArray:
        """Vibration at the sensor's radius [m/s²]; gravity and the arm's own motion removed from an IMU's signal."""
        values = self._radius * acceleration
        if not self._gravity or int((known := np.isfinite(values)).sum()) < 2 * _SLOW_DEGREE:
            return values
        place = np.linspace(-1.0, 1.0, values.size)
        slow = np.polynomial.Legendre.fit(place[known], values[known], _SLOW_DEGREE, domain=[-1.0, 1.0])
        return np.asarray(values - slow(place))

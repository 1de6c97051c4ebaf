"""A verdict as diagnostic status: plain words and numbers, the same for the node, the replay and the report."""

import math
from dataclasses import dataclass

from ..assessment import Assessment


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """What goes into a diagnostic_msgs/DiagnosticStatus, but for its name.

    Attributes
    ----------
    level : int
        0 OK, 1 WARN, 2 ERROR.
    message, hardware_id : str
    values : tuple of (str, str)
        Keys with their units, and values: one plain number or word each.
    """

    level: int
    message: str
    hardware_id: str
    values: tuple[tuple[str, str], ...]

    def value(self, key: str) -> str:
        """Return the value of a key."""
        return dict(self.values)[key]


def _number(value: float, digits: int = 3) -> str:
    return "unknown" if math.isnan(value) else f"{value:.{digits}f}"


def status_of(assessment: Assessment, joint: str) -> Status:
    """Write an assessment of the joint of this name as a status."""
    verdict, found, quality = assessment.verdict, assessment.identification, assessment.quality
    limits, needed = assessment.settings.diagnosis, assessment.settings.reducer.travel_to_separate(1)
    nan = math.nan
    degrees = math.degrees(found.travel) if found else 0.0
    values = [
        ("joint", joint),
        ("component", verdict.component.value),
        ("fault_code", verdict.fault_code.value),
        ("reason", verdict.reason),
        ("speed (rpm)", _number(assessment.speed, 1)),
        ("rms (m/s^2)", _number(assessment.rms, 4)),
        ("flexspline index (%)", _number(100.0 * found.index.flexspline if found else nan)),
        ("flexspline index std (%)", _number(100.0 * found.index_std.flexspline if found else nan)),
        ("circular spline index (%)", _number(100.0 * found.index.circular_spline if found else nan)),
        ("circular spline index std (%)", _number(100.0 * found.index_std.circular_spline if found else nan)),
        ("index kind", ("relative" if found.relative else "absolute") if found else "unknown"),
        ("warn limit (%)", _number(100.0 * limits.warn_index)),
        ("error limit (%)", _number(100.0 * limits.error_index)),
        ("travel (deg)", _number(degrees, 1)),
        ("travel needed (deg)", _number(math.degrees(needed), 1)),
        ("signal to noise (dB)", _number(found.signal_to_noise if found else nan, 1)),
        ("misfit", _number(found.misfit if found else nan, 2)),
        ("fit", found.fit_status.value if found and found.fit_status else "none"),
        ("natural frequency (Hz)", _number(found.natural_frequency if found else nan, 2)),
        ("natural frequency std (Hz)", _number(found.natural_frequency_std if found else nan, 2)),
        ("damping ratio", _number(found.damping_ratio if found else nan, 4)),
        ("load fluctuation (N*m)", _number(found.load_fluctuation if found else nan)),
        ("unstable from (rpm)", _speed(found.critical_speed if found else nan)),
        ("torque source", assessment.torque_source),
        ("samples", str(quality.samples)),
        ("samples used", str(found.samples if found else 0)),
        ("sampling rate (Hz)", _number(quality.rate, 2)),
        ("gaps", str(quality.gaps)),
        ("lost samples", str(quality.lost)),
        ("duplicates", str(quality.duplicates)),
        ("out of order", str(quality.out_of_order)),
        ("not finite", str(quality.not_finite)),
        ("clipped", str(quality.clipped)),
        ("stuck", str(quality.stuck)),
        ("spikes", str(quality.spikes)),
        ("clock jumps", str(quality.clock_jumps)),
        ("joint states", str(quality.motion_messages)),
        ("bad joint states", str(quality.motion_faults)),
        ("torque samples", str(quality.torque_messages)),
        ("bad torque samples", str(quality.torque_faults)),
        ("rejected messages", str(quality.rejected)),
        ("last complaint", quality.last_fault or "none"),
        *assessment.extra,
    ]
    return Status(
        level=int(verdict.level),
        message=verdict.reason,
        hardware_id=assessment.settings.serial,
        values=tuple(values),
    )


def _speed(rpm: float) -> str:
    return "never" if math.isinf(rpm) else _number(rpm, 0)

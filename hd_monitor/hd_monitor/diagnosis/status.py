"""A verdict as diagnostic status: plain words and numbers, the same for the node, the replay and the report."""

import math
from dataclasses import dataclass

from ..assessment import Assessment
from ..identification.result import Identification
from .something_else import describe_all_else

_NOTHING = Identification.none((), relative=False)
"""Stands in as long as nothing is identified."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """What goes into a diagnostic_msgs/DiagnosticStatus, but for its name.

    Attributes
    ----------
    level : int
        0 OK, 1 WARN, 2 ERROR.
    message, hardware_id : str
    values : tuple of (str, str)
        Keys with their units, and values: one plain number or word each; unknown numbers are left out.
    """

    level: int
    message: str
    hardware_id: str
    values: tuple[tuple[str, str], ...]

    def value(self, key: str) -> str:
        """Return the value of a key."""
        return dict(self.values)[key]


def status_of(assessment: Assessment, joint: str) -> Status:
    """Write an assessment of the joint of this name as a status."""
    verdict, quality = assessment.verdict, assessment.quality
    found = assessment.identification or _NOTHING
    kind = "unknown" if found is _NOTHING else "relative" if found.relative else "absolute"
    limits, needed = assessment.settings.diagnosis, assessment.settings.reducer.travel_to_separate(1)
    samples, *faults = quality.counts()
    values: list[tuple[str, str | None]] = [
        ("joint", joint),
        ("component", verdict.component.value),
        ("cause", verdict.cause.value),
        ("fault_code", verdict.fault_code.value),
        ("reason", verdict.reason),
        ("speed (rpm)", _number(assessment.speed, 1)),
        ("rms (m/s^2)", _number(assessment.rms, 4)),
        ("flexspline index (%)", _number(100.0 * found.index.flexspline)),
        ("flexspline index std (%)", _number(100.0 * found.index_std.flexspline)),
        ("circular spline index (%)", _number(100.0 * found.index.circular_spline)),
        ("circular spline index std (%)", _number(100.0 * found.index_std.circular_spline)),
        *_errors(found),
        ("index kind", kind),
        ("warn limit (%)", _number(100.0 * limits.warn_index)),
        ("error limit (%)", _number(100.0 * limits.error_index)),
        ("warn limit (arcmin)", _number(limits.warn_transmission_error)),
        ("error limit (arcmin)", _number(limits.error_transmission_error)),
        ("travel (deg)", _number(math.degrees(found.travel), 1)),
        ("travel needed (deg)", _number(math.degrees(needed), 1)),
        ("signal to noise (dB)", _number(found.signal_to_noise, 1)),
        ("misfit", _number(found.misfit, 2)),
        ("something else", describe_all_else(found.something_else)),
        ("fit", found.fit_status.value if found.fit_status else "none"),
        ("natural frequency (Hz)", _number(found.natural_frequency, 2)),
        ("natural frequency std (Hz)", _number(found.natural_frequency_std, 2)),
        ("damping ratio", _number(found.damping_ratio, 4)),
        ("load fluctuation (N*m)", _number(found.load_fluctuation)),
        ("unstable from (rpm)", _number(found.critical_speed, 0)),
        ("torque source", assessment.torque_source),
        samples,
        ("samples used", str(found.samples)),
        ("sampling rate (Hz)", _number(quality.rate or math.nan, 2)),
        *faults,
        ("last complaint", quality.last_fault or "none"),
        *assessment.extra,
    ]
    return Status(
        level=int(verdict.level),
        message=verdict.reason,
        hardware_id=assessment.settings.serial,
        values=tuple((key, value) for key, value in values if value is not None),
    )


def _errors(found: Identification) -> list[tuple[str, str | None]]:
    """Transmission errors, where they are estimated."""
    error, std = found.transmission_error, found.transmission_error_std
    if error is None or std is None:
        return []
    return [
        entry
        for part in ("flexspline", "circular_spline")
        for entry in (
            (f"{part.replace('_', ' ')} transmission error (arcmin)", _number(getattr(error, part))),
            (f"{part.replace('_', ' ')} transmission error std (arcmin)", _number(getattr(std, part))),
        )
    ]


def _number(value: float, digits: int = 3) -> str | None:
    """Write a number; None leaves an unknown one out, so that a key never holds a word in its place."""
    return f"{value:.{digits}f}" if math.isfinite(value) else None

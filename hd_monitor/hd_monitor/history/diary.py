"""When an assessment is worth an entry: after a share of motion, and at each change of the verdict."""

import math

import numpy as np

from ..arrays import FloatArray
from ..assessment import Assessment
from ..diagnosis.verdict import FaultCode
from ..orders.rms_curve import SpeedBin, curve_since
from .entry import Entry, Kind

_NO_VERDICT = {FaultCode.WAITING, FaultCode.INTERNAL_ERROR}
"""Codes that say nothing of the reducer: they are no transitions of its history."""


def _is_news(assessment: Assessment) -> bool:
    """Whether it says something of the reducer, on evidence of this run."""
    old = assessment.recalled or assessment.input.failed
    return assessment.verdict.fault_code not in _NO_VERDICT and not old


class Diary:
    """Decides which assessments of one joint become entries.

    Parameters
    ----------
    joint : str
    interval : float
        Motion [s] from one entry to the next.
    recording : str
        Where the assessments come from; empty for a running node.
    """

    def __init__(self, joint: str, interval: float, recording: str = "") -> None:
        self._joint = joint
        self._interval = interval
        self._recording = recording
        self._shown: tuple[object, ...] | None = None
        self._curve: tuple[SpeedBin, ...] = ()
        self._clear()

    def note(self, assessment: Assessment) -> Entry | None:
        """Take the next assessment; return the entry that it is worth, if any."""
        self._add_motion(assessment)
        if not _is_news(assessment):
            return None
        verdict = assessment.verdict
        shown = verdict.component, verdict.level, verdict.fault_code
        changed, self._shown = shown != self._shown, shown
        if changed:
            return self._entry(assessment, Kind.TRANSITION)
        return self._entry(assessment, Kind.EVIDENCE) if self._seconds >= self._interval else None

    def close(self, assessment: Assessment) -> Entry | None:
        """Return the entry of what followed the last one, if the joint moved since."""
        if not self._seconds or not _is_news(assessment):
            return None
        return self._entry(assessment, Kind.EVIDENCE)

    def _entry(self, assessment: Assessment, kind: Kind) -> Entry:
        entry = Entry.of(assessment, self._joint, kind=kind, recording=self._recording)
        curve, self._curve = curve_since(entry.rms_curve, self._curve, entry.rms_bin_width), entry.rms_curve
        entry = entry.with_motion(
            revolutions=self._revolutions,
            seconds=self._seconds,
            torque=self._torque.mean,
            temperature=self._temperature.mean,
            rms_curve=curve,
        )
        self._clear()
        return entry

    def _add_motion(self, assessment: Assessment) -> None:
        settings, speed = assessment.settings.analysis, assessment.speed
        if speed >= settings.minimum_speed:  # also False for NaN
            self._seconds += settings.period
            self._revolutions += speed * settings.period / 60.0
        if assessment.joint_samples is not None:
            self._torque.add(assessment.joint_samples.effort)
        self._temperature.add(np.array([assessment.temperature]))

    def _clear(self) -> None:
        self._seconds = self._revolutions = 0.0
        self._torque, self._temperature = _Mean(), _Mean()


class _Mean:
    """Mean of the finite ones of values that come bit by bit."""

    def __init__(self) -> None:
        self._sum, self._count = 0.0, 0

    def add(self, values: FloatArray) -> None:
        finite = values[np.isfinite(values)]
        self._sum += float(finite.sum())
        self._count += finite.size

    @property
    def mean(self) -> float:
        return self._sum / self._count if self._count else math.nan

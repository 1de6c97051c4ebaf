"""When an assessment is worth an entry: after a share of motion, and at each change of the verdict."""

import math

import numpy as np

from ..assessment import Assessment
from ..diagnosis.verdict import FaultCode
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
        torque = self._torque / self._torque_samples if self._torque_samples else math.nan
        entry = entry.with_motion(revolutions=self._revolutions, seconds=self._seconds, torque=torque)
        self._clear()
        return entry

    def _add_motion(self, assessment: Assessment) -> None:
        settings, speed = assessment.settings.analysis, assessment.speed
        if speed >= settings.minimum_speed:  # also False for NaN
            self._seconds += settings.period
            self._revolutions += speed * settings.period / 60.0
        if assessment.joint_samples is not None:
            effort = assessment.joint_samples.effort
            effort = effort[np.isfinite(effort)]
            self._torque += float(effort.sum())
            self._torque_samples += effort.size

    def _clear(self) -> None:
        self._seconds = self._revolutions = self._torque = 0.0
        self._torque_samples = 0

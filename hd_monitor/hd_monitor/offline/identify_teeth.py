"""Tooth check: do the teeth given fit the recording, and if not, which do?"""

import math
from dataclasses import replace

import numpy as np

from ..acquisition.record import JointSamples, Record
from ..assessment import Assessment
from ..identification.teeth.ranking import ToothPairRanking, rank_tooth_pairs
from ..orders.joint_segment import samples_of_records
from ..settings import JointSettings

LONGEST = 600.0
"""Motion [s] that the check looks at: more would tell little more, and memory stays flat."""

_APART = 10.0  # s between recordings laid end to end: no stroke goes on from one to the next


def is_certain(ranking: ToothPairRanking | None) -> bool:
    """Whether the first pair may replace what was given: both its lines must be found, since one fits two pairs."""
    return ranking is not None and ranking.conclusive and ranking.ranked[0].lines_found == 2


class ToothCheck:
    """Gathers a joint's motion over recordings and ranks candidate tooth pairs.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._sensorless = settings.sensorless
        self._source = settings.input.source if settings.sensorless else "joint_effort"
        self._minimum_speed = settings.analysis.minimum_speed * math.tau / 60.0 / settings.reducer.reduction
        self._parts: list[JointSamples] = []
        self._end = 0.0
        self._offset = 0.0
        self.seconds = 0.0

    def add(self, assessment: Assessment) -> None:
        """Take what an assessment looked at."""
        if self.seconds >= LONGEST:
            return
        if self._sensorless:
            if assessment.joint_samples is not None and len(assessment.joint_samples):
                self._append(assessment.joint_samples)
            return
        for record in assessment.records:
            if len(record) and self._turns(record):
                self._append(samples_of_records([record]))

    def cut(self) -> None:
        """End a recording."""
        self._offset = self._end + _APART

    def ranking(self) -> ToothPairRanking | None:
        """Return the candidate pairs by falling evidence; None if there was no motion."""
        if not self._parts:
            return None
        columns = ("times", "angle", "speed", "effort")
        gathered = {name: np.concatenate([getattr(part, name) for part in self._parts]) for name in columns}
        return rank_tooth_pairs(JointSamples(**gathered), source=self._source, minimum_speed=self._minimum_speed)

    def _turns(self, record: Record) -> bool:
        return float(np.abs(record.speed).max()) >= self._minimum_speed

    def _append(self, samples: JointSamples) -> None:
        if samples.times[0] + self._offset < self._end:  # the stamps were set back, or the next recording began
            self._offset = self._end + _APART - float(samples.times[0])
        times = samples.times + self._offset
        self._end = float(times[-1])
        self.seconds += float(np.ptp(times))
        self._parts.append(replace(samples, times=times))

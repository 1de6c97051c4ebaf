"""Collects records into segments of the length that the state of the estimation requires."""

import math

import numpy as np

from ...acquisition.record import Record

SHORTEST = 0.25
"""Length [s] below which a contiguous segment does not justify its two unknown starting values."""

_FEWEST_SAMPLES = 64
_SLACK = 0.1  # s that may be missing from the required length: records are cut at whole periods of the stamps


class SegmentAssembler:
    """Joins records that follow each other without a gap; standing ones end a segment.

    Parameters
    ----------
    minimum_speed : float
        Output speed [rad/s] below which the joint counts as standing.
    """

    def __init__(self, minimum_speed: float) -> None:
        self._minimum_speed = minimum_speed
        self._pending: list[Record] = []

    def add(self, record: Record, length: float) -> list[list[Record]]:
        """Take a record and return what is complete, as lists of records that belong together.

        Parameters
        ----------
        record : Record
        length : float
            Length [s] from which a segment is complete.
        """
        done = [] if record.continues else self.flush()
        known = np.isfinite(record.angle).all() and np.isfinite(record.speed).all()
        if len(record) < 2 or not known or float(np.abs(record.speed).max()) < self._minimum_speed:
            return done + self.flush()
        if self._pending and math.isnan(self._pending[0].torque[0]) != math.isnan(record.torque[0]):
            done += self.flush()
        self._pending.append(record)
        if self.duration >= length - _SLACK:
            done += self.flush()
        return done

    def flush(self) -> list[list[Record]]:
        """Return what is pending if it is long enough, and start again."""
        records, duration = self._pending, self.duration
        self._pending = []
        samples = sum(int(np.isfinite(record.acceleration).sum()) for record in records)
        return [records] if duration >= SHORTEST and samples >= _FEWEST_SAMPLES else []

    @property
    def duration(self) -> float:
        """Length [s] of what is pending."""
        return sum(len(record) * record.period for record in self._pending)

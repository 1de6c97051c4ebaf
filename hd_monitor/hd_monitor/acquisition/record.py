"""Input of the analyses: contiguous stretches of vibration with their motion, and joint states."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Record:
    """A contiguous stretch of samples on a uniform time grid, without a gap, stops and reversals included.

    Attributes
    ----------
    start : float
        Time of the first sample [s], relative to the monitor's epoch.
    period : float
        Sample period [s].
    acceleration : ndarray, shape (samples,)
        Torsional acceleration θ'' of the output [rad/s²]; NaN where a sample was lost or bad.
    angle : ndarray, shape (samples,)
        Output-side joint angle q [rad], unwrapped; absolute wherever the joint's encoder is.
    speed : ndarray, shape (samples,)
        Output speed [rad/s].
    torque : ndarray, shape (samples,)
        Measured transmitted torque on the output [N·m]; NaN throughout where unknown.
    continues : bool
        True if this stretch follows the one handed over before it without a gap.
    """

    start: float
    period: float
    acceleration: FloatArray
    angle: FloatArray
    speed: FloatArray
    torque: FloatArray
    continues: bool = False

    def __len__(self) -> int:
        """Return the number of samples."""
        return int(self.acceleration.size)

    @property
    def times(self) -> FloatArray:
        """Times of the samples [s], relative to the monitor's epoch."""
        return np.asarray(self.start + self.period * np.arange(len(self)), dtype=np.float64)


def join_records(records: Sequence[Record]) -> Record:
    """Join records, one or more, each of which continues the one before it.

    Their common period follows from their starts: each record has its own estimate of it.
    """
    first, last = records[0], records[-1]
    if len(records) == 1:
        return first
    acceleration, angle, speed, torque = (
        np.concatenate([getattr(record, name) for record in records])
        for name in ("acceleration", "angle", "speed", "torque")
    )
    return Record(
        start=first.start,
        period=(last.start - first.start) / sum(len(record) for record in records[:-1]),
        acceleration=acceleration,
        angle=angle,
        speed=speed,
        torque=torque,
        continues=first.continues,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointSamples:
    """Joint states as they came, one row a message: the input of the sensorless mode.

    Attributes
    ----------
    times : ndarray, shape (messages,)
        Stamps [s], relative to the monitor's epoch, increasing, not necessarily even.
    angle, speed, effort : ndarray, shape (messages,)
        Output-side position [rad], velocity [rad/s] and effort [N·m, or A where a driver reports currents];
        NaN where a message lacks the field.
    """

    times: FloatArray
    angle: FloatArray
    speed: FloatArray
    effort: FloatArray

    def __len__(self) -> int:
        """Return the number of messages."""
        return int(self.times.size)

"""Bins of wave-generator speed, by which a report's analyses divide the records of a run."""

import math
from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import BoolArray, FloatArray, IntArray
from ...reducer import Reducer


class SpeedBins(NamedTuple):
    """Bins of one width, and the speed below which the joint counts as standing."""

    reducer: Reducer
    width: float
    """Of the bins [rpm of the wave generator]."""
    minimum_speed: float
    """Wave-generator speed [rpm] below which the joint counts as standing."""

    def rpm(self, record: Record) -> FloatArray:
        """Wave-generator speed at each sample [rpm], with the output's sign."""
        return np.asarray(record.speed * self.reducer.reduction * 60.0 / math.tau)

    def turning(self, rpm: FloatArray) -> BoolArray:
        """Whether the joint turns, at each speed [rpm]."""
        return np.asarray(np.abs(rpm) > self.minimum_speed)

    def number(self, rpm: FloatArray) -> IntArray:
        """Number of the bin of each speed [rpm], whatever the direction; bin n is centred on n widths."""
        return np.asarray(np.rint(np.abs(rpm) / self.width), dtype=np.int64)

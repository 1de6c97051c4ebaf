"""What a report needs beyond the assessments, collected while a recording is replayed, in bounded memory."""

from collections import deque

import numpy as np

from ...acquisition.record import JointSamples
from ...arrays import FloatArray
from ...assessment import Assessment
from ...contract import NANOSECONDS
from ...settings import JointSettings
from .lines_by_speed import LinesBySpeed
from .spectra import OrderMapAccumulator, filled
from .speed_bins import SpeedBins
from .waterfall import WaterfallAccumulator

_TAIL = 120_000  # samples kept of the recording's end
_AS_GOOD = 0.8
_SLOW_DEGREE = 3


class Collector:
    """Collects from the assessments of one joint.

    Parameters
    ----------
    settings : JointSettings

    Attributes
    ----------
    best : Assessment or None
        The newest assessment whose zoom spectrum shows the lines about as high as any other.
    order_map : OrderMapAccumulator
    lines : LinesBySpeed
    waterfall : WaterfallAccumulator
    seconds : float
        Stamps covered [s].
    motion_seconds : float
        Time in which joint states came [s].
    """

    def __init__(self, settings: JointSettings) -> None:
        reducer, harmonics = settings.reducer, settings.analysis.harmonics
        speeds = SpeedBins(reducer, settings.analysis.rms_bin_width, settings.analysis.minimum_speed)
        self.settings = settings
        highest = harmonics * max(reducer.circular_spline_order, reducer.flexspline_order) + 1.0
        self.order_map = OrderMapAccumulator(speeds, highest)
        self.lines = LinesBySpeed(speeds, harmonics)
        self.waterfall = WaterfallAccumulator()
        self.best: Assessment | None = None
        self._first: int | None = None
        self.seconds = 0.0
        self.motion_seconds = 0.0
        self._tail = deque([(np.empty(0), np.empty(0))])
        self._kept = 0

    def add(self, assessment: Assessment) -> None:
        """Take the next assessment."""
        self._first = self._first or assessment.stamp
        self.seconds = (assessment.stamp - self._first) / NANOSECONDS
        for record in assessment.records:
            self.order_map.add(record)
            self.lines.add(record)
            self.waterfall.add(record)
            self._keep(record.angle, filled(record.acceleration))
        joint = assessment.joint_samples
        if joint is not None and len(joint) > 1:
            self.motion_seconds += float(joint.times[-1] - joint.times[0]) * len(joint) / (len(joint) - 1)
            if self.settings.sensorless:
                self._keep_joint(joint)
        if assessment.zoom is not None and _height(assessment) >= _AS_GOOD * _height(self.best):
            self.best = assessment

    def tail(self) -> tuple[FloatArray, FloatArray]:
        """Output angle [rad] and vibration signal of the recording's last minutes."""
        angles, values = zip(*self._tail, strict=True)
        return np.concatenate(angles), np.concatenate(values)

    def _keep_joint(self, joint: JointSamples) -> None:
        """Keep a sensorless signal without its slow part: friction and gravity."""
        values = joint.effort if self.settings.input.source == "joint_effort" else joint.speed
        known = np.isfinite(values)
        if int(known.sum()) > 2 * _SLOW_DEGREE and float(np.ptp(joint.times)) > 0.0:
            slow = np.polynomial.Legendre.fit(joint.times[known], values[known], _SLOW_DEGREE)
            self._keep(joint.angle[known], values[known] - slow(joint.times[known]))

    def _keep(self, angle: FloatArray, values: FloatArray) -> None:
        self._tail.append((angle, values))
        self._kept += values.size
        while self._kept > _TAIL and len(self._tail) > 1:
            self._kept -= self._tail.popleft()[1].size


def _height(assessment: Assessment | None) -> float:
    """Height of the zoom spectrum's lines, worth less where they are not separated; 0 without one."""
    zoom = assessment.zoom if assessment is not None else None
    return 0.0 if zoom is None else max(zoom.line_amplitudes) * (1.0 if zoom.resolved else 0.1)

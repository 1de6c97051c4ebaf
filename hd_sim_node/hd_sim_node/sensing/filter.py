"""The accelerometer's anti-aliasing filter, and the honest way through it: filtered fast, then thinned.

Rig and filter run at a whole multiple of the sensor's rate, and one in so many values becomes a sample. What the
filter does not stop above half the sensor's rate therefore folds down as it does in a real sensor. Noise and spikes
arise behind the filter.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy import signal

from hd_monitor.arrays import FloatArray
from hd_monitor.parameter import number

from ..drive.chunk import RigChunk

_PER_BANDWIDTH = 64.0  # filter steps per 1/bandwidth: the bilinear transform is off by 0.3 % at twice the bandwidth
_PER_SAMPLE = 16.0  # filter steps per sample at least: content up to eight times the sampling rate keeps its frequency


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterSettings:
    """The low-pass filter between the accelerometer and its converter."""

    bandwidth: float = number(
        0.0, "Hz", 0.0, 20_000.0, "frequency at which the sensor's Butterworth filter attenuates by 3 dB; 0: no filter"
    )
    filter_order: int = number(2, "", 1, 10, "order of the sensor's filter")

    def oversampling(self, rate: float) -> int:
        """Filter steps per sample at a sampling rate [Hz]; 1 without a filter."""
        return math.ceil(max(_PER_SAMPLE, _PER_BANDWIDTH * self.bandwidth / rate)) if self.bandwidth else 1


class AntiAliasing:
    """Filters a rig's motion and thins it to the samples; the filter starts in its steady state.

    Parameters
    ----------
    settings : FilterSettings
    rate : float
        Samples per second [Hz]; the motion comes at `oversampling` times that.
    """

    _FELT = ("angle", "speed", "rigid_acceleration", "velocity", "acceleration")

    def __init__(self, settings: FilterSettings, *, rate: float) -> None:
        self.oversampling = settings.oversampling(rate)
        self._sections: FloatArray | None = None
        if settings.bandwidth:
            self._sections = signal.butter(
                settings.filter_order, settings.bandwidth, fs=rate * self.oversampling, output="sos"
            )
        self._state: FloatArray | None = None

    def thin(self, fine: RigChunk) -> RigChunk:
        """Return the motion as the converter sees it, a stretch of whole samples.

        An IMU's gravity and centripetal force come from the filtered angle and speed, which change slowly enough.
        """
        if self._sections is None:
            return fine
        columns = np.stack([getattr(fine, name) for name in self._FELT])
        if self._state is None:
            steady = signal.sosfilt_zi(self._sections)
            self._state = steady[:, np.newaxis, :] * columns[np.newaxis, :, :1]
        filtered, self._state = signal.sosfilt(self._sections, columns, zi=self._state)
        return replace(fine, **dict(zip(self._FELT, filtered, strict=True))).thinned(self.oversampling)

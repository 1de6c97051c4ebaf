"""The virtual accelerometer: noise, offset, spikes, full scale, resolution, a stuck output and a clock that jitters."""

from dataclasses import dataclass

import numpy as np

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import NANOSECONDS
from hd_monitor.parameter import number

from ..drive.chunk import RigChunk
from ..randomness import generator


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSettings:
    """What the accelerometer does to the signal: the parameters ``sensor.*`` that may be changed while it runs."""

    noise: float = number(0.1, "rad/s²", 0.0, 1e9, "standard deviation of white noise")
    offset: float = number(0.0, "rad/s²", -1e9, 1e9, "constant added to the signal")
    spike_rate: float = number(0.0, "1/s", 0.0, 1e5, "spikes per second")
    spike_size: float = number(100.0, "rad/s²", 0.0, 1e9, "standard deviation of the spikes")
    full_scale: float = number(0.0, "rad/s²", 0.0, 1e9, "value at which the sensor clips; 0: none")
    resolution: float = number(0.0, "rad/s²", 0.0, 1e9, "step of the sensor's values; 0: continuous")
    stuck_after: float = number(0.0, "s", 0.0, 1e7, "time after which the sensor repeats its last value; 0: never")
    jitter: float = number(0.0, "s", 0.0, 10.0, "standard deviation of the stamps")
    delay: float = number(0.0, "s", -10.0, 10.0, "by how much the stamps are late")


class Accelerometer:
    """Turns the rig's motion into samples; one random number is drawn for each, so that cuts do not matter.

    Parameters
    ----------
    settings : SensorSettings
        May be replaced while it runs (attribute `settings`).
    rate : float
        Samples per second [Hz].
    seed : int
    """

    def __init__(self, settings: SensorSettings, *, rate: float, seed: int = 0) -> None:
        self.settings = settings
        self._rate = rate
        self._noise = generator(seed, "noise")
        self._spike_times = generator(seed, "spike times")
        self._spike_sizes = generator(seed, "spike sizes")
        self._jitter = generator(seed, "jitter")
        self._last = 0.0

    def measure(self, chunk: RigChunk) -> FloatArray:
        """Samples [rad/s²] of a stretch of motion, shape (samples,)."""
        settings = self.settings
        values = chunk.acceleration + chunk.rigid_acceleration + settings.offset
        values += settings.noise * self._noise.standard_normal(len(chunk))
        hit = self._spike_times.random(len(chunk)) < settings.spike_rate / self._rate
        values += np.where(hit, settings.spike_size * self._spike_sizes.standard_normal(len(chunk)), 0.0)
        if settings.resolution:
            values = np.round(values / settings.resolution) * settings.resolution
        if settings.full_scale:
            values = np.clip(values, -settings.full_scale, settings.full_scale)
        if settings.stuck_after:
            stuck = chunk.times >= settings.stuck_after
            held = values[~stuck][-1] if not stuck.all() else self._last
            values = np.where(stuck, held, values)
        self._last = float(values[-1])
        return values

    def stamps(self, chunk: RigChunk) -> IntArray:
        """Stamps [ns] of the samples, since the start, shape (samples,)."""
        error = self.settings.jitter * self._jitter.standard_normal(len(chunk))
        return nanoseconds(chunk.times + self.settings.delay + error)


def nanoseconds(times: FloatArray) -> IntArray:
    """Convert times [s] to whole nanoseconds."""
    return np.asarray(np.rint(times * NANOSECONDS), dtype=np.int64)

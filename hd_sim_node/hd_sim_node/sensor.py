"""The virtual accelerometer: noise, offset, spikes, full scale, resolution, a stuck output and a clock that jitters."""

from dataclasses import dataclass

import numpy as np

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import NANOSECONDS

from .randomness import generator
from .rig import RigChunk


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSettings:
    """What the accelerometer does to the signal.

    Parameters
    ----------
    noise : float
        Standard deviation of white noise [rad/s²].
    offset : float
        Constant added [rad/s²].
    spike_rate : float
        Spikes per second on average.
    spike_size : float
        Standard deviation of the spikes [rad/s²].
    full_scale : float
        Largest value put out [rad/s²]; 0: no limit.
    resolution : float
        Step of the values put out [rad/s²]; 0: continuous.
    stuck_after : float
        Time [s] after which the last value is repeated forever; 0: never.
    jitter : float
        Standard deviation of the stamps [s].
    delay : float
        Delay of the stamps [s].
    """

    noise: float = 0.0
    offset: float = 0.0
    spike_rate: float = 0.0
    spike_size: float = 0.0
    full_scale: float = 0.0
    resolution: float = 0.0
    stuck_after: float = 0.0
    jitter: float = 0.0
    delay: float = 0.0


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

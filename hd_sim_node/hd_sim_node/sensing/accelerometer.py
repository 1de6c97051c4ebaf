"""The virtual accelerometer: gain, noise, offset, spikes, full scale and resolution of its samples."""

from dataclasses import dataclass

import numpy as np

from hd_monitor.arrays import FloatArray
from hd_monitor.parameter import number

from ..drive.chunk import RigChunk
from ..randomness import generator
from .fault import Fault, FaultSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSettings:
    """What the accelerometer does to the signal."""

    gain: float = number(1.0, "", -1e3, 1e3, "factor on the signal: its scale error; negative: of the wrong sign")
    noise: float = number(0.1, "rad/s²", 0.0, 1e9, "standard deviation of white noise in the samples")
    offset: float = number(0.0, "rad/s²", -1e9, 1e9, "constant added to the signal")
    spike_rate: float = number(0.0, "1/s", 0.0, 1e5, "spikes per second")
    spike_size: float = number(100.0, "rad/s²", 0.0, 1e9, "standard deviation of the spikes")
    full_scale: float = number(0.0, "rad/s²", 0.0, 1e9, "value at which the sensor clips; 0: none")
    resolution: float = number(0.0, "rad/s²", 0.0, 1e9, "step of the sensor's values; 0: continuous")


class Accelerometer:
    """Turns motion into samples; one random number is drawn for each, so that cuts do not matter.

    Parameters
    ----------
    settings : SensorSettings
        May be replaced while it runs (attribute `settings`).
    fault : FaultSettings, optional
        May be replaced too (attribute `fault.settings`).
    rate : float
        Samples per second [Hz].
    seed : int
    """

    def __init__(
        self, settings: SensorSettings, fault: FaultSettings | None = None, *, rate: float, seed: int = 0
    ) -> None:
        self.settings = settings
        self.fault = Fault(fault or FaultSettings(), seed=seed)
        self._rate = rate
        self._noise = generator(seed, "noise")
        self._spike_times = generator(seed, "spike times")
        self._spike_sizes = generator(seed, "spike sizes")

    def measure(self, felt: RigChunk) -> FloatArray:
        """Samples [rad/s²] of a stretch of motion, shape (samples,)."""
        settings, fault, count = self.settings, self.fault, len(felt)
        gain = settings.gain * fault.sensitivity(felt.times)
        values = gain * (felt.acceleration + felt.rigid_acceleration) + settings.offset
        values += settings.noise * fault.noise(felt.times) * self._noise.standard_normal(count)
        hit = self._spike_times.random(count) < settings.spike_rate / self._rate
        values += np.where(hit, settings.spike_size * self._spike_sizes.standard_normal(count), 0.0)
        if settings.resolution:
            values = np.round(values / settings.resolution) * settings.resolution
        if settings.full_scale:
            values = np.clip(values, -settings.full_scale, settings.full_scale)
        return fault.interrupt(felt.times, values)

"""The accelerometer's clock: offset, drift and jitter of its stamps, and a FIFO that is read out in bursts."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import NANOSECONDS
from hd_monitor.errors import ParameterError
from hd_monitor.parameter import number

from ..drive.chunk import RigChunk
from ..randomness import generator


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockSettings:
    """What the accelerometer's clock does to the stamps; the host's clock, of joint_states too, is the true time."""

    clock_offset: float = number(0.0, "s", -1e6, 1e6, "by how much the sensor's stamps are ahead of the host's clock")
    clock_drift: float = number(
        0.0, "ppm", -1e5, 1e5, "by how much the sensor's clock runs fast, in stamps and in the blocks' sample period"
    )
    jitter: float = number(0.0, "s", 0.0, 10.0, "standard deviation of the stamps")
    fifo: int = number(
        1, "", 1, 4096, "samples read out at once and stamped then; blocks keep the instant of their first sample"
    )
    fifo_spacing: float = number(1e-4, "s", 0.0, 1.0, "time between the stamps of samples that are read out at once")

    def check(self, rate: float) -> None:
        """Check that the FIFO is read faster than it fills at `rate` [Hz].

        Raises
        ------
        ParameterError
            If it is not.
        """
        if self.fifo > 1 and self.fifo_spacing * rate > 1.0:
            raise ParameterError(
                f"sensor.fifo_spacing = {self.fifo_spacing:g} s is longer than the {1.0 / rate:g} s between samples at "
                f"sensor.rate = {rate:g} Hz: the FIFO would fill faster than it is read; lower one of them"
            )


class Stamps(NamedTuple):
    """When the samples of a stretch are taken and read out, shape (samples,) each."""

    sampled: IntArray
    """Sampling instants by the sensor's clock [ns]."""
    read: IntArray
    """Instants at which they are read out, by the sensor's clock [ns]."""
    due: IntArray
    """Instants at which they are read out, by the host's clock [ns]."""


class Clock:
    """Stamps samples; one random number is drawn for each, so that cuts do not matter.

    Parameters
    ----------
    settings : ClockSettings
        Offset and jitter may be replaced while it runs (attribute `settings`); the drift counts from the start.
    rate : float
        Samples per second of the host's clock [Hz].
    seed : int
    """

    def __init__(self, settings: ClockSettings, *, rate: float, seed: int = 0) -> None:
        self.settings = settings
        self._rate = rate
        self._jitter = generator(seed, "jitter")

    @property
    def period(self) -> float:
        """Time between samples by the sensor's clock [s]."""
        return self._pace / self._rate

    @property
    def _pace(self) -> float:
        return 1.0 + 1e-6 * self.settings.clock_drift

    def stamp(self, chunk: RigChunk) -> Stamps:
        """Stamp the samples of a stretch, counted from the start of the simulation."""
        settings, sampled = self.settings, chunk.times
        read = sampled
        if settings.fifo > 1:
            index = chunk.first + np.arange(len(chunk))
            place = index % settings.fifo
            read = (index - place + settings.fifo - 1) / self._rate + place * settings.fifo_spacing
        error = settings.jitter * self._jitter.standard_normal(len(chunk))

        def shown(times: FloatArray) -> IntArray:
            return nanoseconds(times * self._pace + settings.clock_offset + error)

        return Stamps(shown(sampled), shown(read), nanoseconds(read))


def nanoseconds(times: FloatArray) -> IntArray:
    """Convert times [s] to whole nanoseconds."""
    return np.asarray(np.rint(times * NANOSECONDS), dtype=np.int64)

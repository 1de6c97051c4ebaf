"""A sensor that fails: it falls silent, repeats its last value, or dies slowly."""

from dataclasses import dataclass

import numpy as np

from hd_monitor.arrays import BoolArray, FloatArray
from hd_monitor.parameter import choice, number

from ..randomness import generator

_LAST_NOISE = 10.0  # times the noise of the healthy sensor, when a dying one has died
_LAST_DROPOUTS = 0.1  # of its samples are lost by then


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultSettings:
    """How and when the accelerometer fails."""

    fault: str = choice(
        "none",
        ("none", "dead", "stuck", "dying"),
        "dead: only noise and offset are left; stuck: the last value is repeated; dying: the signal fades to nothing "
        "while the noise grows tenfold and up to a tenth of the samples drop to 0",
    )
    fault_after: float = number(0.0, "s", 0.0, 1e7, "time after which the sensor fails")
    fault_time: float = number(60.0, "s", 1e-3, 1e7, "time that a dying sensor takes")


class Fault:
    """What a failing sensor does to its readings; two with the same seed fail alike.

    Parameters
    ----------
    settings : FaultSettings
        May be replaced while it runs (attribute `settings`).
    seed : int
    """

    def __init__(self, settings: FaultSettings, *, seed: int = 0) -> None:
        self.settings = settings
        self._dropouts = generator(seed, "dropouts")
        self._last: FloatArray | None = None

    def sensitivity(self, times: FloatArray) -> FloatArray:
        """What is left of the signal at `times` [s], from 1 to 0."""
        if self.settings.fault == "dead":
            return np.where(times >= self.settings.fault_after, 0.0, 1.0)
        return 1.0 - self._progress(times)

    def noise(self, times: FloatArray) -> FloatArray:
        """Factor on the noise at `times` [s]."""
        return 1.0 + (_LAST_NOISE - 1.0) * self._progress(times)

    def interrupt(self, times: FloatArray, readings: FloatArray) -> FloatArray:
        """Lose or repeat readings taken at `times` [s], shape (samples, …); call it once for each stretch."""
        settings = self.settings
        if settings.fault == "dying":
            lost = self._dropouts.random(len(times)) < _LAST_DROPOUTS * self._progress(times)
            readings = np.where(_beside(lost, readings), 0.0, readings)
        elif settings.fault == "stuck":
            sound = int(np.count_nonzero(times < settings.fault_after))
            held = readings[sound - 1] if sound else readings[0] if self._last is None else self._last
            readings = np.where(_beside(times < settings.fault_after, readings), readings, held)
        self._last = readings[-1]
        return readings

    def _progress(self, times: FloatArray) -> FloatArray:
        """How far a dying sensor is at `times` [s], from 0 to 1."""
        if self.settings.fault != "dying":
            return np.zeros(len(times))
        return np.clip((times - self.settings.fault_after) / self.settings.fault_time, 0.0, 1.0)


def _beside(flags: BoolArray, readings: FloatArray) -> BoolArray:
    """Shape a flag for each sample like a column beside readings of several axes."""
    return flags.reshape(-1, *[1] * (readings.ndim - 1))

"""The torque that the joint's driver reports: what it knows of it, how often, and how wrongly."""

import math
from dataclasses import dataclass

import numpy as np

from hd_monitor.arrays import FloatArray
from hd_monitor.parameter import choice, number

from ..drive.chunk import RigChunk
from ..drive.rig import Rig
from ..randomness import generator


@dataclass(frozen=True, slots=True, kw_only=True)
class EffortSettings:
    """The effort in joint_states."""

    effort: str = choice(
        "transmitted",
        ("transmitted", "mean", "reaction", "none"),
        "transmitted: the output's torque without the drive's ripple; mean: torque.mean; reaction: what "
        "the reducer transmits, vibration included; none: no effort",
    )
    effort_scale: float = number(1.0, "", -1e3, 1e3, "factor on the true effort")
    effort_bias: float = number(0.0, "N·m", -1e6, 1e6, "constant added to the effort")
    effort_noise: float = number(0.0, "N·m", 0.0, 1e6, "standard deviation of the effort's noise")
    effort_rate: float = number(
        0.0, "Hz", 0.0, 10_000.0, "measurements of the effort per second, each held until the next; 0: one a message"
    )


class EffortGauge:
    """Measures the effort at a rate of its own.

    Parameters
    ----------
    rig : Rig
    settings : EffortSettings
        May be replaced while it runs (attribute `settings`).
    seed : int
    """

    def __init__(self, rig: Rig, settings: EffortSettings, *, seed: int = 0) -> None:
        self.settings = settings
        self._rig = rig
        self._noise = generator(seed, "effort noise")
        self._held = math.nan  # known from the first measurement on

    def report(self, chunk: RigChunk, times: FloatArray, *, sign: float = 1.0) -> FloatArray | None:
        """Efforts [N·m] reported at `times` [s] within a stretch, or None; `sign` is the joint's sense."""
        settings = self.settings
        if settings.effort == "none":
            self._held = math.nan
            return None
        instants = instants_within(chunk, self._rig.rate, settings.effort_rate) if settings.effort_rate else times
        measured = sign * settings.effort_scale * self._true(chunk, instants) + settings.effort_bias
        measured = measured + settings.effort_noise * self._noise.standard_normal(instants.size)
        known = np.append(self._held, measured)
        self._held = float(known[-1])
        return known[np.searchsorted(instants, times, side="right")]

    def _true(self, chunk: RigChunk, times: FloatArray) -> FloatArray:
        match self.settings.effort:
            case "mean":
                return np.full(times.size, self._rig.model.torque.mean)
            case "reaction":
                return self._rig.reaction(times, chunk.vibration_at(times))
            case _:
                return self._rig.transmitted(times)


def instants_within(chunk: RigChunk, rig_rate: float, rate: float) -> FloatArray:
    """Instants [s] of a clock of `rate` [Hz] in a stretch sampled at `rig_rate` [Hz]; each belongs to one stretch."""
    first, last = (math.ceil(index * rate / rig_rate) for index in (chunk.first, chunk.first + len(chunk)))
    return np.arange(first, last) / rate

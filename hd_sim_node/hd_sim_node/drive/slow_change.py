"""What changes slowly: the drive as it warms up, and a defect that grows."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hd_monitor.arrays import FloatArray
from hd_monitor.parameter import choice, number

GROWTH_UNITS = ("seconds", "minutes", "hours", "strokes")
_SECONDS = {"seconds": 1.0, "minutes": 60.0, "hours": 3600.0}


@dataclass(frozen=True, slots=True, kw_only=True)
class Drift:
    """The drive's warming-up, an exponential approach to a steady state: the parameters ``drift.*``."""

    natural_frequency: float = number(0.0, "", -0.9, 9.0, "relative change of the natural frequency once warm")
    damping_ratio: float = number(0.0, "", -0.99, 99.0, "relative change of the damping ratio once warm")
    friction: float = number(0.0, "", -1.0, 99.0, "relative change of all friction once warm")
    time: float = number(600.0, "s", 0.1, 1e7, "time constant of warming up, 1 - exp(-t/time)")

    @property
    def any(self) -> bool:
        """Whether anything drifts."""
        return bool(self.natural_frequency or self.damping_ratio or self.friction)

    def warmth(self, times: FloatArray) -> FloatArray:
        """How warm the drive is at `times` [s], from 0 at the start towards 1."""
        return np.asarray(-np.expm1(-times / self.time))


class Growth(NamedTuple):
    """A factor on a spline's defect, and its rate [1/s]; of the shape of the times, or plain numbers."""

    factor: FloatArray | float = 1.0
    rate: FloatArray | float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DefectGrowth:
    """A defect that grows steadily and then stays: the parameters ``growth.*``.

    Both the stiffness fluctuation and the transmission error of a spline grow by its factor.
    """

    flexspline: float = number(1.0, "", 0.0, 1e3, "factor by which the flexspline's defect has grown in the end")
    circular_spline: float = number(1.0, "", 0.0, 1e3, "the same for the circular spline's")
    start: float = number(0.0, "", 0.0, 1e7, "when the growth begins, in growth.unit; it is linear")
    length: float = number(60.0, "", 1e-3, 1e7, "how long it takes, in growth.unit")
    unit: str = choice(
        "seconds", GROWTH_UNITS, "of growth.start and growth.length; strokes: it grows as each stroke begins"
    )

    @property
    def any(self) -> bool:
        """Whether anything grows."""
        return self.flexspline != 1.0 or self.circular_spline != 1.0

    @property
    def largest(self) -> tuple[float, float]:
        """Largest factors of the flexspline and of the circular spline."""
        return max(1.0, self.flexspline), max(1.0, self.circular_spline)

    def at(self, times: FloatArray, strokes: FloatArray) -> tuple[Growth, Growth]:
        """Growth of the flexspline's and the circular spline's defect.

        Parameters
        ----------
        times : ndarray
            [s] since the start, any shape.
        strokes : ndarray
            Strokes begun by then.
        """
        if not self.any:
            return Growth(), Growth()
        unit = _SECONDS.get(self.unit)
        progress = ((strokes if unit is None else times / unit) - self.start) / self.length
        rate = 0.0 if unit is None else ((progress >= 0.0) & (progress < 1.0)) / (self.length * unit)
        progress = np.clip(progress, 0.0, 1.0)

        def grown_to(final: float) -> Growth:
            return Growth(1.0 + (final - 1.0) * progress, (final - 1.0) * rate)

        return grown_to(self.flexspline), grown_to(self.circular_spline)

"""How much motion the evidence rests on."""

import math
from dataclasses import dataclass

import numpy as np

from ..segment.segment import Segment

_VARIES = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Coverage:
    """Sums over all segments used.

    Attributes
    ----------
    lowest, highest : float
        Limits of the output angle [rad].
    samples : int
        Samples of the sensor.
    time : float
        [s]
    way, squared : float
        Integrals of the output speed's magnitude [rad] and of its square [rad²/s].
    top_speed : float
        Highest output speed [rad/s].
    """

    lowest: float = math.inf
    highest: float = -math.inf
    samples: int = 0
    time: float = 0.0
    way: float = 0.0
    squared: float = 0.0
    top_speed: float = 0.0

    def plus(self, segment: Segment) -> "Coverage":
        """Add a segment."""
        speed = np.abs(segment.speed)
        return Coverage(
            lowest=min(self.lowest, float(segment.angle.min())),
            highest=max(self.highest, float(segment.angle.max())),
            samples=self.samples + segment.raw_samples,
            time=self.time + segment.duration,
            way=self.way + float(speed.sum()) * segment.period,
            squared=self.squared + float(speed @ speed) * segment.period,
            top_speed=max(self.top_speed, float(speed.max())),
        )

    @property
    def span(self) -> float:
        """Range of the output angle [rad]."""
        return max(self.highest - self.lowest, 0.0)

    @property
    def mean_speed(self) -> float:
        """Mean magnitude of the output speed [rad/s]."""
        return self.way / self.time if self.time else 0.0

    @property
    def speed_varies(self) -> bool:
        """Whether the speed varied by more than some per cent (standard deviation)."""
        variance = self.squared / self.time - self.mean_speed**2 if self.time else 0.0
        return variance > (_VARIES * self.mean_speed) ** 2

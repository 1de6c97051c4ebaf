"""The newest temperature, as long as it says something of the present."""

import math

from ..arrays import FloatArray, IntArray

FRESH = 300_000_000_000
"""Time [ns] for which a temperature holds: a joint warms up over many minutes, and its sensor may report rarely."""


class Thermometer:
    """Keeps the newest temperature that came."""

    def __init__(self) -> None:
        self._stamp = 0
        self._value = math.nan

    def add(self, stamps: IntArray, values: FloatArray) -> None:
        """Take temperatures [°C] with their stamps [ns], both of shape (N,); those that are not finite say nothing."""
        for stamp, value in zip(stamps.tolist(), values.tolist(), strict=True):
            if math.isfinite(value):
                self._stamp, self._value = stamp, value

    def at(self, stamp: int) -> float:
        """Return the temperature [°C] at a time [ns]; NaN where none is near."""
        return self._value if abs(stamp - self._stamp) <= FRESH else math.nan

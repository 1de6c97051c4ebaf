"""RMS of the vibration against speed: the paper's property curve (Figs. 16 and 18)."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class SpeedBin(NamedTuple):
    """One speed bin: its mean wave-generator speed [rpm], the RMS there and the samples behind it."""

    rpm: float
    rms: float
    samples: int


class RmsAccumulator:
    """Collects squares per bin of wave-generator speed; bins are centred on multiples of the width.

    Parameters
    ----------
    width : float
        Bin width [rpm].
    """

    def __init__(self, width: float) -> None:
        self._width = width
        self._sums: dict[int, tuple[float, float, int]] = {}

    def add(self, speed_rpm: npt.ArrayLike, values: npt.ArrayLike) -> None:
        """Add samples (NaN ones are left out): wave-generator speeds [rpm] and values, both of shape (N,)."""
        speed = np.abs(np.asarray(speed_rpm, dtype=np.float64))
        value = np.asarray(values, dtype=np.float64)
        good = np.isfinite(speed) & np.isfinite(value)
        speed, value = speed[good], value[good]
        if not speed.size:
            return
        number = np.rint(speed / self._width).astype(np.int64)
        lowest = int(number.min())
        number -= lowest
        count, speeds, powers = np.bincount(number), np.bincount(number, speed), np.bincount(number, value * value)
        for offset in np.flatnonzero(count).tolist():
            total, power, samples = self._sums.get(lowest + offset, (0.0, 0.0, 0))
            self._sums[lowest + offset] = (
                total + float(speeds[offset]),
                power + float(powers[offset]),
                samples + int(count[offset]),
            )

    def curve(self) -> tuple[SpeedBin, ...]:
        """Return the bins that have samples, by rising speed."""
        return tuple(
            SpeedBin(total / samples, math.sqrt(power / samples), samples)
            for _, (total, power, samples) in sorted(self._sums.items())
        )

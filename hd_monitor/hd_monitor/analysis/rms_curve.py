"""RMS of the vibration against speed: the paper's property curve (Figs. 16 and 18)."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class SpeedBin(NamedTuple):
    """One speed bin: its mean wave-generator speed [rpm], the RMS there and the samples behind it."""

    rpm: float
    rms: float
    samples: int


@dataclass(frozen=True, slots=True, eq=False)
class RmsCurve:
    """RMS per speed bin.

    Attributes
    ----------
    bins : tuple of SpeedBin
        Bins that have samples, by rising speed.
    """

    bins: tuple[SpeedBin, ...] = ()


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
        self._bins: dict[int, SpeedBin] = {}
        self._curve: RmsCurve | None = RmsCurve()

    def add(self, speed_rpm: npt.ArrayLike, values: npt.ArrayLike) -> None:
        """Add samples (NaN ones are left out): wave-generator speeds [rpm] and values, both of shape (N,)."""
        speed = np.abs(np.asarray(speed_rpm, dtype=np.float64))
        value = np.asarray(values, dtype=np.float64)
        good = np.isfinite(speed) & np.isfinite(value)
        if not good.all():
            speed, value = speed[good], value[good]
        if not speed.size:
            return
        number = np.rint(speed / self._width).astype(np.int64)
        lowest = int(number.min())
        count = np.bincount(number - lowest)
        squares = np.bincount(number - lowest, value * value)
        speeds = np.bincount(number - lowest, speed)
        for offset in np.flatnonzero(count).tolist():
            old = self._sums.get(lowest + offset, (0.0, 0.0, 0))
            total, power = old[0] + float(speeds[offset]), old[1] + float(squares[offset])
            samples = old[2] + int(count[offset])
            self._sums[lowest + offset] = total, power, samples
            self._bins[lowest + offset] = SpeedBin(total / samples, math.sqrt(power / samples), samples)
        self._curve = None

    def curve(self) -> RmsCurve:
        """Return the curve collected so far."""
        if self._curve is None:
            self._curve = RmsCurve(tuple(self._bins[number] for number in sorted(self._bins)))
        return self._curve

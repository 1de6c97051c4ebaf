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
        if not math.isfinite(float(speed.sum() + value.sum())):  # rarely so, and cheaper to ask
            good = np.isfinite(speed) & np.isfinite(value)
            speed, value = speed[good], value[good]
        if not speed.size:
            return
        lowest, highest = (round(float(end) / self._width) for end in (speed.min(), speed.max()))
        squares = value * value
        if lowest == highest:
            self._add_to_bin(lowest, float(speed.sum()), float(squares.sum()), speed.size)
        else:
            number = np.rint(speed / self._width).astype(np.int64) - lowest
            count, speeds, powers = np.bincount(number), np.bincount(number, speed), np.bincount(number, squares)
            for offset in np.flatnonzero(count).tolist():
                self._add_to_bin(lowest + offset, float(speeds[offset]), float(powers[offset]), int(count[offset]))
        self._curve = None

    def _add_to_bin(self, number: int, speeds: float, squares: float, samples: int) -> None:
        old = self._sums.get(number, (0.0, 0.0, 0))
        total, power, count = old[0] + speeds, old[1] + squares, old[2] + samples
        self._sums[number] = total, power, count
        self._bins[number] = SpeedBin(total / count, math.sqrt(power / count), count)

    def curve(self) -> RmsCurve:
        """Return the curve collected so far."""
        if self._curve is None:
            self._curve = RmsCurve(tuple(self._bins[number] for number in sorted(self._bins)))
        return self._curve

"""RMS of the vibration against speed: the paper's property curve (Figs. 16 and 18)."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray


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
        self._sums: dict[int, FloatArray] = {}  # by the number of the bin: of speeds, of squares, of ones

    def add(self, speed_rpm: npt.ArrayLike, values: npt.ArrayLike) -> None:
        """Add samples (NaN ones are left out): wave-generator speeds [rpm] and values, both of shape (N,)."""
        speed = np.abs(np.asarray(speed_rpm, dtype=np.float64))
        value = np.asarray(values, dtype=np.float64)
        if not (good := np.isfinite(speed) & np.isfinite(value)).all():
            speed, value = speed[good], value[good]
        if not speed.size:
            return
        first, last = (round(float(end) / self._width) for end in (speed.min(), speed.max()))
        if first == last:  # the usual case, at a tenth of the cost
            own = np.array([float(speed.sum()), float(value @ value), float(speed.size)])
            self._sums[first] = self._sums.get(first, 0.0) + own
            return
        place = np.rint(speed / self._width).astype(np.int64) - first
        sums = np.stack([np.bincount(place, speed), np.bincount(place, value * value), np.bincount(place)], axis=1)
        for offset in np.flatnonzero(sums[:, 2]).tolist():
            self._sums[first + offset] = self._sums.get(first + offset, 0.0) + sums[offset]

    def curve(self) -> tuple[SpeedBin, ...]:
        """Return the bins that have samples, by rising speed."""
        return tuple(
            SpeedBin(total / samples, math.sqrt(power / samples), int(samples))
            for total, power, samples in (self._sums[number].tolist() for number in sorted(self._sums))
        )

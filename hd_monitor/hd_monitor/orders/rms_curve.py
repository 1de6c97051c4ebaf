"""RMS of the vibration against speed: the paper's property curve (Figs. 16 and 18)."""

import math
from collections.abc import Iterable, Sequence
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

    def include(self, curve: Sequence[SpeedBin], times: int = 1) -> None:
        """Add the samples behind a curve of this width, or with `times` = -1 take them away."""
        for rpm, rms, samples in curve:
            place = round(rpm / self._width)
            own = times * samples * np.array([rpm, rms * rms, 1.0])
            self._sums[place] = self._sums.get(place, 0.0) + own

    def curve(self) -> tuple[SpeedBin, ...]:
        """Return the bins that have samples, by rising speed."""
        return tuple(
            SpeedBin(total / samples, math.sqrt(max(power, 0.0) / samples), round(samples))
            for total, power, samples in (self._sums[number].tolist() for number in sorted(self._sums))
            if samples > 0.0
        )


def pooled_curve(curves: Iterable[Sequence[SpeedBin]], width: float) -> tuple[SpeedBin, ...]:
    """Return the curve of all samples behind some curves with bins of one width [rpm]."""
    total = RmsAccumulator(width)
    for curve in curves:
        total.include(curve)
    return total.curve()


def curve_since(now: Sequence[SpeedBin], before: Sequence[SpeedBin], width: float) -> tuple[SpeedBin, ...]:
    """Return the curve of the samples that came since an earlier state of it; all of it where it began anew."""
    known = {round(b.rpm / width): b.samples for b in now}
    if any(known.get(round(b.rpm / width), 0) < b.samples for b in before):
        return tuple(now)
    added = RmsAccumulator(width)
    added.include(now)
    added.include(before, -1)
    return added.curve()


def rms_growth(now: Sequence[SpeedBin], baseline: Sequence[SpeedBin], width: float) -> float:
    """Return by how much the RMS has grown, as a fraction, at the speeds of now that the baseline has; else NaN."""
    known = {round(b.rpm / width): b.rms for b in baseline}
    common = [(b.samples, b.rms, known[place]) for b in now if (place := round(b.rpm / width)) in known]
    present, past = (math.fsum(row[0] * row[side] ** 2 for row in common) for side in (1, 2))
    return math.sqrt(present / past) - 1.0 if past > 0.0 else math.nan

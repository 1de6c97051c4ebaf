"""Amplitudes of the characteristic lines at each speed, by regression with known orders on the joint's angle."""

from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...orders.regression import line_columns, solve_normal
from ...reducer import LinePair
from .speed_bins import SpeedBins

_WORST_CONDITION = 12.0  # about a third of the travel that separates the first pair by Fourier means
_FASTEST_CHANGE = 1.5  # bins a record: faster, the vibration does not follow the speed


class SpeedLines(NamedTuple):
    """Amplitudes [rad/s²] of the k-th pair's lines at one speed, and their standard deviations."""

    rpm: float
    k: int
    amplitude: LinePair
    std: LinePair


class _Sums(NamedTuple):
    """Inner products of the columns of one speed bin and direction, the signal last, and the sum of its speeds."""

    matrix: FloatArray
    speeds: float
    samples: int

    def plus(self, other: "_Sums") -> "_Sums":
        return _Sums(self.matrix + other.matrix, self.speeds + other.speeds, self.samples + other.samples)


class LinesBySpeed:
    """Collects the line amplitudes from successive records; its size does not grow with them.

    Directions are kept apart, since phases differ between them; of each speed the direction with more samples shows.

    Parameters
    ----------
    speeds : SpeedBins
    harmonics : int
        Number of line pairs.
    """

    def __init__(self, speeds: SpeedBins, harmonics: int) -> None:
        self._speeds = speeds
        self._harmonics = harmonics
        self._bins: dict[tuple[int, bool], _Sums] = {}

    def add(self, record: Record) -> None:
        """Take a record's samples, each in its speed bin."""
        rpm = self._speeds.rpm(record)
        good = np.isfinite(record.acceleration) & self._speeds.turning(rpm)
        if not good.any() or float(np.ptp(rpm)) > _FASTEST_CHANGE * self._speeds.width:
            return
        rpm, values = rpm[good], record.acceleration[good]
        orders = [k * order for k in range(1, self._harmonics + 1) for order in self._speeds.reducer.output_orders]
        columns = np.column_stack([line_columns(record.angle[good], orders), np.ones(values.size), values])
        signed = self._speeds.number(rpm) * np.where(rpm < 0, -1, 1)
        for key in np.unique(signed).tolist():
            mine = columns[signed == key]
            sums = _Sums(mine.T @ mine, float(np.abs(rpm[signed == key]).sum()), len(mine))
            old = self._bins.get((abs(key), key < 0))
            self._bins[abs(key), key < 0] = sums if old is None else old.plus(sums)

    def result(self) -> list[SpeedLines]:
        """Return the amplitudes by rising speed; speeds whose travel does not separate the lines are left out."""
        chosen: dict[int, _Sums] = {}
        for (number, _), sums in self._bins.items():
            if number not in chosen or sums.samples > chosen[number].samples:
                chosen[number] = sums
        return [lines for _, sums in sorted(chosen.items()) for lines in self._solve(sums)]

    def _solve(self, sums: _Sums) -> list[SpeedLines]:
        size, lines = len(sums.matrix) - 1, 2 * self._harmonics
        found = solve_normal(sums.matrix, np.arange(size), _WORST_CONDITION) if sums.samples > size else None
        if found is None:
            return []
        solution, inverse = found
        rest = max(float(sums.matrix[-1, -1] - solution @ sums.matrix[:-1, -1]), 0.0) / (sums.samples - size)
        # Rows: real and imaginary parts; then pair by pair
        amplitude = np.linalg.norm(solution[: 2 * lines].reshape(2, -1, 2), axis=0)
        std = np.sqrt(rest * inverse.diagonal()[: 2 * lines].reshape(2, -1, 2).mean(axis=0))
        rpm = sums.speeds / sums.samples
        return [
            SpeedLines(rpm, k, LinePair(*pair), LinePair(*errors))
            for k, (pair, errors) in enumerate(zip(amplitude.tolist(), std.tolist(), strict=True), start=1)
        ]

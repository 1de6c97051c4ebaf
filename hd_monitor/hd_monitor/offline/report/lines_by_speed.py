"""Amplitudes of the characteristic lines at each speed, by regression with known orders on the joint's angle."""

from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...orders.regression import line_columns, solve_normal
from ...reducer import LinePair
from .speed_bins import SpeedBins

_WORST_CONDITION = 12.0  # about a third of the travel that separates the first pair by Fourier means
_ONES, _SPEED = -3, -2  # columns behind those of the lines; the signal is the last
_FASTEST_CHANGE = 1.5  # bins a record: faster, the vibration does not follow the speed


class SpeedLines(NamedTuple):
    """Amplitudes [rad/s²] of the k-th pair's lines at one speed, and their standard deviations."""

    rpm: float
    k: int
    amplitude: LinePair
    std: LinePair


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
        self._bins: dict[tuple[int, bool], FloatArray] = {}  # inner products, by number and direction

    def add(self, record: Record) -> None:
        """Take a record's samples, each in its speed bin."""
        rpm = self._speeds.rpm(record)
        good = np.isfinite(record.acceleration) & self._speeds.turning(rpm)
        if not good.any() or float(np.ptp(rpm)) > _FASTEST_CHANGE * self._speeds.width:
            return
        rpm, values = rpm[good], record.acceleration[good]
        orders = [k * order for k in range(1, self._harmonics + 1) for order in self._speeds.reducer.output_orders]
        lines = line_columns(record.angle[good], orders)
        columns = np.column_stack([lines, np.ones(values.size), np.abs(rpm), values])
        signed = self._speeds.number(rpm) * np.where(rpm < 0, -1, 1)
        for key in np.unique(signed).tolist():
            mine, place = columns[signed == key], (abs(key), key < 0)
            self._bins[place] = self._bins.get(place, 0.0) + mine.T @ mine

    def result(self) -> list[SpeedLines]:
        """Return the amplitudes by rising speed; speeds whose travel does not separate the lines are left out."""
        chosen: dict[int, FloatArray] = {}
        for (number, _), sums in self._bins.items():
            if number not in chosen or sums[_ONES, _ONES] > chosen[number][_ONES, _ONES]:
                chosen[number] = sums
        return [lines for _, sums in sorted(chosen.items()) for lines in self._solve(sums)]

    def _solve(self, sums: FloatArray) -> list[SpeedLines]:
        size, lines, samples = len(sums) - 2, 2 * self._harmonics, float(sums[_ONES, _ONES])
        found = solve_normal(sums, np.arange(size), _WORST_CONDITION) if samples > size else None
        if found is None:
            return []
        solution, inverse = found
        rest = max(float(sums[-1, -1] - solution @ sums[:size, -1]), 0.0) / (samples - size)
        # Rows: real and imaginary parts; then pair by pair
        amplitude = np.linalg.norm(solution[: 2 * lines].reshape(2, -1, 2), axis=0)
        std = np.sqrt(rest * inverse.diagonal()[: 2 * lines].reshape(2, -1, 2).mean(axis=0))
        rpm = float(sums[_ONES, _SPEED]) / samples
        return [
            SpeedLines(rpm, k, LinePair(*pair), LinePair(*errors))
            for k, (pair, errors) in enumerate(zip(amplitude.tolist(), std.tolist(), strict=True), start=1)
        ]

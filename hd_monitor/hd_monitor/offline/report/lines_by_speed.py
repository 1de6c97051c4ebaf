"""Amplitudes of the characteristic lines at each speed, by regression with known orders on the joint's angle."""

from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...reducer import LinePair
from .speed_bins import SpeedBins

_WORST_CONDITION = 12.0  # about a third of the travel that parts the first pair by Fourier means
_FASTEST_CHANGE = 1.5  # bins a record: faster, the vibration does not follow the speed


class SpeedLines(NamedTuple):
    """Amplitudes [rad/s²] of the k-th pair's lines at one speed, and their standard deviations."""

    rpm: float
    k: int
    amplitude: LinePair
    std: LinePair


class _Normal:
    """Normal equations of one speed bin and direction."""

    def __init__(self, columns: int) -> None:
        self.gram = np.zeros((columns, columns))
        self.right = np.zeros(columns)
        self.squares = 0.0
        self.speeds = 0.0
        self.count = 0

    def add(self, columns: FloatArray, values: FloatArray, rpm: FloatArray) -> None:
        self.gram += columns.T @ columns
        self.right += columns.T @ values
        self.squares += float(values @ values)
        self.speeds += float(np.abs(rpm).sum())
        self.count += values.size


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
        self._bins: dict[tuple[int, bool], _Normal] = {}

    def add(self, record: Record) -> None:
        """Take a record's samples, each in its speed bin."""
        rpm = self._speeds.rpm(record)
        good = np.isfinite(record.acceleration) & self._speeds.turning(rpm)
        if not good.any() or float(np.ptp(rpm)) > _FASTEST_CHANGE * self._speeds.width:
            return
        rpm, values = rpm[good], record.acceleration[good]
        columns = self._columns(record.angle[good])
        signed = self._speeds.number(rpm) * np.where(rpm < 0, -1, 1)
        for key in np.unique(signed).tolist():
            mine = signed == key
            normal = self._bins.setdefault((abs(key), key < 0), _Normal(columns.shape[1]))
            normal.add(columns[mine], values[mine], rpm[mine])

    def _columns(self, angle: FloatArray) -> FloatArray:
        orders = self._speeds.reducer.output_orders
        phases = np.array([k * order for k in range(1, self._harmonics + 1) for order in orders])
        arguments = np.multiply.outer(angle, phases)
        return np.concatenate([np.cos(arguments), np.sin(arguments), np.ones((angle.size, 1))], axis=1)

    def result(self) -> list[SpeedLines]:
        """Return the amplitudes by rising speed; speeds at which the travel does not part the lines are left out."""
        chosen: dict[int, _Normal] = {}
        for (number, _), normal in self._bins.items():
            if number not in chosen or normal.count > chosen[number].count:
                chosen[number] = normal
        return [lines for _, normal in sorted(chosen.items()) for lines in self._solve(normal)]

    def _solve(self, normal: _Normal) -> list[SpeedLines]:
        size = normal.right.size
        scale = np.sqrt(np.maximum(np.diag(normal.gram), 1e-300))
        scaled = normal.gram / np.outer(scale, scale)
        if normal.count <= size or np.linalg.cond(scaled) > _WORST_CONDITION:
            return []
        inverse = np.linalg.inv(scaled) / np.outer(scale, scale)
        solution = inverse @ normal.right
        rest = max(normal.squares - float(solution @ normal.right), 0.0) / (normal.count - size)
        half = (size - 1) // 2
        amplitude = np.hypot(solution[:half], solution[half : 2 * half])
        variance = rest * 0.5 * (np.diag(inverse)[:half] + np.diag(inverse)[half : 2 * half])
        std = np.sqrt(variance)
        rpm = normal.speeds / normal.count
        return [
            SpeedLines(
                rpm,
                k,
                LinePair(float(amplitude[2 * k - 2]), float(amplitude[2 * k - 1])),
                LinePair(float(std[2 * k - 2]), float(std[2 * k - 1])),
            )
            for k in range(1, self._harmonics + 1)
        ]

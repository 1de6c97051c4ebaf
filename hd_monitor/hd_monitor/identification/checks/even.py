"""Recent records on one even grid, and the lines that a reducer would put into them: what the checks correlate."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ...acquisition.record import Record
from ...arrays import ComplexArray, FloatArray
from ...model.parameters import Dynamics
from ...reducer import Reducer

WINDOW = 1.0
"""Time [s] over which lines are looked at coherently."""

_RATE = 500.0  # Hz, to which faster signals are averaged
_SPARSEST = 10.0  # places on the grid for each sample
_BAND = 0.8  # of half the sampling rate


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EvenSignal:
    """Vibration and motion.

    Attributes
    ----------
    vibration : ndarray, shape (N,)
        θ'' less its mean [rad/s²]; 0 where unknown.
    angle, speed : ndarray, shape (N,)
        Of the output [rad], [rad/s].
    torque : ndarray, shape (N,)
        Over its root mean square; 1 where it is not measured throughout.
    period : float
        [s]
    """

    vibration: FloatArray
    angle: FloatArray
    speed: FloatArray
    torque: FloatArray
    period: float

    @classmethod
    def of(cls, records: Sequence[Record]) -> "EvenSignal | None":
        """Return what records, by time, hold; None without a vibration, or if they are far apart."""
        if not records:
            return None
        period, start = records[-1].period, records[0].start
        times, angle, speed, torque, vibration = (
            np.concatenate([getattr(record, name) for record in records])
            for name in ("times", "angle", "speed", "torque", "acceleration")
        )
        known = np.isfinite(vibration)
        size = round((float(times[-1]) - start) / period) + 1
        if not known.any() or size > _SPARSEST * times.size:
            return None
        even = np.zeros(size)
        places = np.clip(np.rint((times[known] - start) / period).astype(np.intp), 0, size - 1)
        even[places] = vibration[known] - float(np.mean(vibration[known]))
        grid = start + period * np.arange(size)
        level = float(np.sqrt(np.mean(torque**2)))
        relative = torque / level if level > 0.0 else np.ones(torque.size)  # NaN is kept
        rows = np.stack([even, *(np.interp(grid, times, values) for values in (angle, speed, relative))])
        together = max(1, int(1.0 / (period * _RATE)))
        rows = rows[:, size % together :].reshape(4, -1, together).mean(axis=2)
        if not np.isfinite(rows[3]).all():
            rows[3] = 1.0
        return cls(vibration=rows[0], angle=rows[1], speed=rows[2], torque=rows[3], period=period * together)

    def __len__(self) -> int:
        """Return the number of samples."""
        return int(self.vibration.size)

    @property
    def power(self) -> float:
        """Sum of the vibration's squares."""
        return float(self.vibration @ self.vibration)

    def lines(
        self, reducer: Reducer, dynamics: Dynamics, harmonics: int, *, length: int, torque: bool = False
    ) -> Iterator[list[ComplexArray]]:
        """Yield the spectra of each pair's lines, shape (length,), as the resonator lets them pass.

        Parameters
        ----------
        reducer : Reducer
        dynamics : Dynamics
            It need not be exact.
        harmonics : int
            Pairs of lines.
        length : int
            Of the spectra, samples; at least that of the signal.
        torque : bool
            Whether each line comes once more in proportion to the torque.
        """
        frequency = scipy.fft.fftfreq(length, self.period)
        response = (frequency / dynamics.natural_frequency) ** 2 * dynamics.receptance(frequency)
        for k in range(1, harmonics + 1):
            found = []
            for order in reducer.output_orders:
                seen = np.abs(k * order * self.speed) * self.period < _BAND * math.pi
                line = seen * np.exp(1j * k * order * self.angle)
                found += [
                    response * scipy.fft.fft(each, length)
                    for each in ((line, self.torque * line) if torque else (line,))
                ]
            yield found

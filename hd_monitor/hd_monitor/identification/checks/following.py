"""Whether the vibration near the lines follows the joint's angle, or belongs to something else that moves."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...model.parameters import Dynamics
from ...reducer import Reducer
from .even import WINDOW, EvenSignal

_RIDGE = 1e-3  # of the lines' power: where a window does not separate the two of a pair


class LineShares(NamedTuple):
    """Parts of a vibration's power that lines explain beyond what they would of noise; above 1 where pairs overlap."""

    by_window: float
    """With amplitudes and phases of their own in each window: whatever is near the lines' orders."""
    throughout: float
    """With the same amplitudes and phases throughout, those in proportion to the torque included: a reducer's."""


def line_shares(records: Sequence[Record], reducer: Reducer, dynamics: Dynamics, harmonics: int) -> LineShares:
    """Return the parts of the power in records, by time, that lines explain; 0 where there is no vibration.

    A spline's line is tied to the output angle: its phase in one window is that in all others. What another joint or a
    machine puts near the lines is not, and adds up to nothing. `dynamics` need not be exact.
    """
    signal = EvenSignal.of(records)
    if signal is None or not signal.power > 0.0:
        return LineShares(0.0, 0.0)
    size = len(signal)
    width = min(round(WINDOW / signal.period), size)
    explained, by_chance = np.zeros(2), np.zeros(2)
    for spectra in signal.lines(reducer, dynamics, harmonics, length=scipy.fft.next_fast_len(2 * size), torque=True):
        lines = np.array([scipy.fft.ifft(spectrum)[:size] for spectrum in spectra])
        windows = (slice(first, first + width) for first in range(size % width, size, width))
        explained += [
            sum(_explained(lines[::2, window], signal.vibration[window]) for window in windows),
            _explained(lines, signal.vibration),
        ]
        by_chance += len(lines) / width, 2 * len(lines) / size  # real columns over samples
    by_window, throughout = np.maximum(explained / signal.power - by_chance, 0.0).tolist()
    return LineShares(by_window, throughout)


def _explained(lines: np.ndarray, vibration: FloatArray) -> float:
    """Power of a vibration, shape (N,), that complex lines, shape (lines, N), explain by least squares."""
    columns = np.concatenate([lines.real, lines.imag])
    products = columns @ columns.T
    products += (_RIDGE * float(np.trace(products)) / len(products) + 1e-300) * np.eye(len(products))
    right = columns @ vibration
    return float(right @ np.linalg.solve(products, right))

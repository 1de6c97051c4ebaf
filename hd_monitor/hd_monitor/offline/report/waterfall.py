"""Spectra over time, in bounded memory."""

import itertools
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from .spectra import filled, hann_amplitude, whole_runs

_BINS = 250
_MOST_ROWS = 400
_SHORTEST = 64  # samples


class Waterfall(NamedTuple):
    """Spectra over time."""

    times: FloatArray
    """Middle of each spectrum's stretch [s], relative to the monitor's epoch, rising, shape (rows,)."""
    frequencies: FloatArray
    """[Hz], shape (bins,)."""
    amplitude: FloatArray
    """Largest peak amplitude of each bin [rad/s²], shape (rows, bins)."""


class WaterfallAccumulator:
    """Collects a spectrum a record; where there are too many, neighbours are merged by their larger values."""

    def __init__(self) -> None:
        self._rows: list[tuple[float, float, FloatArray]] = []  # first time, last time, amplitudes
        self._nyquist = 0.0
        self._together = 1
        self._waiting = 0

    def add(self, record: Record) -> None:
        """Take a record."""
        nyquist = 0.5 / record.period
        if len(record) < _SHORTEST or (self._nyquist and abs(nyquist / self._nyquist - 1.0) > 0.02):
            return
        if len(whole_runs(record.acceleration)) != 1:
            return  # a bridged hole would show as vibration at all frequencies
        self._nyquist = self._nyquist or nyquist
        fine = hann_amplitude(filled(record.acceleration))
        # Where a short record has fewer lines than there are bins, bins without one take their neighbour's.
        row = np.maximum.reduceat(fine, np.arange(_BINS) * fine.size // _BINS)
        first, last = record.start, record.start + record.period * len(record)
        if self._waiting and self._rows:
            begun, _, old = self._rows[-1]
            self._rows[-1] = (begun, last, np.maximum(old, row))
        else:
            self._rows.append((first, last, row))
        self._waiting = (self._waiting + 1) % self._together
        if len(self._rows) > _MOST_ROWS:
            pairs = itertools.batched(self._rows[:_MOST_ROWS], 2)
            self._rows = [(a[0], b[1], np.maximum(a[2], b[2])) for a, b in pairs]
            self._together *= 2
            self._waiting = 0

    def result(self) -> Waterfall | None:
        """Return the waterfall; None with fewer than two spectra."""
        if len(self._rows) < 2:
            return None
        first, last, amplitude = map(np.array, zip(*sorted(self._rows, key=itemgetter(0)), strict=True))
        return Waterfall(0.5 * (first + last), (np.arange(_BINS) + 0.5) * self._nyquist / _BINS, amplitude)

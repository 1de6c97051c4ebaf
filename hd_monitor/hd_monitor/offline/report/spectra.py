"""Spectra that only a report needs: over frequency, over order, and over order and speed."""

import math
from typing import NamedTuple

import numpy as np
from scipy.signal import get_window

from ...acquisition.record import Record
from ...arrays import FloatArray
from .speed_bins import SpeedBins

_SHORTEST_PIECE = 0.25  # s
_SMALL_HOLE = 3  # samples
_STANDING_PARTS = 1e-9


class Spectrum(NamedTuple):
    """Peak amplitude over an axis; a sine of amplitude A shows A."""

    axis: FloatArray
    """Frequencies [Hz] or orders, shape (bins,)."""
    amplitude: FloatArray
    """In the signal's unit, shape (bins,)."""


class OrderMap(NamedTuple):
    """Amplitude over wave-generator speed and order; NaN where nothing was measured."""

    speeds: FloatArray
    """Wave-generator speeds [rpm], rising, shape (speeds,)."""
    orders: FloatArray
    """Cycles per wave-generator revolution, shape (orders,)."""
    amplitude: FloatArray
    """Root mean square over the recording of the peak amplitudes [rad/s²], shape (speeds, orders)."""


def filled(values: FloatArray) -> FloatArray:
    """Bridge missing samples linearly and remove the mean."""
    known = np.isfinite(values)
    if not known.any():
        return np.zeros_like(values)
    if not known.all():
        place = np.arange(values.size)
        values = np.interp(place, place[known], values[known])
    return values - values.mean()


def hann_amplitude(values: FloatArray) -> FloatArray:
    """Peak amplitudes over the Fourier frequencies of evenly spaced values, under a Hann window."""
    window = get_window("hann", values.size)
    return np.asarray(2.0 * np.abs(np.fft.rfft(window * values)) / window.sum())


def whole_runs(values: FloatArray) -> list[tuple[int, int]]:
    """Bounds of the stretches without a hole of more than a few samples; a lone spike left out does not count."""
    missing = np.concatenate([[False], ~np.isfinite(values), [False]]).astype(np.int8)
    edges = np.flatnonzero(np.diff(missing))
    holes = [(a, b) for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True) if b - a > _SMALL_HOLE]
    bounds = [0, *(edge for hole in holes for edge in hole), values.size]
    return [(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True) if b > a]


def amplitude_spectrum(record: Record) -> Spectrum:
    """Amplitude spectrum of θ'' [rad/s²] over frequency [Hz], Hann window."""
    values = filled(record.acceleration)
    return Spectrum(np.fft.rfftfreq(values.size, record.period), hann_amplitude(values))


def order_spectrum(angle: FloatArray, values: FloatArray, orders: FloatArray) -> Spectrum:
    """Amplitude over order of samples at any angles, strokes back and forth included.

    Parameters
    ----------
    angle : ndarray, shape (samples,)
        Absolute output angle [rad].
    values : ndarray, shape (samples,)
        The signal, trends removed; missing samples are NaN.
    orders : ndarray, shape (orders,)
        Cycles per output revolution.

    Notes
    -----
    Every sample counts by the way travelled since the one before, and by a Hann window over the travel covered, so
    that the resolution is two cycles per travel however often the same arc was passed.
    """
    way = np.abs(np.gradient(angle)) if angle.size > 1 else np.zeros_like(angle)
    good = np.isfinite(values) & (way > _STANDING_PARTS * math.tau)
    angle, values, way = angle[good], values[good], way[good]
    if angle.size < 2:
        return Spectrum(orders, np.zeros_like(orders))
    way = np.minimum(way, 4.0 * float(np.median(way)))  # one sample has not travelled the way across a hole in the data
    first, span = float(angle.min()), float(np.ptp(angle)) or 1.0
    weight = way * (0.5 - 0.5 * np.cos(math.tau * (angle - first) / span))
    signal = weight * values
    amplitude = np.array([abs(np.dot(signal, np.exp(-1j * order * angle))) for order in orders.tolist()])
    return Spectrum(orders, np.asarray(2.0 * amplitude / max(float(weight.sum()), 1e-300)))


class OrderMapAccumulator:
    """Collects an order map from successive records; its size does not grow with them.

    Parameters
    ----------
    speeds : SpeedBins
    highest : float
        Highest order shown.
    """

    _STEP = 0.05

    def __init__(self, speeds: SpeedBins, highest: float) -> None:
        self._speeds = speeds
        self._orders = np.arange(0.0, highest + self._STEP / 2, self._STEP)
        self._squares: dict[int, FloatArray] = {}  # sum and count, shape (2, orders)

    def add(self, record: Record) -> None:
        """Take the pieces of a record in which the joint turns one way."""
        rpm = self._speeds.rpm(record)
        turning = np.where(self._speeds.turning(rpm), np.sign(rpm), 0.0)
        edges = np.flatnonzero(np.diff(turning)) + 1
        values = filled(record.acceleration)
        if len(whole_runs(record.acceleration)) != 1:
            return  # a bridged hole would show as vibration at all orders; the speed comes again
        for first, last in zip([0, *edges.tolist()], [*edges.tolist(), len(record)], strict=True):
            if turning[first] and (last - first) * record.period >= _SHORTEST_PIECE:
                self._piece(record.angle[first:last] * turning[first], values[first:last], rpm[first:last])

    def _piece(self, angle: FloatArray, values: FloatArray, rpm: FloatArray) -> None:
        if not bool((np.diff(angle) > 0).all()):
            return
        revolutions = float(angle[-1] - angle[0]) * self._speeds.reducer.reduction / math.tau
        even = np.interp(np.linspace(angle[0], angle[-1], angle.size), angle, values)
        amplitude = hann_amplitude(even - even.mean())
        orders = np.arange(amplitude.size) / revolutions
        if orders[1] >= self._STEP:
            shown = np.interp(self._orders, orders, amplitude, right=np.nan)
        else:
            shown = np.zeros(self._orders.size)
            place = np.rint(orders / self._STEP).astype(np.int64)
            inside = place < shown.size
            np.maximum.at(shown, place[inside], amplitude[inside])
            shown[self._orders > orders[-1]] = np.nan
        number = int(self._speeds.number(np.abs(rpm).mean(keepdims=True))[0])
        known = np.isfinite(shown)
        self._squares[number] = self._squares.get(number, 0.0) + np.array([np.where(known, shown**2, 0.0), known])

    def result(self) -> OrderMap | None:
        """Return the map; None if the joint never turned."""
        if not self._squares:
            return None
        numbers = sorted(self._squares)
        total, count = np.stack([self._squares[number] for number in numbers], axis=1)
        mean = np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)
        return OrderMap(np.array(numbers) * self._speeds.width, self._orders, np.sqrt(mean))

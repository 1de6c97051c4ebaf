"""Whether the vibration fits the motion better at other times than their stamps say: two clocks, or a late stamp."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import fft

from ...acquisition.record import Record
from ...arrays import ComplexArray, FloatArray
from ...limitation import Limitation, LimitationCode, blocker
from ...model.parameters import Dynamics
from ...reducer import Reducer

WINDOW = 1.0
"""Time [s] over which lines are correlated coherently: a clock that is 2 % wrong shifts little within it."""

REACH, FASTEST = 2.5, 0.03
"""Delay [s] and relative error of a clock up to which they are looked for."""

_RATE_STEP = 1e-3
_RATE = 500.0  # Hz, to which faster signals are averaged, as far as their highest line lies a quarter below
_RIDGE = 0.03  # of the lines' power: where a window does not separate the two
_BAND = 0.8  # of half the sampling rate
_LEAST_SECONDS = 3.0
_LEAST_DELAY = 0.01  # s; less is fitted along
_BETTER = 1.08  # explained power, over that with the stamps as they are, from which others are believed
_MOST = 0.7  # of the vibration's power that must be explained then: chance explains less
_CLEARLY = 1.08  # explained power with a clock of another rate, over the best that a delay alone explains
_AS_GOOD = 0.6  # part of the best explained power at another delay, where less motion overlaps, that repeats it


class _Signal(NamedTuple):
    """Vibration [rad/s²] and motion [rad, rad/s] on one even grid, shape (N,), with its period [s]."""

    vibration: FloatArray
    angle: FloatArray
    speed: FloatArray
    period: float


def compare_stamps(
    records: Sequence[Record], reducer: Reducer, dynamics: Dynamics, harmonics: int
) -> Limitation | None:
    """Return by how much the stamps of vibration and joint states are apart; None where they are not, or none can tell.

    At a steady speed every delay fits alike. Where the speed changes, the lines change with it, and fit the motion at
    one delay only.

    Parameters
    ----------
    records : sequence of Record
        Recent motion, by time.
    reducer : Reducer
    dynamics : Dynamics
        Whose response the lines have passed; it need not be exact.
    harmonics : int
        Pairs of lines looked at.
    """
    signal = _on_one_grid(records)
    if signal is None or signal.vibration.size * signal.period < _LEAST_SECONDS:
        return None
    # A clock of another rate shifts the oldest window further
    reach = REACH + FASTEST * signal.vibration.size * signal.period
    explained = _explained(signal, reducer, dynamics, harmonics, reach)
    lags = signal.period * (np.arange(explained.shape[1]) - explained.shape[1] // 2)
    ages = WINDOW * (0.5 + np.arange(explained.shape[0])[::-1])  # of the windows' middles, from the newest on
    rates = np.arange(-FASTEST, FASTEST + 0.5 * _RATE_STEP, _RATE_STEP)
    sums = np.array([_sheared(explained, np.rint(-rate * ages / signal.period).astype(int)) for rate in rates])
    steady = sums[rates.size // 2]
    as_stamped = float(steady[np.abs(lags) < 0.5 * _LEAST_DELAY].max())
    rate_place, place = np.unravel_index(int(np.argmax(sums)), sums.shape)
    best, rate = float(sums[rate_place, place]), float(rates[rate_place])
    drifts = best > _CLEARLY * float(steady.max())
    if not drifts:
        place, best = np.argmax(steady), float(steady.max())
    whole = float(signal.vibration @ signal.vibration)
    if best < max(_BETTER * as_stamped, _MOST * whole):
        return None
    if drifts:
        return blocker(LimitationCode.VIBRATION_CLOCK_RATE, percent=100.0 * rate)
    delay = float(lags[place])
    if abs(delay) < _LEAST_DELAY:
        return None
    elsewhere = float(steady[np.abs(lags - delay) > WINDOW].max(initial=0.0))
    code = LimitationCode.STAMPS_APART if elsewhere < _AS_GOOD * best else LimitationCode.STAMPS_APART_OR_MORE
    late, early = ("vibration", "joint states") if delay > 0.0 else ("joint states", "vibration")
    return blocker(code, late=late, early=early, delay_ms=1e3 * abs(delay))


def explained_share(records: Sequence[Record], reducer: Reducer, dynamics: Dynamics, harmonics: int) -> float:
    """Return the part of the vibration's power that lines explain: about 1 if a sensor hears little else, 0 if none."""
    signal = _on_one_grid(records)
    if signal is None or not signal.vibration.any():
        return 0.0
    explained = _explained(signal, reducer, dynamics, harmonics, reach=0.0)
    return float(explained.sum()) / float(signal.vibration @ signal.vibration)


def _on_one_grid(records: Sequence[Record]) -> _Signal | None:
    """Bring records onto one grid, 0 where the vibration is unknown."""
    if not records:
        return None
    period, start = records[-1].period, records[0].start
    times, angle, speed, vibration = (
        np.concatenate([getattr(record, name) for record in records])
        for name in ("times", "angle", "speed", "acceleration")
    )
    known = np.isfinite(vibration)
    size = round((float(times[-1]) - start) / period) + 1
    if not known.any() or not period * size <= 10.0 * period * times.size:
        return None
    even = np.zeros(size)
    places = np.clip(np.rint((times[known] - start) / period).astype(np.intp), 0, size - 1)
    even[places] = vibration[known] - float(np.mean(vibration[known]))
    grid = start + period * np.arange(size)
    signal = np.stack([even, np.interp(grid, times, angle), np.interp(grid, times, speed)])
    together = max(1, int(1.0 / (period * _RATE)))
    usable = size // together * together
    signal = signal[:, size - usable :].reshape(3, -1, together).mean(axis=2)
    vibration, angle, speed = signal
    return _Signal(vibration, angle, speed, period * together)


def _explained(signal: _Signal, reducer: Reducer, dynamics: Dynamics, harmonics: int, reach: float) -> FloatArray:
    """Power that lines explain in each window at each delay up to `reach` [s] either way, shape (windows, delays)."""
    width = min(round(WINDOW / signal.period), signal.vibration.size)
    count, reach = signal.vibration.size // width, round(reach / signal.period)
    size = count * width
    vibration, angle, speed = (values[-size:] for values in signal[:3])
    length = fft.next_fast_len(size + 2 * reach)
    windows = np.zeros((count, length))
    for number in range(count):
        part = slice(number * width, (number + 1) * width)
        windows[number, part] = vibration[part]
    spectra = fft.fft(windows)
    frequency = fft.fftfreq(length, signal.period)
    response = (frequency / dynamics.natural_frequency) ** 2 * dynamics.receptance(frequency)
    first = np.arange(count)[:, None] * width + np.arange(2 * reach, -1, -1)
    total = np.zeros((count, 2 * reach + 1))
    for k in range(1, harmonics + 1):
        products, lines = [], []
        for order in reducer.output_orders:
            seen = np.abs(k * order * speed) * signal.period < _BAND * math.pi
            line = response * fft.fft(seen * np.exp(1j * k * order * angle), length)  # transients at resonance included
            product = fft.ifft(spectra * line.conj())
            products.append(np.roll(product, reach, axis=1)[:, : 2 * reach + 1])
            lines.append(fft.ifft(line)[:size])

        def within(values: ComplexArray) -> ComplexArray:
            sums = np.cumsum(np.pad(values, (reach + 1, reach)))
            return np.asarray(sums[first + width] - sums[first])

        (one, two), (own, other) = lines, products
        power, further = within(np.abs(one) ** 2).real, within(np.abs(two) ** 2).real
        floor = _RIDGE * (float(power.mean()) + float(further.mean()))
        power, further, shared = power + floor, further + floor, within(one.conj() * two)
        explained = further * np.abs(own) ** 2 + power * np.abs(other) ** 2 - 2.0 * (own.conj() * shared * other).real
        total += 2.0 * explained / (power * further - np.abs(shared) ** 2 + 1e-300)
    return total


def _sheared(explained: FloatArray, shifts: np.ndarray) -> FloatArray:
    """Sum of windows, each shifted by so many delays; those that a shift brings in count nothing."""
    total = np.zeros(explained.shape[1])
    for row, shift in zip(explained, shifts.tolist(), strict=True):
        if shift >= 0:
            total[: total.size - shift] += row[shift:]
        else:
            total[-shift:] += row[:shift]
    return total

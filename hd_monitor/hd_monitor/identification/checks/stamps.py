"""Whether the vibration fits the motion better at other times than their stamps say: two clocks, or a late stamp."""

from collections.abc import Sequence

import numpy as np
import scipy

from ...acquisition.record import Record
from ...arrays import ComplexArray, FloatArray
from ...limitation import Limitation, LimitationCode, blocker
from ...model.parameters import Dynamics
from ...reducer import Reducer
from .even import WINDOW, EvenSignal

REACH, FASTEST = 2.5, 0.03
"""Delay [s] and relative error of a clock up to which they are looked for."""

_RATE_STEP = 1e-3
_RIDGE = 0.03  # of the lines' power: where a window does not separate the two
_LEAST_SECONDS = 3.0
_LEAST_DELAY = 0.01  # s; less is fitted along
_BETTER = 1.08  # explained power, over that with the stamps as they are, from which others are believed
_MOST = 0.7  # of the vibration's power that must be explained then: chance explains less
_CLEARLY = 1.08  # explained power with a clock of another rate, over the best that a delay alone explains
_AS_GOOD = 0.6  # part of the best explained power at another delay, where less motion overlaps, that repeats it


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
    signal = EvenSignal.of(records)
    if signal is None or len(signal) * signal.period < _LEAST_SECONDS:
        return None
    # A clock of another rate shifts the oldest window further
    reach = REACH + FASTEST * len(signal) * signal.period
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
    if best < max(_BETTER * as_stamped, _MOST * signal.power):
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


def _explained(signal: EvenSignal, reducer: Reducer, dynamics: Dynamics, harmonics: int, reach: float) -> FloatArray:
    """Power that lines explain in each window at each delay up to `reach` [s] either way, shape (windows, delays)."""
    width, reach = round(WINDOW / signal.period), round(reach / signal.period)
    count = len(signal) // width
    size, skipped = count * width, len(signal) % width
    length = scipy.fft.next_fast_len(len(signal) + 2 * reach)
    windows = np.zeros((count, length))
    for number in range(count):
        part = slice(skipped + number * width, skipped + (number + 1) * width)
        windows[number, part] = signal.vibration[part]
    spectra = scipy.fft.fft(windows)
    first = skipped + np.arange(0, size, width)[:, None] + np.arange(2 * reach, -1, -1)

    def within(values: ComplexArray) -> ComplexArray:
        sums = np.cumsum(np.pad(values, (reach + 1, 0)))
        return np.asarray(sums[first + width] - sums[first])

    total = np.zeros((count, 2 * reach + 1))
    for pair in signal.lines(reducer, dynamics, harmonics, length=length):
        own, other = (
            np.roll(scipy.fft.ifft(spectra * line.conj()), reach, axis=1)[:, : 2 * reach + 1] for line in pair
        )
        one, two = (scipy.fft.ifft(line)[: len(signal) + reach] for line in pair)
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

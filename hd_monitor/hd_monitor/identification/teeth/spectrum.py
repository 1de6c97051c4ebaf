"""Spectrum of a vibration over orders, cycles per output revolution, summed up cheaply as the joint turns."""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import fft

from ...arrays import ComplexArray, FloatArray
from ...model.parameters import Dynamics
from ...orders.line_orders import LineOrders
from ...orders.orthonormal import orthonormal
from ...orders.regression import LineFit, Products, solve
from ..segment.segment import Segment
from ..segment.torque import own_acceleration

TURNS = 2
"""Output revolutions after which the sums start over: half orders, where no line can be, tell lines from tones."""

PER_TURN = 2048
"""Angle bins per output revolution."""

HIGHEST_ORDER = 800
"""Order up to which the bins are fine enough: they weaken it by a fifth."""

_SLOW = 4.0  # polynomial terms per second, which follow what is slower than about 2 Hz


def _nothing() -> FloatArray:
    return np.zeros(TURNS * PER_TURN)


@dataclass(frozen=True, eq=False, kw_only=True)
class OrderSpectrum:
    """Sums of a signal by the output angle, from which every order's line follows by one Fourier transform.

    Attributes
    ----------
    sums : ndarray, shape (bins,)
        Sums of the samples [rad/s²] that fall into each bin of the angle.
    counts : ndarray, shape (bins,)
        Numbers of samples.
    power : float
        Sum of squares of the samples [(rad/s²)²].
    lowest, highest : float
        Range of the output angle [rad] looked at.
    """

    sums: FloatArray = field(default_factory=_nothing)
    counts: FloatArray = field(default_factory=_nothing)
    power: float = 0.0
    lowest: float = math.inf
    highest: float = -math.inf

    def faded(self, keep: float) -> "OrderSpectrum":
        """Return the sums of data that count `keep` times."""
        return OrderSpectrum(
            sums=keep * self.sums,
            counts=keep * self.counts,
            power=keep * self.power,
            lowest=self.lowest,
            highest=self.highest,
        )

    @property
    def turns(self) -> float:
        """Range of the output angle in revolutions: lines stand apart by Fourier means by one over it."""
        return max(self.highest - self.lowest, 0.0) / math.tau

    @property
    def amplitudes(self) -> FloatArray:
        """Amplitudes [rad/s²] at the orders 0, 1, 2 …; half orders are left out."""
        return np.abs(np.fft.rfft(self.sums))[::TURNS][: HIGHEST_ORDER + 1] * (2.0 / max(float(self.counts.sum()), 1.0))

    def products(self, orders: FloatArray) -> Products:
        """Inner products of the lines' columns and the signal.

        Parameters
        ----------
        orders : ndarray, shape (lines,)
            Whole multiples of 1 / `TURNS`.
        """
        place = np.rint(orders * TURNS).astype(np.intp)
        weight, signal = self._transforms
        size = weight.size
        apart, together = weight[np.subtract.outer(place, place) % size], weight[np.add.outer(place, place) % size]
        cosines, sines = 0.5 * (apart + together).real, 0.5 * (apart - together).real
        mixed = -0.5 * (together - apart).imag  # of cos(a) with -sin(b), b the second index
        own = signal[place]
        column = np.concatenate([own.real, -own.imag])
        lines = np.block([[cosines, mixed], [mixed.T, sines]])
        matrix = np.block([[lines, column[:, None]], [column[None, :], np.array([[self.power]])]])
        return Products(orders=orders, matrix=matrix, rows=int(self.counts.sum()))

    def solve(self, orders: LineOrders) -> LineFit | None:
        """Fit lines at whole multiples of 1 / `TURNS`; None if one is too high, or not determined by the travel."""
        every = orders.every
        if max(orders.lines) > HIGHEST_ORDER:
            return None
        return solve(self.products(every[every <= HIGHEST_ORDER]), orders)

    @functools.cached_property
    def _transforms(self) -> tuple[ComplexArray, ComplexArray]:
        """Sums of exp(+i order angle) over the samples, and over the signal."""
        return np.fft.fft(self.counts).conj(), np.fft.fft(self.sums).conj()


def with_segment(
    spectra: Sequence[OrderSpectrum], segment: Segment, signals: Sequence[FloatArray], dynamics: Dynamics
) -> tuple[OrderSpectrum, ...]:
    """Add signals [rad/s²] along a segment, one to each spectrum.

    They pass a filter that turns back the resonator's phase: past the resonance a line's phase is reversed, so that
    without it the two sides of a speed ramp would cancel.
    """
    used = segment.used
    place = np.floor(np.mod(segment.angle[used] / math.tau, TURNS) * PER_TURN).astype(np.intp) % (TURNS * PER_TURN)
    counts = np.bincount(place, minlength=TURNS * PER_TURN)
    lowest, highest = float(segment.angle.min()), float(segment.angle.max())
    added = _equalised(_levelled(segment, np.stack(signals)), segment.period, dynamics)[:, used]
    return tuple(
        OrderSpectrum(
            sums=spectrum.sums + np.bincount(place, values, spectrum.sums.size),
            counts=spectrum.counts + counts,
            power=spectrum.power + float(values @ values),
            lowest=min(spectrum.lowest, lowest),
            highest=max(spectrum.highest, highest),
        )
        for spectrum, values in zip(spectra, added, strict=True)
    )


def _levelled(segment: Segment, signals: FloatArray) -> FloatArray:
    """Signals less slow motion; unlike the fit's they keep all tones: at one speed these may be other teeth's lines."""
    degree = 3 + math.ceil(_SLOW * segment.duration)
    columns = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, len(segment)), degree)
    own = own_acceleration(segment.speed, segment.period)
    if float(np.ptp(own)) > 0.0:
        columns = np.concatenate([columns, own[:, None]], axis=1)
    slow, signals = orthonormal(columns * segment.used[:, None]), signals * segment.used
    return np.asarray(signals - (signals @ slow) @ slow.T)


def _equalised(signals: FloatArray, period: float, dynamics: Dynamics) -> FloatArray:
    """Signals with the resonator's phase turned back, the magnitudes of their spectra as they were."""
    size = signals.shape[1]
    length = fft.next_fast_len(2 * size, real=True)
    ratio = np.fft.rfftfreq(length, period) / dynamics.natural_frequency
    response = -(ratio**2) / (1.0 - ratio**2 + 2j * dynamics.damping_ratio * ratio)
    response[0] = 1.0
    turned = np.fft.rfft(signals, length) * (response.conj() / np.abs(response))
    return np.asarray(np.fft.irfft(turned, length)[:, :size])

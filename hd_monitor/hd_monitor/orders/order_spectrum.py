"""Spectrum of a signal over orders, cycles per output revolution, summed up cheaply as the joint turns."""

import functools
import math
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import ComplexArray, FloatArray
from .line_orders import LineOrders
from .regression import LineFit, Products, solve

TURNS = 2
"""Output revolutions after which the sums start over: half orders, where no line can be, tell lines from tones."""

PER_TURN = 4096
"""Angle bins per output revolution."""

HIGHEST_ORDER = 800
"""Order up to which lines may be teeth's."""

_FINE_ENOUGH = 0.47  # cycles per bin up to which the bins' weakening of a line is made up for


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
        return replace(self, sums=keep * self.sums, counts=keep * self.counts, power=keep * self.power)

    @property
    def turns(self) -> float:
        """Range of the output angle in revolutions: lines stand apart by Fourier means by one over it."""
        return max(self.highest - self.lowest, 0.0) / math.tau

    @property
    def amplitudes(self) -> FloatArray:
        """Amplitudes [rad/s²] at the orders 0, 1, 2 …; half orders are left out."""
        return self.every_amplitude[: HIGHEST_ORDER + 1]

    @functools.cached_property
    def every_amplitude(self) -> FloatArray:
        """Amplitudes [rad/s²] at the orders 0, 1, 2 … up to the highest that the bins show."""
        orders = np.arange(round(_FINE_ENOUGH * PER_TURN))
        found = np.abs(np.fft.rfft(self.sums))[::TURNS][: orders.size]
        return np.asarray(found * (2.0 / max(float(self.counts.sum()), 1.0)) / np.sinc(orders / PER_TURN))

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

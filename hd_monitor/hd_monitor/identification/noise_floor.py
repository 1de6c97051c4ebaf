"""The noise floor over frequency, measured on what the model leaves, and the weighting by it."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import fft

from .stretch import Stretch

FloatArray = npt.NDArray[np.float64]

BANDS = 32
"""Bands of equal width up to half the sampling rate; the lowest is divided further, by octaves."""

_OCTAVES = 4
_FREEDOM = 60.0  # degrees of freedom that a band needs to stand alone; neighbours are pooled below that
_LOWEST_DENSITY = 1e-20  # of the mean square of the signal: noise-free data have a floor all the same


class Spectral:
    """Transforms a stretch's signals into the frequency domain, slow motion taken off.

    Parameters
    ----------
    stretch : Stretch

    Attributes
    ----------
    frequencies : ndarray, shape (bins,)
        [Hz]; 0 is left out.
    fill : float
        Sum of squares of white noise of unit variance per row of the transform.
    """

    def __init__(self, stretch: Stretch) -> None:
        self._stretch = stretch
        self._length = fft.next_fast_len(len(stretch), real=True)
        self.frequencies: FloatArray = fft.rfftfreq(self._length, stretch.period)[1:]
        self.fill = (int(stretch.used.sum()) - stretch.slow.shape[1]) / (2.0 * self.frequencies.size)

    def __call__(self, signals: FloatArray) -> FloatArray:
        """Transform signals, shape (samples, columns), into real parts over imaginary parts, (2 * bins, columns)."""
        x = signals * self._stretch.used[:, None]
        x -= self._stretch.slow @ (self._stretch.slow.T @ x)
        spectrum = fft.rfft(x, self._length, axis=0)[1:] * math.sqrt(2.0 / self._length)
        return np.concatenate([spectrum.real, spectrum.imag])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NoiseFloor:
    """Noise power by frequency band.

    Attributes
    ----------
    edges : ndarray, shape (bands + 1,)
        Limits of the bands [Hz], rising from 0.
    power : ndarray, shape (bands,)
        Sum of squares of the residual's transform in the band.
    freedom : ndarray, shape (bands,)
        Expectation of that sum for white noise of unit variance.
    """

    edges: FloatArray
    power: FloatArray
    freedom: FloatArray

    @classmethod
    def empty(cls, period: float) -> "NoiseFloor":
        """Return a floor of which nothing is known yet, for a sample period [s]."""
        width = 0.5 / period / BANDS
        octaves = width * 0.5 ** np.arange(_OCTAVES, 0, -1)
        edges = np.concatenate([[0.0], octaves, width * np.arange(1, BANDS + 1)])
        return cls(edges=edges, power=np.zeros(edges.size - 1), freedom=np.zeros(edges.size - 1))

    def updated(self, spectral: Spectral, residual: FloatArray, *, unknowns: float, keep: float = 1.0) -> "NoiseFloor":
        """Add a stretch's residual, given as its transform, shape (2 * bins,).

        Parameters
        ----------
        spectral : Spectral
        residual : ndarray
        unknowns : float
            Number of unknowns that were fitted to it, by which its power is too small.
        keep : float
            Weight that what is known so far keeps.
        """
        bins = spectral.frequencies.size
        place = np.clip(np.searchsorted(self.edges, spectral.frequencies) - 1, 0, self.power.size - 1)
        squares = residual[:bins] ** 2 + residual[bins:] ** 2
        count = 2.0 * bins * spectral.fill
        share = max(1.0 - unknowns / max(count, 1.0), 0.1)
        return NoiseFloor(
            edges=self.edges,
            power=keep * self.power + np.bincount(place, squares, self.power.size),
            freedom=keep * self.freedom + 2.0 * spectral.fill * share * np.bincount(place, minlength=self.power.size),
        )

    def merged(self, other: "NoiseFloor") -> "NoiseFloor":
        """Pool two floors of the same bands."""
        return NoiseFloor(edges=self.edges, power=self.power + other.power, freedom=self.freedom + other.freedom)

    def faded(self, keep: float) -> "NoiseFloor":
        """Return the floor with its weight multiplied by `keep`."""
        return NoiseFloor(edges=self.edges, power=keep * self.power, freedom=keep * self.freedom)

    @property
    def mean(self) -> float:
        """Mean noise power per sample over the whole band."""
        return float(self.power.sum() / max(self.freedom.sum(), 1e-300))

    def density(self, frequencies: FloatArray) -> FloatArray:
        """Variance of a sample of white noise as strong as the floor at `frequencies` [Hz].

        Raises
        ------
        ValueError
            If nothing is known of the floor yet.
        """
        if not self.freedom.sum() > 0.0:
            raise ValueError("no residual has been seen, so the noise floor is unknown; call updated() first")
        power, freedom = self.power.copy(), self.freedom.copy()
        centres = 0.5 * (self.edges[:-1] + self.edges[1:])
        weight = np.ones(power.size)
        # pool the poorest band with its poorer neighbour until every band stands on enough residual
        while power.size > 1 and freedom.min() < _FREEDOM:
            poorest = int(np.argmin(freedom))
            left = poorest - 1 if poorest == power.size - 1 else poorest
            if 0 < poorest < power.size - 1 and freedom[poorest - 1] < freedom[poorest + 1]:
                left = poorest - 1
            total = weight[left] + weight[left + 1]
            centres[left] = (weight[left] * centres[left] + weight[left + 1] * centres[left + 1]) / total
            for values in (power, freedom, weight):
                values[left] += values[left + 1]
            centres, power, freedom, weight = (
                np.delete(values, left + 1) for values in (centres, power, freedom, weight)
            )
        lowest = max(_LOWEST_DENSITY * float(power.sum()), 1e-300)
        return np.asarray(np.exp(np.interp(frequencies, centres, np.log(np.maximum(power / freedom, lowest)))))

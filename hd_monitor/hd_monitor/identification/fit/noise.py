"""The noise floor over frequency, measured on what the model leaves, and the weighting by it."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...arrays import FloatArray
from ..segment.segment import Segment

EDGES = np.concatenate([[0.0], 2.0 ** (np.arange(61) / 4.0)])
"""Limits of the bands [Hz]: quarter octaves from 1 Hz to 32 kHz, and one band below; read-only."""
EDGES.flags.writeable = False

_CENTRES = np.concatenate([[0.5], np.sqrt(EDGES[1:-1] * EDGES[2:])])
_FREEDOM = 60.0  # degrees of freedom that a band needs on its own; neighbours are pooled below that
_LEAST_SHARE = 0.1  # of the rows' noise that a fit leaves
_LOWEST_DENSITY = 1e-20  # of the whole power: even noise-free data have a floor


@dataclass(frozen=True, eq=False, kw_only=True)
class NoiseFloor:
    """Noise power by frequency band.

    Attributes
    ----------
    power : ndarray, shape (bands,)
        Sums of squares of the residual's transform in the bands between `EDGES`, scaled to a density.
    freedom : ndarray, shape (bands,)
        Expectation of these sums for noise of unit density.
    """

    power: FloatArray = field(default_factory=lambda: np.zeros(_CENTRES.size))
    freedom: FloatArray = field(default_factory=lambda: np.zeros(_CENTRES.size))

    @classmethod
    def white(cls, density: float) -> "NoiseFloor":
        """Return the floor of white noise of a one-sided density [(rad/s²)²/Hz], known for sure."""
        known = np.full(_CENTRES.size, 1e9)
        return cls(power=density * known, freedom=known)

    def updated(self, segment: Segment, residual: FloatArray, leverage: FloatArray) -> "NoiseFloor":
        """Add a segment's residual, given as its transform.

        Parameters
        ----------
        segment : Segment
        residual : ndarray, shape (2 * bins,)
        leverage : ndarray, shape (2 * bins,)
            Part of the noise's variance in every row that a fit took away: without it the floor would be too low just
            where it matters, at the lines.
        """
        frequencies, fill = segment.frequencies, segment.fill
        bins = frequencies.size
        place = np.searchsorted(EDGES[1:-1], frequencies)
        squares = 2.0 * segment.period * (residual[:bins] ** 2 + residual[bins:] ** 2)
        rows = 2.0 * fill * np.bincount(place, minlength=self.power.size)
        taken = np.bincount(place, leverage[:bins] + leverage[bins:], self.power.size)
        return NoiseFloor(
            power=self.power + np.bincount(place, squares, self.power.size),
            freedom=self.freedom + np.maximum(rows - taken, _LEAST_SHARE * rows),
        )

    def __add__(self, other: "NoiseFloor") -> "NoiseFloor":
        """Pool with the floor of other data."""
        return NoiseFloor(power=self.power + other.power, freedom=self.freedom + other.freedom)

    def faded(self, keep: float) -> "NoiseFloor":
        """Return the floor with its weight multiplied by `keep`."""
        return NoiseFloor(power=keep * self.power, freedom=keep * self.freedom)

    @property
    def mean(self) -> float:
        """Mean density over the whole band."""
        return float(self.power.sum() / max(self.freedom.sum(), 1e-300))

    def density(self, frequencies: FloatArray) -> FloatArray:
        """One-sided density [(rad/s²)²/Hz] at `frequencies` [Hz].

        Raises
        ------
        ValueError
            If nothing is known of the floor yet.
        """
        logarithm, level = self._knots
        return np.asarray(np.exp(np.interp(np.log2(frequencies), logarithm, level)))

    def sample_std(self, frequencies: FloatArray, period: float) -> FloatArray:
        """Standard deviation [rad/s²] of samples, `period` [s] apart, of white noise like the floor at frequencies."""
        return np.asarray(np.sqrt(self.density(frequencies) / (2.0 * period)))

    @cached_property
    def _knots(self) -> tuple[FloatArray, FloatArray]:
        """Logarithms of frequency (base 2) and of density (base e) between which the floor is straight."""
        if not self.freedom.sum() > 0.0:
            raise ValueError("no residual has been seen, so the noise floor is unknown; call updated() first")
        known = self.freedom > 0.0
        # Plain numbers: there are few bands, and an array for each step would cost more than all of them
        freedoms, powers = self.freedom[known].tolist(), self.power[known].tolist()
        logarithms, weights = np.log2(_CENTRES[known]).tolist(), [1.0] * len(powers)
        # pool the poorest band with its poorer neighbour until every band has enough residual
        while len(powers) > 1 and (least := min(freedoms)) < _FREEDOM:
            poorest = freedoms.index(least)
            left = poorest - 1 if poorest == len(powers) - 1 else poorest
            if 0 < poorest < len(powers) - 1 and freedoms[poorest - 1] < freedoms[poorest + 1]:
                left = poorest - 1
            share = weights[left + 1] / (weights[left] + weights[left + 1])
            logarithms[left] += share * (logarithms[left + 1] - logarithms[left])
            for values in (powers, freedoms, weights):
                values[left] += values[left + 1]
            for values in (logarithms, powers, freedoms, weights):
                del values[left + 1]
        power, freedom, logarithm = np.array(powers), np.array(freedoms), np.array(logarithms)
        lowest = max(_LOWEST_DENSITY * float(power.sum()), 1e-300)
        # with the variance estimated the error is Student's, whose variance is freedom / (freedom - 2) larger
        return logarithm, np.log(np.maximum(power / np.maximum(freedom - 2.0, 0.5 * freedom), lowest))

"""The steps of an integration between sampling instants."""

from dataclasses import dataclass

import numpy as np

from hd_monitor.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Steps in a row of sampling intervals.

    Parameters
    ----------
    first : int
        Number of the first interval since the start.
    rate : float
        Sampling intervals per second [Hz].
    substeps : ndarray of int, shape (intervals,)
        Equal steps in each interval.
    """

    first: int
    rate: float
    substeps: IntArray

    @property
    def times(self) -> FloatArray:
        """Sampling instants [s]: the beginnings of the intervals, shape (intervals,)."""
        return (self.first + np.arange(self.substeps.size)) / self.rate

    @property
    def lengths(self) -> FloatArray:
        """Lengths of the steps [s], shape (steps,)."""
        return np.repeat(1.0 / (self.rate * self.substeps), self.substeps)

    @property
    def sampled(self) -> IntArray:
        """Numbers of the steps that begin at a sampling instant, shape (intervals,)."""
        return np.asarray(np.cumsum(self.substeps) - self.substeps)

    def instants(self, *offsets: float) -> FloatArray:
        """Times [s] at fractions `offsets` of every step, shape (offsets, steps)."""
        place = np.repeat(np.arange(self.substeps.size), self.substeps)
        within = np.arange(place.size) - self.sampled[place]
        fractions = (within + np.array(offsets)[:, None]) / self.substeps[place]
        return np.asarray((self.first + place + fractions) / self.rate)

    def ends(self, per_step: int = 1) -> FloatArray:
        """Times [s] of the steps' ends and of equal parts of them, with the first beginning: per_step * steps + 1."""
        inner = self.instants(*(part / per_step for part in range(per_step)))
        return np.append(inner.T.ravel(), (self.first + self.substeps.size) / self.rate)

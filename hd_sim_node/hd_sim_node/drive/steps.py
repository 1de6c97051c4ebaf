"""The steps of an integration between sampling instants."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from hd_monitor.arrays import FloatArray, IntArray

_JUMP = 1e-9
"""Time [s] that a jump of the acceleration is given."""


@dataclass(frozen=True, eq=False)
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
    corners : ndarray, shape (corners,)
        Times [s] at which the acceleration may jump: a step ends before each and the next begins at it.
    """

    first: int
    rate: float
    substeps: IntArray
    corners: FloatArray = field(default_factory=lambda: np.empty(0))

    @cached_property
    def times(self) -> FloatArray:
        """Sampling instants [s]: the beginnings of the intervals, shape (intervals,)."""
        return (self.first + np.arange(self.substeps.size)) / self.rate

    @cached_property
    def lengths(self) -> FloatArray:
        """Lengths of the steps [s], shape (steps,)."""
        if self.corners.size:
            return np.diff(self.ends)
        return np.repeat(1.0 / (self.rate * self.substeps), self.substeps)

    @cached_property
    def sampled(self) -> IntArray:
        """Numbers of the steps that begin at a sampling instant, shape (intervals,)."""
        if self.corners.size:
            return np.searchsorted(self.ends, self.times)
        return np.asarray(np.cumsum(self.substeps) - self.substeps)

    def instants(self, *offsets: float) -> FloatArray:
        """Times [s] at fractions `offsets` of every step, shape (offsets, steps)."""
        place = np.repeat(np.arange(self.substeps.size), self.substeps)
        within = np.arange(place.size) - np.repeat(np.cumsum(self.substeps) - self.substeps, self.substeps)

        def even(fractions: FloatArray | float) -> FloatArray:
            return np.asarray((self.first + place + (within + fractions) / self.substeps[place]) / self.rate)

        if not self.corners.size:
            return even(np.array(offsets)[:, None])
        cuts, end = np.concatenate([self.corners - _JUMP, self.corners]), (self.first + self.substeps.size) / self.rate
        begins = even(0.0)
        begins = np.unique(np.append(begins, cuts[(cuts > begins[0]) & (cuts < end)]))
        lengths = np.diff(np.append(begins, end))
        return np.asarray(begins + np.array(offsets)[:, None] * lengths)

    @cached_property
    def ends(self) -> FloatArray:
        """Times [s] of the first beginning and of the steps' ends, shape (steps + 1,)."""
        return self.halves[::2]

    @cached_property
    def halves(self) -> FloatArray:
        """Times [s] of all beginnings, middles and ends, shape (2 steps + 1,)."""
        return np.append(self.instants(0.0, 0.5).T.ravel(), (self.first + self.substeps.size) / self.rate)

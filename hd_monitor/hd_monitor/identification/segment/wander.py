"""An inertia that moves within a segment, as an arm's does with its pose: its course, and how much it may wander."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ...arrays import FloatArray

SPACING = 0.25
"""Longest time [s] between the knots of the course."""

START, WALK = 0.2, 0.3
"""Standard deviation of ln(inertia) at a segment's start, and of its change over a second."""

MOST = 1.0
"""Largest magnitude of ln(inertia / given inertia)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Wander:
    """Course of an inertia along a segment, linear between knots.

    Attributes
    ----------
    values : ndarray, shape (knots,)
        ln(inertia / given inertia) at the knots.
    duration : float
        Length of the segment [s].
    """

    values: FloatArray
    duration: float

    @classmethod
    def none(cls, duration: float) -> Self:
        """Return the course of a constant inertia, with the knots to let it move."""
        return cls(values=np.zeros(math.ceil(duration / SPACING) + 1), duration=duration)

    @classmethod
    def coarse(cls, duration: float, value: float) -> Self:
        """Return the course of a constant inertia with few knots, from which to look for a finer one."""
        return cls(values=np.full(math.ceil(duration / (4.0 * SPACING)) + 1, value), duration=duration)

    def fine(self) -> "Wander":
        """Return the same course with all knots."""
        fine = Wander.none(self.duration)
        places = np.linspace(0.0, 1.0, fine.values.size)
        return replace(fine, values=np.interp(places, np.linspace(0.0, 1.0, self.values.size), self.values))

    def hats(self, places: FloatArray) -> FloatArray:
        """Weights of the knots at some places along the segment, 0 to 1; shape ``places.shape + (knots,)``."""
        last = self.values.size - 1
        return np.maximum(0.0, 1.0 - np.abs(places[..., None] * last - np.arange(last + 1)))

    @property
    def precision(self) -> FloatArray:
        """Inverse of the covariance of the values before any data, shape (knots, knots)."""
        knots = self.values.size
        rows = np.diff(np.eye(knots), axis=0) / (WALK * math.sqrt(self.duration / (knots - 1)))
        first = np.eye(1, knots) / START
        return rows.T @ rows + first.T @ first

    def moved(self, step: FloatArray) -> "Wander":
        """Return the course after a step of its values, within what an arm can do."""
        return replace(self, values=np.clip(self.values + step, -MOST, MOST))

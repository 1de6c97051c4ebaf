"""What is known of the unknowns: a Gaussian in information form, which evidence adds to and time takes from."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ...arrays import BoolArray, FloatArray
from .normal_equations import NormalEquations


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Information:
    """The quadratic ``x·matrix·x - 2 vector·x`` in the unknowns x.

    Attributes
    ----------
    matrix : ndarray, shape (unknowns, unknowns)
    vector : ndarray, shape (unknowns,)
    spread : ndarray, shape (unknowns, unknowns)
        Covariance of the vector: the information of every piece times the square of the weight it has left.
    """

    matrix: FloatArray
    vector: FloatArray
    spread: FloatArray

    @classmethod
    def gaussian(cls, std: FloatArray) -> Self:
        """Return the information that the unknowns are 0 but for these standard deviations; none where one is 0."""
        weight = np.diag(np.divide(1.0, np.square(std), out=np.zeros(std.size), where=std > 0.0))
        return cls(matrix=weight, vector=np.zeros(std.size), spread=weight)

    @classmethod
    def none(cls, size: int) -> Self:
        """Return no information at all."""
        return cls(matrix=np.zeros((size, size)), vector=np.zeros(size), spread=np.zeros((size, size)))

    def __add__(self, other: "Information") -> "Information":
        """Pool with independent information."""
        return Information(
            matrix=self.matrix + other.matrix,
            vector=self.vector + other.vector,
            spread=self.spread + other.spread,
        )

    def plus(self, equations: NormalEquations, values: FloatArray) -> "Information":
        """Add evidence that was linearised at `values`."""
        return Information(
            matrix=self.matrix + equations.information,
            vector=self.vector + equations.information @ values + equations.score,
            spread=self.spread + equations.information,
        )

    def faded(self, keep: float) -> "Information":
        """Return the information with its weight multiplied by `keep`."""
        return Information(matrix=keep * self.matrix, vector=keep * self.vector, spread=keep * keep * self.spread)

    def divided(self, factor: float) -> "Information":
        """Return the information if the noise's variance is larger by a factor."""
        return Information(matrix=self.matrix / factor, vector=self.vector / factor, spread=self.spread / factor)

    def diffused(self, place: int, variance: float) -> "Information":
        """Return the information after one unknown has made a random step of this variance."""
        row = self.matrix[place]
        gain = row / (1.0 / variance + row[place])
        keep = np.eye(row.size)
        keep[:, place] -= gain  # the information form of adding the variance to the covariance
        return Information(
            matrix=keep @ self.matrix,
            vector=keep @ self.vector,
            spread=keep @ self.spread @ keep.T + np.outer(gain, gain) / variance,
        )

    def cost(self, values: FloatArray) -> float:
        """Return the price of `values`, but for a constant."""
        return float(values @ self.matrix @ values - 2.0 * self.vector @ values)

    def score(self, values: FloatArray) -> FloatArray:
        """Return the direction in which the price of `values` falls."""
        return np.asarray(self.vector - self.matrix @ values)

    def covariance(self, active: BoolArray, part: "Information | None" = None) -> FloatArray:
        """Covariance of the best values of the unknowns marked active; 0 for the others.

        Pieces that have faded weigh less than their worth, so this is not just the inverse of the information.

        Parameters
        ----------
        active : ndarray of bool, shape (unknowns,)
        part : Information, optional
            That part of the information whose errors count alone; all of it unless given.
        """
        covariance = np.zeros(self.matrix.shape)
        place = np.ix_(active, active)
        inverse = np.linalg.pinv(self.matrix[place], rcond=1e-14, hermitian=True)
        covariance[place] = inverse @ (part or self).spread[place] @ inverse
        return covariance

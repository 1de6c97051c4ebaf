"""What a segment says about the unknowns around a point, as normal equations: sums that add up."""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import FloatArray
from ..segment.segment import Segment
from .linearisation import Linearisation, Predictor
from .noise import NoiseFloor


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NormalEquations:
    """Quadratic model of the cost, ``cost - 2 score·d + d·information·d``, for a step d of the unknowns.

    Attributes
    ----------
    information : ndarray, shape (unknowns, unknowns)
        Fisher information.
    score : ndarray, shape (unknowns,)
    cost : float
        Sum of squares of the residual in units of the noise floor.
    freedom : float
        Expectation of the cost if the residual is nothing but noise.
    """

    information: FloatArray
    score: FloatArray
    cost: float
    freedom: float

    def moved(self, step: FloatArray) -> "NormalEquations":
        """Return the same quadratic model about the point that `step` leads to."""
        change = self.information @ step
        cost = self.cost - 2.0 * float(self.score @ step) + float(step @ change)
        return replace(self, score=self.score - change, cost=cost)

    def __add__(self, other: "NormalEquations") -> "NormalEquations":
        """Pool what is known about the same point from two sources."""
        return NormalEquations(
            information=self.information + other.information,
            score=self.score + other.score,
            cost=self.cost + other.cost,
            freedom=self.freedom + other.freedom,
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinearisedSegment:
    """What one segment says at one point: the normal equations and the residual behind them.

    Attributes
    ----------
    segment : Segment
    equations : NormalEquations
    linearisation : Linearisation
    residual : ndarray, shape (2 * bins,)
        Transform of the residual, free vibrations removed, not weighted.
    derivatives : ndarray, shape (2 * bins, unknowns)
        The same of the prediction's derivatives, in standard deviations of the noise.
    std : ndarray, shape (2 * bins,)
        Standard deviation of the noise.
    free_leverage : ndarray, shape (2 * bins,)
        Part of the noise in every row that the fit of the free vibrations takes away.
    """

    segment: Segment
    equations: NormalEquations
    linearisation: Linearisation
    residual: FloatArray
    derivatives: FloatArray
    std: FloatArray
    free_leverage: FloatArray

    def leverage(self, covariance: FloatArray) -> FloatArray:
        """Part of the noise's variance in every row that the fit takes away, shape (2 * bins,).

        It is large at the lines, which the unknowns follow, and next to nothing elsewhere.

        Parameters
        ----------
        covariance : ndarray, shape (unknowns, unknowns)
            Of the unknowns fitted, this segment included; 0 for the others.
        """
        rows = self.derivatives
        return np.asarray(self.free_leverage + np.einsum("ij,ij->i", rows @ covariance, rows))

    def moved(self, step: FloatArray) -> "LinearisedSegment":
        """Return what the segment says at a point a small `step` of the unknowns on, to first order of the step."""
        return replace(
            self,
            equations=self.equations.moved(step),
            linearisation=self.linearisation.moved(self.segment, step),
            residual=self.residual - self.std * (self.derivatives @ step),
        )


def linearise(segment: Segment, predictor: Predictor, values: FloatArray, floor: NoiseFloor) -> LinearisedSegment:
    """Linearise a segment at `values`, weighted by the noise floor."""
    line = predictor.linearise(segment, values)
    columns = segment.transform(np.concatenate([line.free, line.residual[:, None], line.jacobian], axis=1))
    frequencies = segment.frequencies
    std = np.tile(floor.sample_std(frequencies, segment.period), 2)
    weighted = columns / std[:, None]
    free, _ = np.linalg.qr(weighted[:, :2])
    white = weighted[:, 2:]
    white -= free @ (free.T @ white)
    gram = white.T @ white
    return LinearisedSegment(
        segment=segment,
        equations=NormalEquations(
            information=gram[1:, 1:],
            score=gram[1:, 0],
            cost=float(gram[0, 0]),
            freedom=2.0 * frequencies.size * segment.fill - 2.0,
        ),
        linearisation=line,
        residual=white[:, 0] * std,
        derivatives=white[:, 1:],
        std=std,
        free_leverage=np.einsum("ij,ij->i", free, free),
    )

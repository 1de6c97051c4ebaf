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
    silence : float
        Cost if no vibration is predicted but the free one.
    """

    information: FloatArray
    score: FloatArray
    cost: float
    freedom: float
    silence: float = 0.0

    def moved(self, step: FloatArray) -> "NormalEquations":
        """Return the same quadratic model about the point that `step` leads to."""
        change = self.information @ step
        cost = self.cost - 2.0 * float(self.score @ step) + float(step @ change)
        # Rounding may take a cost that all but vanishes below zero
        return replace(self, score=self.score - change, cost=max(cost, 1e-12 * self.cost))

    def __add__(self, other: "NormalEquations") -> "NormalEquations":
        """Pool what is known about the same point from two sources."""
        return NormalEquations(
            information=self.information + other.information,
            score=self.score + other.score,
            cost=self.cost + other.cost,
            freedom=self.freedom + other.freedom,
            silence=self.silence + other.silence,
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
        Part of the noise in every row that the fit of the free vibrations, and of a wandering inertia, takes away.
    wander : Elimination or None
        How the inertia at its knots follows the unknowns; None where it is constant.
    """

    segment: Segment
    equations: NormalEquations
    linearisation: Linearisation
    residual: FloatArray
    derivatives: FloatArray
    std: FloatArray
    free_leverage: FloatArray
    wander: "Elimination | None" = None

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
        change, residual = step, self.residual - self.std * (self.derivatives @ step)
        if self.wander is not None:
            own = self.wander.step - self.wander.response @ step
            change, residual = np.concatenate([step, own]), residual - self.std * (self.wander.rows @ self.wander.step)
        return replace(
            self,
            segment=self.segment_after(step, 1.0),
            equations=self.equations.moved(step),
            linearisation=self.linearisation.moved(self.segment, change),
            residual=residual,
        )

    def segment_after(self, step: FloatArray, part: float) -> Segment:
        """Return the segment with the inertia that belongs to the unknowns after a `part` of a step."""
        if self.wander is None or self.segment.wander is None:
            return self.segment
        own = part * (self.wander.step - self.wander.response @ step)
        return replace(self.segment, wander=self.segment.wander.moved(own))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Elimination:
    """The inertia at a segment's knots, eliminated from its normal equations.

    Attributes
    ----------
    step : ndarray, shape (knots,)
        Their best step where the unknowns stay.
    response : ndarray, shape (knots, unknowns)
        By how much it falls with each unknown.
    rows : ndarray, shape (2 * bins, knots)
        The prediction's derivatives by them, in standard deviations of the noise.
    """

    step: FloatArray
    response: FloatArray
    rows: FloatArray


def linearise(segment: Segment, predictor: Predictor, values: FloatArray, floor: NoiseFloor) -> LinearisedSegment:
    """Linearise a segment at `values`, weighted by the noise floor."""
    line = predictor.linearise(segment, values)
    measured = segment.acceleration[:, None]
    columns = segment.transform(np.concatenate([line.free, measured, line.residual[:, None], line.jacobian], axis=1))
    frequencies = segment.frequencies
    std = np.tile(floor.sample_std(frequencies, segment.period), 2)
    weighted = columns / std[:, None]
    free, _ = np.linalg.qr(weighted[:, :2])
    white = weighted[:, 2:]
    white -= free @ (free.T @ white)
    silence, white = float(white[:, 0] @ white[:, 0]), white[:, 1:]
    size = predictor.unknowns.size + 1
    left, rows, known = white[:, 0], white[:, 1:size], white[:, size:]
    gram = white.T @ white
    information, score, cost = gram[1:size, 1:size], gram[1:size, 0], float(gram[0, 0])
    leverage = np.einsum("ij,ij->i", free, free)
    wander = None
    if segment.wander is not None:
        prior, at = segment.wander.precision, segment.wander.values
        inverse = np.linalg.inv(gram[size:, size:] + prior)
        coupling = gram[size:, 1:size]
        wander = Elimination(step=inverse @ (gram[size:, 0] - prior @ at), response=inverse @ coupling, rows=known)
        information = information - coupling.T @ wander.response
        score = score - coupling.T @ wander.step
        cost += float(at @ prior @ at)
        rows = rows - known @ wander.response
        leverage = leverage + np.einsum("ij,ij->i", known @ inverse, known)
    return LinearisedSegment(
        segment=segment if line.twist is None else replace(segment, twist=line.twist),
        equations=NormalEquations(
            information=information,
            score=score,
            cost=cost,
            freedom=2.0 * frequencies.size * segment.fill - 2.0,
            silence=silence,
        ),
        linearisation=line,
        residual=left * std,
        derivatives=rows,
        std=std,
        free_leverage=leverage,
        wander=wander,
    )

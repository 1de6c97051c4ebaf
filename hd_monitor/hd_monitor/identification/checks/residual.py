"""What is left at the lines' own orders after the fit: the sharpest sign of a wrong model."""

import math
from dataclasses import dataclass

import numpy as np

from ...arrays import ComplexArray, FloatArray
from ...reducer import Reducer
from ..fit.noise import NoiseFloor
from ..fit.normal_equations import LinearisedSegment, NormalEquations

SIDE = 3
"""Orders looked at on either side of a pair's middle: the pair, the lines between and a load's side lines."""

_BLOCK = 0.05  # rad of way over which the residual is summed at once
_TOLD = 1e-3  # share of a segment in what is known of a combination of unknowns, from which its wish counts


@dataclass(frozen=True, slots=True, kw_only=True)
class Overdispersion:
    """How much the segments contradict each other in what they say of the unknowns.

    The noise floor is measured over bands of frequency much wider than a line. Noise that comes and goes with the
    vibration itself (of the measured torque, of the encoder) gathers around the lines, where it hardly lifts the floor
    but is all that matters to the unknowns; so does whatever else the model leaves out near the lines. Then the
    segments' wishes for the unknowns differ by more than the floor says.

    Attributes
    ----------
    squares : float
        Sum over all segments of the squares of what each would change, in its own standard deviations.
    freedom : float
        Expectation of that sum if the residual is nothing but noise like the floor.
    """

    squares: float = 0.0
    freedom: float = 0.0

    def plus(self, equations: NormalEquations, covariance: FloatArray) -> "Overdispersion":
        """Add a segment.

        Parameters
        ----------
        equations : NormalEquations
            What the segment says around the values fitted.
        covariance : ndarray, shape (unknowns, unknowns)
            Of the unknowns fitted, this segment included; 0 for the others.
        """
        scale = np.sqrt(covariance.diagonal())
        fitted = np.flatnonzero(scale)
        scale = scale[fitted]
        place = np.ix_(fitted, fitted)
        values, directions = np.linalg.eigh(equations.information[place] * np.outer(scale, scale))
        told = values > _TOLD
        directions = directions[:, told]
        wishes = directions.T @ (equations.score[fitted] * scale) / np.sqrt(values[told])
        # fitting the unknowns to this segment, too, has taken a part of its noise away
        taken = np.einsum(
            "ij,ij->", directions @ (directions.T * values[told, None]), covariance[place] / np.outer(scale, scale)
        )
        return Overdispersion(
            squares=self.squares + float(wishes @ wishes),
            freedom=self.freedom + max(float(np.count_nonzero(told)) - float(taken), 0.0),
        )

    def faded(self, keep: float) -> "Overdispersion":
        """Return the sums of data that count `keep` times."""
        return Overdispersion(squares=keep * self.squares, freedom=keep * self.freedom)

    @property
    def inflation(self) -> float:
        """Factor by which the overdispersion inflates the variances: 1 as long as chance explains it."""
        if self.freedom <= 0.0:
            return 1.0
        return max(1.0, self.squares / (self.freedom + math.sqrt(2.0 * self.freedom)))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LineResidual:
    """Sums of the residual against the orders around every line pair, over all data seen.

    Attributes
    ----------
    sums : ndarray of complex, shape (harmonics, orders)
        Coherent sums, in units of the noise floor around each pair.
    predicted : ndarray of complex, shape (harmonics, orders)
        The same sums of the prediction.
    weight : ndarray, shape (harmonics,)
        Expected squares of the residual's sums if there is nothing but noise.
    overdispersion : Overdispersion
        How much the segments contradict each other.
    """

    sums: ComplexArray
    predicted: ComplexArray
    weight: FloatArray
    overdispersion: Overdispersion

    @classmethod
    def empty(cls, harmonics: int) -> "LineResidual":
        """Return the sums of no data."""
        nothing = np.zeros((harmonics, 2 * SIDE + 1), dtype=np.complex128)
        return cls(sums=nothing, predicted=nothing, weight=np.zeros(harmonics), overdispersion=Overdispersion())

    def plus(
        self, item: LinearisedSegment, covariance: FloatArray, floor: NoiseFloor, reducer: Reducer
    ) -> "LineResidual":
        """Add a segment; the covariance is that of the unknowns fitted, 0 for the others."""
        segment, harmonics = item.segment, self.weight.size
        line = item.linearisation
        signals = np.stack([line.residual, line.predicted]) * segment.used
        demodulated = (signals - (signals @ segment.slow) @ segment.slow.T).astype(np.complex128)
        middle = sum(reducer.output_orders) / 2.0
        turn = np.exp(-1j * middle * segment.angle)
        # the orders beside the middle turn slowly: sums over short ways are enough of each sample
        way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(segment.angle)))])
        first = np.flatnonzero(np.diff(np.floor(way / _BLOCK), prepend=-1.0))
        centre = np.add.reduceat(segment.angle, first) / np.diff(np.append(first, len(segment)))
        sides = np.exp(-1j * np.multiply.outer(np.arange(-SIDE, SIDE + 1), centre))
        sums, predicted, weight = self.sums.copy(), self.predicted.copy(), self.weight.copy()
        for k in range(harmonics):
            demodulated *= turn
            frequency = np.abs(segment.speed) * ((k + 1) * middle / math.tau)
            seen = (frequency > 1.0) & (frequency < segment.highest_frequency)
            if seen.any():
                std = floor.sample_std(np.maximum(frequency, 1.0), segment.period)
                parts = sides @ np.add.reduceat(np.where(seen, demodulated / std, 0.0), first, axis=1).T
                sums[k] += parts[:, 0]
                predicted[k] += parts[:, 1]
                weight[k] += float(np.count_nonzero(segment.used[seen]))
        return LineResidual(
            sums=sums,
            predicted=predicted,
            weight=weight,
            overdispersion=self.overdispersion.plus(item.equations, covariance),
        )

    def faded(self, keep: float) -> "LineResidual":
        """Return the sums of data that count `keep` times."""
        return LineResidual(
            sums=keep * self.sums,
            predicted=keep * self.predicted,
            weight=keep * keep * self.weight,
            overdispersion=self.overdispersion.faded(keep),
        )

    @property
    def misfit(self) -> float:
        """Mean square of the sums over what noise explains; about 1, or below, if the model is right."""
        seen = self.weight > 0.0
        if not seen.any():
            return 1.0
        return float(np.mean(np.abs(self.sums[seen]) ** 2 / self.weight[seen, None]))

    @property
    def unexplained(self) -> float:
        """Amplitude of what is left at the lines, beyond noise, over that of what is explained."""
        seen = self.weight > 0.0
        left = np.abs(self.sums[seen]) ** 2 / self.weight[seen, None]
        explained = float(np.sum(np.abs(self.predicted[seen]) ** 2 / self.weight[seen, None]))
        beyond = max(float(np.sum(left)) - left.size, 0.0)
        return math.sqrt(beyond / explained) if explained > 0.0 else 0.0

    def excess(self, travel: float) -> float:
        """What is left at the lines, or differs from segment to segment, over what noise would leave; at least 1."""
        return max(self.inflation(travel), self.overdispersion.inflation)

    def inflation(self, span: float) -> float:
        """Factor by which the misfit widens the variances: 1 as long as chance explains it.

        Parameters
        ----------
        span : float
            Range [rad] of the output angle; it tells how many of the orders are independent of each other.
        """
        independent = self.weight.size * min(2.0 * SIDE + 1.0, 1.0 + 2.0 * SIDE * span / math.tau)
        return max(1.0, self.misfit / (1.0 + 2.0 / math.sqrt(independent)))

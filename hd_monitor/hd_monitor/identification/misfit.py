"""What is left at the lines' own orders after the fit: the sharpest sign of a wrong model."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..reducer import Reducer
from .noise_floor import NoiseFloor
from .normal_equations import Evidence

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

SIDE = 3
"""Orders looked at on either side of a pair's middle: the pair, the lines between and a load's side lines."""

_BLOCK = 0.05  # rad of way over which the residual is summed at once


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
    travel : float
        Way [rad] that the output went.
    """

    sums: ComplexArray
    predicted: ComplexArray
    weight: FloatArray
    travel: float

    @classmethod
    def empty(cls, harmonics: int) -> "LineResidual":
        """Return the sums of no data."""
        nothing = np.zeros((harmonics, 2 * SIDE + 1), dtype=np.complex128)
        return cls(sums=nothing, predicted=nothing, weight=np.zeros(harmonics), travel=0.0)

    def plus(self, evidence: Evidence, floor: NoiseFloor, reducer: Reducer) -> "LineResidual":
        """Add a stretch."""
        stretch, harmonics = evidence.stretch, self.weight.size
        line = evidence.linearisation
        signals = np.stack([line.residual, line.predicted]) * stretch.used
        demodulated = (signals - (signals @ stretch.slow) @ stretch.slow.T).astype(np.complex128)
        middle = sum(reducer.output_orders) / 2.0
        turn = np.exp(-1j * middle * stretch.angle)
        # the orders beside the middle turn slowly: sums over short ways are enough of each sample
        way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(stretch.angle)))])
        first = np.flatnonzero(np.diff(np.floor(way / _BLOCK), prepend=-1.0))
        centre = np.add.reduceat(stretch.angle, first) / np.diff(np.append(first, len(stretch)))
        sides = np.exp(-1j * np.multiply.outer(np.arange(-SIDE, SIDE + 1), centre))
        sums, predicted, weight = self.sums.copy(), self.predicted.copy(), self.weight.copy()
        for k in range(harmonics):
            demodulated *= turn
            frequency = np.abs(stretch.speed) * ((k + 1) * middle / math.tau)
            seen = (frequency > 1.0) & (frequency < stretch.highest_frequency)
            if seen.any():
                std = floor.sample_std(np.maximum(frequency, 1.0), stretch.period)
                parts = sides @ np.add.reduceat(np.where(seen, demodulated / std, 0.0), first, axis=1).T
                sums[k] += parts[:, 0]
                predicted[k] += parts[:, 1]
                weight[k] += float(np.count_nonzero(stretch.used[seen]))
        return LineResidual(sums=sums, predicted=predicted, weight=weight, travel=self.travel + stretch.travel)

    def faded(self, keep: float) -> "LineResidual":
        """Return the sums of data that count `keep` times."""
        return LineResidual(
            sums=keep * self.sums,
            predicted=keep * self.predicted,
            weight=keep * keep * self.weight,
            travel=keep * self.travel,
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

    def inflation(self, span: float) -> float:
        """Factor on the variances that owns up to the misfit: 1 as long as chance explains it.

        Parameters
        ----------
        span : float
            Range [rad] of the output angle; it tells how many of the orders are independent of each other.
        """
        independent = self.weight.size * min(2.0 * SIDE + 1.0, 1.0 + 2.0 * SIDE * span / math.tau)
        return max(1.0, self.misfit / (1.0 + 2.0 / math.sqrt(independent)))

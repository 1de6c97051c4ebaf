"""Gauss-Newton fit of the unknowns to a number of stretches at once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .linearisation import Predictor
from .noise_floor import NoiseFloor, Spectral
from .normal_equations import Evidence, NormalEquations, examine
from .stretch import Stretch

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

LARGEST_FLUCTUATION = 0.8
"""Sum of all abs(β) beyond which the stiffness would come near zero; steps end there."""

_HALVINGS = 5


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Prior:
    """What is known before the stretches at hand, as the quadratic ``x·information·x - 2 vector·x``."""

    information: FloatArray
    vector: FloatArray

    @classmethod
    def gaussian(cls, mean: FloatArray, std: FloatArray) -> "Prior":
        """Return the knowledge of independent unknowns with these means and standard deviations."""
        weight = 1.0 / np.square(std)
        return cls(information=np.diag(weight), vector=weight * mean)

    def cost(self, values: FloatArray) -> float:
        """Return the price of `values`, but for a constant."""
        return float(values @ self.information @ values - 2.0 * self.vector @ values)

    def plus(self, equations: NormalEquations, values: FloatArray) -> "Prior":
        """Add evidence that was linearised at `values`."""
        return Prior(
            information=self.information + equations.information,
            vector=self.vector + equations.information @ values + equations.gradient,
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fit:
    """A point reached by Gauss-Newton steps.

    Attributes
    ----------
    values : ndarray, shape (unknowns,)
    evidence : tuple of Evidence
        Of every stretch, at `values`.
    equations : NormalEquations
        Their sum, without the prior.
    cost : float
        Cost including the prior's.
    step : float
        Size of the next step in standard deviations of the unknowns; small if the fit has converged.
    """

    values: FloatArray
    evidence: tuple[Evidence, ...]
    equations: NormalEquations
    cost: float
    step: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Problem:
    """Stretches to be explained, and what the explanation may use.

    Attributes
    ----------
    stretches : sequence of Stretch
    spectrals : sequence of Spectral
    predictor : Predictor
    prior : Prior
    floor : NoiseFloor
    active : ndarray of bool, shape (unknowns,)
        Unknowns that may move.
    """

    stretches: Sequence[Stretch]
    spectrals: Sequence[Spectral]
    predictor: Predictor
    prior: Prior
    floor: NoiseFloor
    active: BoolArray

    def at(self, values: FloatArray) -> Fit:
        """Evaluate a point."""
        evidence = tuple(
            examine(stretch, spectral, self.predictor, values, self.floor)
            for stretch, spectral in zip(self.stretches, self.spectrals, strict=True)
        )
        equations = evidence[0].equations
        for item in evidence[1:]:
            equations = equations + item.equations
        step, information = self._step(equations, values)
        return Fit(
            values=values,
            evidence=evidence,
            equations=equations,
            cost=equations.cost + self.prior.cost(values),
            step=float(np.sqrt(max(step @ information @ step, 0.0))),
        )

    def _step(self, equations: NormalEquations, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        total = equations.information + self.prior.information
        right = equations.gradient + self.prior.vector - self.prior.information @ values
        step = np.zeros(values.size)
        inner = total[np.ix_(self.active, self.active)]
        step[self.active] = np.linalg.lstsq(inner, right[self.active], rcond=1e-13)[0]
        return step, total

    def solve(self, start: FloatArray, *, rounds: int, tolerance: float = 0.05) -> Fit:
        """Take Gauss-Newton steps from `start` until they are below `tolerance` standard deviations."""
        fit = self.at(start)
        for _ in range(rounds):
            if fit.step < tolerance:
                break
            step, _ = self._step(fit.equations, fit.values)
            step *= self._room(fit.values, step)
            for _ in range(_HALVINGS):
                trial = self.at(fit.values + step)
                if np.isfinite(trial.cost) and trial.cost < fit.cost:
                    break
                step = 0.4 * step
            else:
                break
            fit = trial
        return fit

    def _room(self, values: FloatArray, step: FloatArray) -> float:
        """Part of a step that keeps the stiffness positive."""
        unknowns = self.predictor.unknowns
        factor = 1.0
        while factor > 1e-3:
            total = sum(
                float(np.abs(unknowns.phasors(values + factor * step, part)).sum())
                for part in (unknowns.circular_spline, unknowns.flexspline)
            )
            if total < LARGEST_FLUCTUATION:
                break
            factor *= 0.6
        return factor

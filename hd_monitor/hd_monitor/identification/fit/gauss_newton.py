"""Gauss-Newton fit of the unknowns to a number of segments at once."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from ...arrays import BoolArray, FloatArray
from ..segment.segment import Segment
from .information import Information
from .linearisation import Predictor
from .noise import NoiseFloor
from .normal_equations import LinearisedSegment, NormalEquations, linearise

LARGEST_FLUCTUATION = 0.8
"""Sum of all abs(β) beyond which the stiffness would come near zero; steps end there."""

CONVERGED = 0.05
"""Size of a step, in standard deviations of the unknowns, below which the fit stands."""

NEGLIGIBLE = 0.1
"""Standard deviations that a step may miss its end by for being taken along a straight line."""

EXCLUDED = 14.0
"""Minus twice the logarithm of the likelihood ratio from which another solution is excluded: 1 in 1000."""

DISTINCT = 3.0
"""Standard deviations from which two solutions are two."""

BETTER = 30.0
"""Logarithm of the likelihood ratio by which one solution must beat another, on a few seconds of motion, to replace
it."""

_HALVINGS = 5


class FitStatus(StrEnum):
    """Why a fit ended."""

    CONVERGED = "converged"
    NO_DESCENT = "no_descent"
    ROUNDS_USED_UP = "rounds_used_up"
    ON_BOUND = "on_bound"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fit:
    """A point reached by Gauss-Newton steps.

    Attributes
    ----------
    values : ndarray, shape (unknowns,)
    segments : tuple of LinearisedSegment
        Of every segment, at `values`.
    equations : NormalEquations
        Their sum, without the prior.
    cost : float
        Cost including the prior's.
    step : ndarray, shape (unknowns,)
        The next step.
    step_size : float
        Its size in standard deviations of the unknowns.
    covariance : ndarray, shape (unknowns, unknowns)
        Of the unknowns fitted, by the information of the segments and the prior; 0 for the others.
    status : FitStatus
        Why the steps ended here.
    """

    values: FloatArray
    segments: tuple[LinearisedSegment, ...]
    equations: NormalEquations
    cost: float
    step: FloatArray
    step_size: float
    covariance: FloatArray
    status: FitStatus

    @property
    def floor(self) -> NoiseFloor:
        """Noise floor of what the fit leaves."""
        floor = NoiseFloor()
        for item in self.segments:
            floor = floor.updated(item.segment, item.residual, item.leverage(self.covariance))
        return floor

    @property
    def signal_to_noise(self) -> float:
        """Power of the predicted vibration over that of the residual [dB], in the band that was fitted."""
        predicted = (s.segment.transform(s.linearisation.predicted[:, None]) for s in self.segments)
        explained = sum(float(np.sum(signal**2)) for signal in predicted)
        residual = sum(float(np.sum(s.residual**2)) for s in self.segments)
        return 10.0 * math.log10(max(explained, 1e-300) / max(residual, 1e-300))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Problem:
    """Segments to be explained, and what the explanation may use.

    Attributes
    ----------
    segments : sequence of Segment
    predictor : Predictor
    prior : Information
    floor : NoiseFloor
    active : ndarray of bool, shape (unknowns,)
        Unknowns that may move.
    """

    segments: Sequence[Segment]
    predictor: Predictor
    prior: Information
    floor: NoiseFloor
    active: BoolArray

    def at(self, values: FloatArray) -> Fit:
        """Evaluate a point."""
        segments = tuple(linearise(segment, self.predictor, values, self.floor) for segment in self.segments)
        equations = segments[0].equations
        for item in segments[1:]:
            equations = equations + item.equations
        information = equations.information + self.prior.matrix
        right = equations.score + self.prior.score(values)
        covariance = np.zeros(information.shape)
        place = np.ix_(self.active, self.active)
        covariance[place] = np.linalg.pinv(information[place], rcond=1e-13, hermitian=True)
        step = covariance @ right
        step_size = math.sqrt(max(float(step @ information @ step), 0.0))
        return Fit(
            values=values,
            segments=segments,
            equations=equations,
            cost=equations.cost + self.prior.cost(values),
            step=step,
            step_size=step_size,
            covariance=covariance,
            status=FitStatus.CONVERGED if step_size < CONVERGED else FitStatus.ROUNDS_USED_UP,
        )

    def solve(self, start: FloatArray, *, rounds: int) -> Fit:
        """Take Gauss-Newton steps from `start`, at most `rounds`."""
        return self._solved(self.at(start), rounds)

    def _solved(self, fit: Fit, rounds: int) -> Fit:
        fit = self._descend(fit, rounds)
        on_bound = self.active & (np.abs(fit.values) >= self.predictor.unknowns.bounds())
        return replace(fit, status=FitStatus.ON_BOUND) if on_bound.any() else fit

    def _descend(self, fit: Fit, rounds: int) -> Fit:
        bounds = self.predictor.unknowns.bounds()
        for _ in range(rounds):
            if fit.step_size < CONVERGED:
                break
            if self._curvature(fit) < NEGLIGIBLE:
                return self._moved(fit)
            part = self._room(fit.values, fit.step)
            for _ in range(_HALVINGS):
                there = replace(self, segments=[item.segment_after(fit.step, part) for item in fit.segments])
                trial = there.at(np.clip(fit.values + part * fit.step, -bounds, bounds))
                if math.isfinite(trial.cost) and trial.cost < fit.cost:
                    break
                part *= 0.4
            else:
                return replace(fit, status=FitStatus.NO_DESCENT)
            fit = trial
        return fit

    def _curvature(self, fit: Fit) -> float:
        """Size of what the model is beyond linear over the next step, in standard deviations of the unknowns."""
        unknowns = self.predictor.unknowns
        part = np.abs(fit.step) / unknowns.linear_range()
        forces = unknowns.mask(unknowns.load, unknowns.displacement, unknowns.torque, unknowns.inertia)
        information = fit.equations.information + self.prior.matrix
        forced, rest = (
            math.sqrt(max(float(step @ information @ step), 0.0)) for step in (fit.step * forces, fit.step * ~forces)
        )
        # The prediction is linear in the forces: they bend it together with the other unknowns only
        return (forced + rest) * float(part[~forces].max()) + rest * float(part[forces].max())

    def _moved(self, fit: Fit) -> Fit:
        """Return the fit after its next step, which is so small that evaluating the model there adds nothing."""
        equations, values = fit.equations.moved(fit.step), fit.values + fit.step
        return replace(
            fit,
            values=values,
            segments=tuple(item.moved(fit.step) for item in fit.segments),
            equations=equations,
            cost=equations.cost + self.prior.cost(values),
            step=np.zeros(values.size),
            step_size=0.0,
            status=FitStatus.CONVERGED,
        )

    def multistart(self, starts: Sequence[FloatArray], *, rounds: int) -> list[tuple["Problem", Fit]]:
        """Solve from the most promising of several starts; return the solutions, the best first, with their floors.

        Left out are those that the best one excludes by far. What a start promises is its cost after one step, by the
        quadratic model at the start, with load, clocks and oscillator as the start has them: without any lines they
        mean nothing to the data, and the prior would take them back to what was given. A varying stiffness and a
        transmission error resemble each other, and the way from one to the other is long and bent: so the step is also
        taken with either alone. While the residual is still large the floor is assumed white, otherwise the lines not
        explained yet would pass for noise.
        """
        u = self.predictor.unknowns
        kinds = [u.mask(u.load, u.frequency, u.damping, u.delay, u.drift)]
        if u.transmission_error:
            kinds += [kinds[0] | u.mask(u.displacement), kinds[0] | u.mask(u.stiffness)]
        # A start's linearisation takes megabytes: only one at a time is held
        promises = [[self._promise(fit, self.active & ~held) for held in kinds] for fit in map(self.at, starts)]
        final = []
        for of_kind in zip(*promises, strict=True):
            _, floor, values = min(of_kind, key=lambda promise: promise[0])
            final.append(replace(self, floor=floor)._priced(values, rounds))
        final.sort(key=lambda t: t[0])
        return [(problem, fit) for price, problem, fit in final if price < final[0][0] + 2.0 * BETTER]

    def contend(self, starts: Sequence[FloatArray], *, rounds: int) -> tuple[Fit, FloatArray | None]:
        """Solve from several starts; return the best solution, and the values of another one that is not excluded.

        A start whose quadratic model does not come near the best solution so far is not followed.
        """
        best, *others = starts
        found = [self.solve(best, rounds=rounds)]
        for start in others:
            fit = self.at(start)
            if fit.cost - fit.step_size**2 < found[0].cost + EXCLUDED:
                found = sorted([*found, self._solved(fit, rounds)], key=lambda fit: fit.cost)
        first = found[0]
        information = first.equations.information + self.prior.matrix
        for other in found[1:]:
            apart = other.values - first.values
            if other.cost - first.cost < EXCLUDED and float(apart @ information @ apart) > DISTINCT**2:
                return first, other.values
        return first, None

    def _promise(self, fit: Fit, active: BoolArray) -> tuple[float, NoiseFloor, FloatArray]:
        """Price of a point after one step of some unknowns, the floor that it leaves, and where the step leads."""
        place, step = np.ix_(active, active), np.zeros(active.size)
        information = fit.equations.information + self.prior.matrix
        score = fit.equations.score + self.prior.score(fit.values)
        step[active] = np.linalg.lstsq(information[place], score[active], rcond=1e-13)[0]
        bounds = self.predictor.unknowns.bounds()
        values = np.clip(fit.values + step * self._room(fit.values, step), -bounds, bounds)
        cost = fit.equations.moved(values - fit.values).cost
        freedom = fit.equations.freedom
        price = freedom * math.log(self.floor.mean * cost) + self.prior.cost(values)
        return price, NoiseFloor.white(self.floor.mean * cost / freedom), values

    def _priced(self, start: FloatArray, rounds: int) -> tuple[float, "Problem", Fit]:
        """Solve, and give minus twice the logarithm of the likelihood, the noise's variance being at its own best."""
        fit = self.solve(start, rounds=rounds)
        freedom = fit.equations.freedom
        return freedom * math.log(self.floor.mean * fit.equations.cost) + self.prior.cost(fit.values), self, fit

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

"""The state of an estimation: evidence gathered so far, the best values of the unknowns, and when to look again."""

import copy
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from ..acquisition.record import Record
from ..errors import HdMonitorError, ParameterError
from ..settings import JointSettings
from .conclusion import Conclusions
from .coverage import Coverage
from .exploration import (
    START_LOADS,
    explore_newest,
    is_better,
    load_starts,
    newest_stretches,
    other_starts,
    signal_level,
)
from .gauss_newton import Fit, Problem
from .knowledge import Knowledge
from .linearisation import Predictor
from .misfit import LineResidual
from .noise_floor import NoiseFloor
from .refinement import Score, score
from .result import Identification
from .stretch import Stretch, StretchBuilder
from .tooth_trial import ToothTrial
from .tooth_watch import ToothWatch
from .unknowns import Unknowns

FloatArray = npt.NDArray[np.float64]

LOAD_ORDERS = (1, 2)
"""Cycles per output revolution of unknown load fluctuations: gravity, and the one that mimics the other spline."""

WINDOW = 16.0
"""Motion [s] that is kept to be fitted anew as a whole; from then on each stretch is used once."""

CONTRADICTION = 4.5
"""Standard deviations by which data must contradict what was given before it is estimated, too."""

FREQUENCY_KNOWN, DAMPING_KNOWN = 0.005, 0.05
"""Standard deviations of ln fn and ln ζ below which data know them better than the parameters do."""

_SPEED_VARIES = 0.05  # relative standard deviation of the speed
_TURNED = 0.3  # part of the misfit that may be left once the sensor's sign is turned
_SECOND_LOOK = 3.5  # s of motion at which the exploration made on the first second or so is repeated, if in doubt
_POOR = 1.5  # inflation of the variances, by what the fit leaves at the lines, from which other solutions are sought
_NOMINAL_INDEX = 0.05  # of the larger spline, where an unknown torque leaves the scale open
_SLIP = 0.5  # of the top speed, by which velocities may differ from the change of the positions (root mean square)
_ROUNDS, _FEW_ROUNDS = 8, 4
_MOVED = 3.0  # standard deviations by which values may move before earlier stretches are linearised anew
_YOUNG = 10.0  # s of motion before which a look for other solutions tries all starts
_EARLY = 4.0  # s of poor fits up to which such a look is soon followed by another one
_SOON, _LATE = 2.0, 6.0  # factors by which the time of poor fits grows between such looks, at first and later
_LEAST_AGE = 2.0  # s of poor fits that a look counts for at least
_APART = 1.2  # factor by which all motion grows between them, if fits are poor now and then


class Estimation:
    """Estimates the unknowns of one reducer from stretches.

    Parameters
    ----------
    settings : JointSettings

    Attributes
    ----------
    result : Identification or None
        Newest result.
    seconds : float
        Motion used [s].
    unusable : str
        Why the newest stretch that could not be used could not; empty if all were.
    """

    def __init__(self, settings: JointSettings) -> None:
        self._given = settings.dynamics
        self._reducer = settings.reducer
        self._refine: bool = settings["dynamics.refine"]
        self._memory: float = settings["analysis.memory"]
        self._load_torque: float = settings["load.torque"] if settings["load.source"] in ("auto", "parameter") else 0.0
        self._unknowns = u = Unknowns(harmonics=settings["analysis.harmonics"], load_orders=LOAD_ORDERS)
        self._builder = StretchBuilder(
            reducer=self._reducer,
            harmonics=u.harmonics,
            load_orders=LOAD_ORDERS,
            natural_frequency=self._given.natural_frequency,
            inertial=settings["input.source"] == "imu",
        )
        self._std = _given_std(u)
        self._prior = Knowledge.gaussian(self._std)
        self._learnt = Knowledge.none(u.size)
        self._predictor: Predictor | None = None
        self._nominal_torque: float | None = None
        self._values = u.zero()
        self._active = u.mask(u.stiffness, u.load, u.inertia)
        self._recent: list[Stretch] = []
        self._mounting = 1.0
        self._fitted_anew = 0.0
        self._floor: NoiseFloor | None = None
        self._line_residual = LineResidual.empty(u.harmonics)
        self._explored = 0.0
        self._poor_since = math.inf
        self._coverage = Coverage()
        self._teeth = ToothWatch()
        self._conclusions = Conclusions(settings, u)
        self.result: Identification | None = None
        self.seconds = 0.0
        self.unusable = ""

    @property
    def well_known(self) -> bool:
        """Whether more data would tell nothing more of interest."""
        return self.seconds >= WINDOW and self.result is not None and self._conclusions.well_known(self.result)

    def take(self, records: Sequence[Record]) -> None:
        """Use a stretch, given as records that follow each other; one that defies all arithmetic is left out."""
        kept = copy.copy(self)
        kept._recent = list(self._recent)
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                self._use(records)
        except (FloatingPointError, OverflowError, np.linalg.LinAlgError, HdMonitorError) as error:
            self.__dict__.update(kept.__dict__)
            self.unusable = str(error)

    def _use(self, records: Sequence[Record]) -> None:
        stretch = self._build(records)
        values = stretch.acceleration[stretch.used]
        slip = np.diff(stretch.angle) / stretch.period - 0.5 * (stretch.speed[1:] + stretch.speed[:-1])
        if float(np.mean(slip**2)) > (_SLIP * float(np.abs(stretch.speed).max())) ** 2:
            raise ParameterError("positions and velocities of the joint contradict each other: check joint_states")
        if values.size < 4 * self._unknowns.size or float(np.ptp(values)) == 0.0:
            return
        self.seconds += stretch.duration
        self._coverage = self._coverage.plus(stretch)
        self._recent.append(stretch)
        while sum(s.duration for s in self._recent[1:]) >= WINDOW:
            self._recent.pop(0)
        fit = self._fit()
        floor, rest = self._rest(fit)
        poor = rest.inflation(self._coverage.span) > _POOR
        self._poor_since = min(self._poor_since, self.seconds) if poor else math.inf
        if self._is_poor(rest):
            fit = self._look_elsewhere(fit)
            floor, rest = self._rest(fit)
            if rest.inflation(self._coverage.span) > _POOR:
                fit = self._turn_sensor(fit)
                floor, rest = self._rest(fit)
        questioned = self._question(fit)
        if questioned is not fit:
            fit = questioned
            floor, rest = self._rest(fit)
        self._values, self._floor, self._line_residual = fit.values, floor, rest
        self._learnt = self._learnt.plus(fit.equations, fit.values)
        self._question_teeth(fit)
        self._conclude(fit)
        self.age(sum(item.stretch.duration for item in fit.evidence))

    # Preparation ---------------------------------------------------------------------------------------------------

    def _build(self, records: Sequence[Record]) -> Stretch:
        """Make a stretch, with the sensor's sign as found so far."""
        stretch = self._build_as_mounted(records)
        return stretch if self._mounting > 0.0 else stretch.mirrored()

    def _build_as_mounted(self, records: Sequence[Record]) -> Stretch:
        """Make a stretch; where nobody knows the torque, a nominal one stands for it."""
        if np.isfinite(records[0].torque).all():
            return self._builder.build(records, None)
        if self._load_torque:
            return self._builder.build(records, self._load_torque)
        if self._nominal_torque is None:
            unit = self._given.stiffness * 1e-3  # a wind-up of 1 mrad
            u, stretch = self._unknowns, self._builder.build(records, unit)
            problem = Problem(
                stretches=[stretch],
                predictor=Predictor(unknowns=u, given=self._given, reference_torque=unit),
                prior=self._prior,
                floor=signal_level([stretch]),
                active=u.mask(u.stiffness),
            )
            step = problem.at(u.zero()).step
            size = max(float(np.linalg.norm(step[part])) for part in (u.circular_spline, u.flexspline))
            self._nominal_torque = unit * max(size, 1e-6) / _NOMINAL_INDEX
            self._active = self._active | u.mask(u.torque)
        return self._builder.build(records, self._nominal_torque)

    def _problem(self, stretches: Sequence[Stretch], prior: Knowledge) -> Problem:
        if self._predictor is None:
            torque = np.concatenate([s.at_steps.torque for s in stretches])
            level = max(float(np.sqrt(np.mean(torque**2))), 0.1 * abs(self._load_torque), 1e-9 * self._given.stiffness)
            self._predictor = Predictor(unknowns=self._unknowns, given=self._given, reference_torque=level)
        return Problem(
            stretches=stretches,
            predictor=self._predictor,
            prior=prior,
            floor=signal_level(stretches) if self._floor is None else self._floor,
            active=self._active,
        )

    # Fitting -------------------------------------------------------------------------------------------------------

    def _fit(self) -> Fit:
        """Fit the newest stretch on top of what is learnt; every now and then all anew, while all are at hand."""
        young = self.seconds <= WINDOW
        if self._floor is None:
            return self._explore(self._anew(), [self._values], rounds=_FEW_ROUNDS)
        if young and self.seconds >= 2.0 * self._fitted_anew:
            return self._anew().solve(self._values, rounds=_ROUNDS)
        fit = self._problem(self._recent[-1:], self._prior + self._learnt).solve(self._values, rounds=3)
        change = fit.values - self._values
        if young and float(change @ self._learnt.information @ change) > _MOVED**2:
            fit = self._anew().solve(fit.values, rounds=_ROUNDS)
        return fit

    def _anew(self) -> Problem:
        """Return the problem of all recent stretches, and forget what was learnt of them and others."""
        self._fitted_anew = self.seconds
        self._learnt = Knowledge.none(self._unknowns.size)
        return self._problem(self._recent, self._prior)

    def _explore(self, problem: Problem, starts: Sequence[FloatArray], *, rounds: int) -> Fit:
        """Solve from several starts on the newest data, then on all."""
        self._explored = self.seconds
        small, best = explore_newest(problem, starts, rounds=rounds)
        return self._follow(problem, small, [best.values, starts[0]] if len(starts) > 1 else [best.values], rounds)

    @staticmethod
    def _follow(problem: Problem, small: Problem, candidates: Sequence[FloatArray], rounds: int) -> Fit:
        """Solve on all data from what the newest told."""
        whole = replace(problem, floor=small.floor)
        fit = min((whole.solve(values, rounds=rounds) for values in candidates), key=lambda f: f.cost)
        return replace(problem, floor=fit.floor).solve(fit.values, rounds=rounds)

    def _is_poor(self, rest: LineResidual) -> bool:
        """Whether so much is left at the lines that other solutions should be looked for, as often as effort allows."""
        inflation = rest.inflation(self._coverage.span)
        if self._explored < _SECOND_LOOK <= self.seconds:
            return inflation > 1.0
        if self._explored < _SECOND_LOOK or self._teeth.rival is not None or not inflation > _POOR:
            return False  # too early; or the teeth are wrong, and so would be every solution
        if self._explored < self._poor_since:
            return self.seconds > _APART * self._explored  # what was right so far is right no more
        looked, age = self._explored - self._poor_since, self.seconds - self._poor_since
        return age > (_SOON if looked < _EARLY else _LATE) * max(looked, _LEAST_AGE)

    def _turn_sensor(self, fit: Fit) -> Fit:
        """Try the sensor's sign the other way round: against that of the torque it is a matter of mounting.

        To first order the opposite sign only turns the phases of all β; the coupling of the lines tells it. The load's
        local minima come in either sign, so it is turned only where no load explains the motion as it is.
        """
        u = self._unknowns
        given = self._active & ~u.mask(u.frequency, u.damping, u.delay)
        turned = [stretch.mirrored() for stretch in self._recent]
        start = np.where(given, fit.values, 0.0) * np.where(u.mask(u.stiffness), -1.0, 1.0)
        mirrored = replace(self._problem(turned, self._prior), active=given)
        small, best = explore_newest(mirrored, load_starts(u, start, thorough=True), rounds=_ROUNDS)
        as_it_is = replace(small, stretches=newest_stretches(self._recent))
        if not is_better(as_it_is, best, fit.values):
            return fit
        kept = self._recent, self._active, self._learnt, self._fitted_anew
        _, rest = self._rest(fit)
        self._recent, self._active = turned, given
        other = self._follow(self._anew(), small, [best.values], _ROUNDS)
        if self._rest(other)[1].misfit > _TURNED * rest.misfit:
            self._recent, self._active, self._learnt, self._fitted_anew = kept
            return fit
        self._mounting = -self._mounting
        return other

    def _look_elsewhere(self, fit: Fit) -> Fit:
        """Try other solutions on the newest stretches: the fit leaves more at the lines than noise could.

        If later none is better there, the fit stays as it is, and no effort goes into all recent stretches.
        """
        u, kept = self._unknowns, self._active
        self._active = self._active & ~u.mask(u.frequency, u.damping, u.delay)
        if self._refine:
            self._active = self._active | u.mask(u.frequency, u.damping)
        lag = self._coverage.speed_varies
        if lag:
            self._active = self._active | u.mask(u.delay)
        thorough, self._explored = self.seconds < _YOUNG, self.seconds
        starts = load_starts(u, np.where(self._active, fit.values, 0.0), thorough=thorough)
        starts += other_starts(u, frequency=self._refine, delay=lag, thorough=thorough)
        small, best = explore_newest(self._problem(self._recent, self._prior), starts, rounds=_ROUNDS)
        if thorough:
            return self._follow(self._anew(), small, [best.values, starts[0]], _ROUNDS)
        if is_better(small, best, fit.values):
            return self._follow(self._anew(), small, [best.values], _FEW_ROUNDS)
        self._active = kept
        return fit

    def _question(self, fit: Fit) -> Fit:
        """Ask whether what was given agrees with the data, and estimate along what does not."""
        u = self._unknowns
        candidates = [u.delay, u.frequency, u.damping] if self._refine else [u.delay]
        for _ in candidates:
            knowledge = (self._prior + self._learnt).plus(fit.equations, fit.values)
            waiting = [place for place in candidates if not self._active[place]]
            scores = {place: self._score(place, knowledge, fit.values) for place in waiting}
            wrong = [place for place in waiting if scores[place].significance > CONTRADICTION]
            if self._coverage.speed_varies:
                known = ((u.frequency, FREQUENCY_KNOWN), (u.damping, DAMPING_KNOWN))
                wrong += [place for place, std in known if place in waiting and scores[place].std < std]
            if not wrong:
                break
            worst = max(wrong, key=lambda place: scores[place].significance)
            self._active = self._active | u.mask(worst)
            stretches = [item.stretch for item in fit.evidence]
            fit = self._problem(stretches, self._prior + self._learnt).solve(fit.values, rounds=_ROUNDS)
        return fit

    def _question_teeth(self, fit: Fit) -> None:
        """Ask whether other tooth numbers than those given explain the recent motion better."""
        assert self._predictor is not None
        trial = ToothTrial(
            stretches=self._recent,
            given=self._given,
            unknowns=self._unknowns,
            active=self._active,
            prior=self._prior,
            reference_torque=self._predictor.reference_torque,
            values=fit.values,
            load_starts=(0.0, START_LOADS[0]),
            inertial=self._builder.inertial,
        )
        self._teeth = self._teeth.after(fit, self._given, anew=self._fitted_anew == self.seconds).look(
            trial.leads,
            self._reducer,
            self._unknowns.harmonics,
            seconds=self.seconds,
            one_speed=not self._coverage.speed_varies,
        )

    def _score(self, place: int, knowledge: Knowledge, values: FloatArray) -> Score:
        return score(place, knowledge, values, self._active, float(self._std[place]))

    # Learning ------------------------------------------------------------------------------------------------------

    def _rest(self, fit: Fit) -> tuple[NoiseFloor, LineResidual]:
        """Noise floor, and what is left at the lines, with a fit's part in both."""
        if self._floor is None or self._fitted_anew == self.seconds:
            floor, rest = fit.floor, LineResidual.empty(self._unknowns.harmonics)
        else:
            floor, rest = self._floor + fit.floor, self._line_residual
        for item in fit.evidence:
            rest = rest.plus(item, fit.covariance, floor, self._reducer)
        return floor, rest

    def age(self, duration: float) -> None:
        """Let `duration` [s] of motion pass, over which evidence fades."""
        keep = math.exp(-duration / self._memory)
        self._learnt = self._learnt.faded(keep)
        self._line_residual = self._line_residual.faded(keep)
        self._teeth = self._teeth.faded(keep)
        if self._floor is not None:
            self._floor = self._floor.faded(keep)

    def _conclude(self, fit: Fit) -> None:
        u = self._unknowns
        knowledge = self._prior + self._learnt
        places = (u.frequency, u.damping, u.torque, u.delay)
        assert self._predictor is not None
        self.result = self._conclusions.conclude(
            predictor=self._predictor,
            values=fit.values,
            active=self._active,
            knowledge=knowledge,
            scores={place: self._score(place, knowledge, fit.values) for place in places},
            misfit=self._line_residual,
            coverage=self._coverage,
            recent=self._recent,
            evidence=fit.evidence,
            floor=self._floor or fit.floor,
            relative=self._nominal_torque is not None,
        )
        if blocker := self._teeth.blocker(self._reducer):
            self.result = replace(self.result, blockers=(blocker, *self.result.blockers))


def _given_std(unknowns: Unknowns) -> FloatArray:
    """Standard deviations of the unknowns before any data."""
    std = np.empty(unknowns.size)
    std[unknowns.stiffness] = 0.3
    std[unknowns.load] = 2.0
    std[unknowns.frequency] = 0.1
    std[unknowns.damping] = 0.5
    std[unknowns.torque] = 1.5
    std[unknowns.delay] = 0.01
    std[unknowns.inertia] = 0.7
    return std

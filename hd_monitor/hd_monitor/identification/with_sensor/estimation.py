"""The state of an estimation: evidence gathered so far, the best values of the unknowns, and when to look again."""

import copy
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...errors import HdMonitorError, ParameterError
from ...settings import JointSettings
from ..checks.coverage import Coverage
from ..checks.residual import LineResidual
from ..fit.gauss_newton import Fit, Problem
from ..fit.information import Information
from ..fit.linearisation import Predictor
from ..fit.multistart import (
    START_LOADS,
    is_better,
    load_starts,
    multistart_newest,
    newest_segments,
    other_starts,
    signal_level,
)
from ..fit.noise import NoiseFloor
from ..fit.normal_equations import LinearisedSegment
from ..fit.score_test import ScoreTest, score_tests
from ..fit.unknowns import Unknowns
from ..limitation import Limitation, LimitationCode
from ..result import Identification
from ..segment.preparation import Preparation
from ..segment.segment import Segment
from ..teeth.trial import ToothTrial
from ..teeth.watch import ToothWatch
from .conclusion import Conclusions
from .schedule import POOR, SECOND_LOOK, Schedule

LOAD_ORDERS = (1, 2)
"""Cycles per output revolution of unknown load fluctuations: gravity, and the one that mimics the other spline."""

WINDOW = 16.0
"""Motion [s] that is kept to be fitted anew as a whole; from then on each segment is used once."""

CONTRADICTION = 4.5
"""Standard deviations by which data must contradict what was given before it is estimated, too."""

FREQUENCY_KNOWN, DAMPING_KNOWN = 0.005, 0.05
"""Standard deviations of ln fn and ln ζ below which data know them better than the parameters do."""

_TURNED = 0.3  # part of the misfit that may be left once the sensor's sign is turned
_SLIP = 0.5  # of the top speed, by which velocities may differ from the change of the positions (root mean square)
_ROUNDS, _FEW_ROUNDS = 8, 4
_MOVED = 3.0  # standard deviations by which values may move before earlier segments are linearised anew
_YOUNG = 10.0  # s of motion before which a look for other solutions tries all starts


class Estimation:
    """Estimates the unknowns of one reducer from segments.

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
        Why the newest segment that could not be used could not; empty if all were.
    """

    def __init__(self, settings: JointSettings) -> None:
        self._given = settings.dynamics
        self._reducer = settings.reducer
        self._refine = settings.refine_dynamics
        self._memory = settings.analysis.memory
        self._unknowns = u = Unknowns(harmonics=settings.analysis.harmonics, load_orders=LOAD_ORDERS)
        self._std = u.given_std()
        self._prior = Information.gaussian(self._std)
        self._preparation = Preparation(settings, u, self._prior)
        self._learnt = Information.none(u.size)
        self._predictor: Predictor | None = None
        self._values = u.zero()
        self._active = u.mask(u.stiffness, u.load, u.inertia)
        self._recent: list[Segment] = []
        self._known: dict[Segment, LinearisedSegment] = {}
        self._fitted_anew = 0.0
        self._floor: NoiseFloor | None = None
        self._line_residual = LineResidual.empty(u.harmonics)
        self._schedule = Schedule()
        self._coverage = Coverage()
        self._teeth = ToothWatch()
        self._conclusions = Conclusions(settings, u)
        self.result: Identification | None = None
        self.seconds = 0.0
        self.unusable = ""

    @property
    def sureness(self) -> float:
        """How well the indexes are known: from 1 on, more data would tell nothing more of interest."""
        if self.seconds < WINDOW or self.result is None:
            return 0.0
        return self._conclusions.sureness(self.result)

    def take(self, records: Sequence[Record]) -> None:
        """Use a segment, given as records that follow each other; one that defies all arithmetic is left out."""
        kept = copy.copy(self)
        kept._recent, kept._preparation = list(self._recent), copy.copy(self._preparation)
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                self._use(records)
        except (FloatingPointError, OverflowError, np.linalg.LinAlgError, HdMonitorError) as error:
            self.__dict__.update(kept.__dict__)
            self.unusable = str(error)

    def _use(self, records: Sequence[Record]) -> None:
        segment = self._preparation.build(records)
        values = segment.acceleration[segment.used]
        slip = np.diff(segment.angle) / segment.period - 0.5 * (segment.speed[1:] + segment.speed[:-1])
        if float(np.mean(slip**2)) > (_SLIP * float(np.abs(segment.speed).max())) ** 2:
            raise ParameterError("positions and velocities of the joint contradict each other: check joint_states")
        if values.size < 4 * self._unknowns.size or float(np.ptp(values)) == 0.0:
            return
        if self._preparation.nominal_torque is not None:
            self._active = self._active | self._unknowns.mask(self._unknowns.torque)
        self.seconds += segment.duration
        self._coverage = self._coverage.plus(segment)
        self._recent.append(segment)
        while sum(s.duration for s in self._recent[1:]) >= WINDOW:
            self._recent.pop(0)
        fit = self._fit()
        floor, rest = self._rest(fit)
        inflation = rest.inflation(self._coverage.span)
        self._schedule = self._schedule.after(inflation, self.seconds)
        hopeless = self._teeth.rival is not None and self._schedule.looked >= SECOND_LOOK  # with the wrong teeth
        if not hopeless and self._schedule.is_due(inflation, self.seconds):
            fit = self._look_elsewhere(fit)
            floor, rest = self._rest(fit)
            if rest.inflation(self._coverage.span) > POOR:
                fit = self._turn_sensor(fit)
                floor, rest = self._rest(fit)
        questioned = self._question(fit)
        if questioned is not fit:
            fit = questioned
            floor, rest = self._rest(fit)
        self._values, self._floor, self._line_residual = fit.values, floor, rest
        self._learnt = self._learnt.plus(fit.equations, fit.values)
        known = self._known | {item.segment: item for item in fit.segments}
        at_hand = self._recent if self.seconds <= WINDOW else []
        self._known = {segment: known[segment] for segment in at_hand if segment in known}
        self._question_teeth(fit)
        self._conclude(fit)
        self.age(sum(item.segment.duration for item in fit.segments))

    def _problem(self, segments: Sequence[Segment], prior: Information) -> Problem:
        if self._predictor is None:
            level = self._preparation.reference_torque(segments)
            self._predictor = Predictor(unknowns=self._unknowns, given=self._given, reference_torque=level)
        return Problem(
            segments=segments,
            predictor=self._predictor,
            prior=prior,
            floor=signal_level(segments) if self._floor is None else self._floor,
            active=self._active,
        )

    # Fitting -------------------------------------------------------------------------------------------------------

    def _fit(self) -> Fit:
        """Fit the newest segment on top of what is learnt; every now and then all anew, while all are at hand."""
        young = self.seconds <= WINDOW
        if self._floor is None:
            self._schedule = self._schedule.with_look(self.seconds)
            problem = self._anew()
            small, best = multistart_newest(problem, [self._values], rounds=_FEW_ROUNDS)
            return self._follow(problem, small, [best], _FEW_ROUNDS)
        if young and self.seconds >= 2.0 * self._fitted_anew:
            return self._anew().solve_near(self._values, self._known, rounds=_ROUNDS)
        fit = self._problem(self._recent[-1:], self._prior + self._learnt).solve(self._values, rounds=3)
        change = fit.values - self._values
        if young and float(change @ self._learnt.matrix @ change) > _MOVED**2:
            fit = self._anew().solve_near(
                fit.values, self._known | {e.segment: e for e in fit.segments}, rounds=_ROUNDS
            )
        return fit

    def _anew(self) -> Problem:
        """Return the problem of all recent segments, and forget what was learnt of them and others."""
        self._fitted_anew = self.seconds
        self._learnt = Information.none(self._unknowns.size)
        return self._problem(self._recent, self._prior)

    @staticmethod
    def _follow(problem: Problem, small: Problem, candidates: Sequence[FloatArray | Fit], rounds: int) -> Fit:
        """Solve on all data from what the newest told."""
        whole = replace(problem, floor=small.floor)
        fit = min((whole.solve(start, rounds=rounds) for start in candidates), key=lambda f: f.cost)
        return replace(problem, floor=fit.floor).solve(fit, rounds=rounds)

    def _turn_sensor(self, fit: Fit) -> Fit:
        """Try the sensor's sign the other way round: against that of the torque it is a matter of mounting.

        To first order the opposite sign only turns the phases of all β; the coupling of the lines tells it. The load's
        local minima come in either sign, so it is turned only where no load explains the motion as it is.
        """
        u = self._unknowns
        given = self._active & ~u.mask(u.frequency, u.damping, u.delay)
        turned = [segment.mirrored() for segment in self._recent]
        start = np.where(given, fit.values, 0.0) * np.where(u.mask(u.stiffness), -1.0, 1.0)
        mirrored = replace(self._problem(turned, self._prior), active=given)
        small, best = multistart_newest(mirrored, load_starts(u, start, thorough=True), rounds=_ROUNDS)
        as_it_is = replace(small, segments=newest_segments(self._recent))
        if not is_better(as_it_is, best, fit.values):
            return fit
        kept = self._recent, self._active, self._learnt, self._fitted_anew
        _, rest = self._rest(fit)
        self._recent, self._active = turned, given
        other = self._follow(self._anew(), small, [best.values], _ROUNDS)
        if self._rest(other)[1].misfit > _TURNED * rest.misfit:
            self._recent, self._active, self._learnt, self._fitted_anew = kept
            return fit
        self._preparation.mounting *= -1.0
        return other

    def _look_elsewhere(self, fit: Fit) -> Fit:
        """Try other solutions on the newest segments: the fit leaves more at the lines than noise could.

        If later none is better there, the fit stays as it is, and no effort goes into all recent segments.
        """
        u, kept = self._unknowns, self._active
        self._active = self._active & ~u.mask(u.frequency, u.damping, u.delay)
        if self._refine:
            self._active = self._active | u.mask(u.frequency, u.damping)
        lag = self._coverage.speed_varies
        if lag:
            self._active = self._active | u.mask(u.delay)
        thorough, self._schedule = self.seconds < _YOUNG, self._schedule.with_look(self.seconds)
        starts = load_starts(u, np.where(self._active, fit.values, 0.0), thorough=thorough)
        starts += other_starts(u, frequency=self._refine, delay=lag, thorough=thorough)
        small, best = multistart_newest(self._problem(self._recent, self._prior), starts, rounds=_ROUNDS)
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
            information = (self._prior + self._learnt).plus(fit.equations, fit.values)
            waiting = [place for place in candidates if not self._active[place]]
            asked = self._scores(waiting, information, fit.values)
            wrong = [place for place in waiting if asked[place].significance > CONTRADICTION]
            if self._coverage.speed_varies:
                known = ((u.frequency, FREQUENCY_KNOWN), (u.damping, DAMPING_KNOWN))
                wrong += [place for place, std in known if place in waiting and asked[place].std < std]
            if not wrong:
                break
            worst = max(wrong, key=lambda place: asked[place].significance)
            self._active = self._active | u.mask(worst)
            segments = [item.segment for item in fit.segments]
            fit = self._problem(segments, self._prior + self._learnt).solve(fit.values, rounds=_ROUNDS)
        return fit

    def _question_teeth(self, fit: Fit) -> None:
        """Ask whether other tooth numbers than those given explain the recent motion better."""
        assert self._predictor is not None
        trial = ToothTrial(
            segments=self._recent,
            given=self._given,
            unknowns=self._unknowns,
            active=self._active,
            prior=self._prior,
            reference_torque=self._predictor.reference_torque,
            values=fit.values,
            load_starts=(0.0, START_LOADS[0]),
            inertial=self._preparation.inertial,
        )
        self._teeth = self._teeth.after(fit, self._given, anew=self._fitted_anew == self.seconds).look(
            trial.leads,
            self._reducer,
            self._unknowns.harmonics,
            seconds=self.seconds,
            one_speed=not self._coverage.speed_varies,
        )

    def _scores(self, places: Sequence[int], information: Information, values: FloatArray) -> dict[int, ScoreTest]:
        return score_tests(places, information, values, self._active, self._std)

    # Learning ------------------------------------------------------------------------------------------------------

    def _rest(self, fit: Fit) -> tuple[NoiseFloor, LineResidual]:
        """Noise floor, and what is left at the lines, with a fit's part in both."""
        if self._floor is None or self._fitted_anew == self.seconds:
            floor, rest = fit.floor, LineResidual.empty(self._unknowns.harmonics)
        else:
            floor, rest = self._floor + fit.floor, self._line_residual
        for item in fit.segments:
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
        information = self._prior + self._learnt
        places = (u.frequency, u.damping, u.torque, u.delay)
        assert self._predictor is not None
        self.result = self._conclusions.conclude(
            predictor=self._predictor,
            values=fit.values,
            active=self._active,
            information=information,
            score_tests=self._scores(places, information, fit.values),
            misfit=self._line_residual,
            coverage=self._coverage,
            recent=self._recent,
            evidence=fit.segments,
            floor=self._floor or fit.floor,
            relative=self._preparation.nominal_torque is not None,
        )
        if blocker := self._teeth.blocker(self._reducer):
            said = Limitation(code=LimitationCode.OTHER, blocks=True, values={"text": blocker})
            self.result = replace(self.result, limitations=(said, *self.result.limitations))

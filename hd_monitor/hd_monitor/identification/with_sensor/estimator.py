"""The update of a state by a segment: fit it on top of what is known, doubt the fit, conclude."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...errors import HdMonitorError
from ...limitation import LimitationCode, blocker
from ...settings import JointSettings
from ..fit.gauss_newton import Fit
from ..fit.multistart import multistart_newest
from ..fit.score_test import score_tests
from ..teeth.trial import ToothTrial
from ..teeth.watch import ToothWatch
from .conclusion import conclude
from .context import Context, Unexplained
from .limitations import CONTRADICTION
from .schedule import POOR, SECOND_LOOK
from .search import look_elsewhere, restart, turn_sensor
from .state import WINDOW, State

WELL_KNOWN = 0.02
"""Standard deviation of the indexes over the larger of index and warn limit that satisfies."""

FREQUENCY_KNOWN, DAMPING_KNOWN = 0.005, 0.05
"""Standard deviations of ln fn and ln ζ below which data know them better than the parameters do."""

_ROUNDS, _FEW_ROUNDS, _UPDATE_ROUNDS = 8, 4, 3
_MOVED = 3.0  # standard deviations by which values may move before earlier segments are linearised again


class Estimator:
    """Updates the state of an estimation; it has none of its own.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._context = Context.of(settings)

    def initial(self) -> State:
        """Return the state before any data."""
        return State.initial(self._context.unknowns)

    def sureness(self, state: State) -> float:
        """How well the indexes are known: from 1 on, more data would add nothing of interest.

        It is `WELL_KNOWN` over the standard deviation of the indexes, relative to the larger of index and warn limit;
        0 where no part may be named.
        """
        result = state.result
        if state.seconds < WINDOW or result is None or result.blockers:
            return 0.0
        scale = max(self._context.settings.diagnosis.warn_index, *result.index)
        return WELL_KNOWN * scale / max(*result.index_std, 1e-12)

    def aged(self, state: State, duration: float) -> State:
        """Return the state after `duration` [s] of motion that was not looked at."""
        return state.aged(duration, self._context.settings.analysis.memory)

    def update(self, state: State, records: Sequence[Record]) -> State:
        """Return the state after a segment, given as records that follow each other.

        A segment that cannot be used leaves the state as it is but for `unusable`, which says why.
        """
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                return self._updated(state, records)
        except (FloatingPointError, OverflowError, np.linalg.LinAlgError, HdMonitorError) as error:
            return replace(state, unusable=blocker(LimitationCode.SEGMENT_UNUSABLE, cause=str(error)))

    def _updated(self, state: State, records: Sequence[Record]) -> State:
        context, u = self._context, self._context.unknowns
        segment, setup = context.segment(records, state.setup)
        values = segment.acceleration[segment.used]
        if values.size < 4 * u.size:
            return state
        if float(np.ptp(values)) == 0.0:
            return replace(state, unusable=blocker(LimitationCode.VIBRATION_CONSTANT))
        state = state.with_segment(segment, setup)
        if setup.nominal_torque is not None:
            state = replace(state, active=state.active | u.mask(u.torque))
        state, fit, left = self._search(*self._fit(state))
        state, questioned = self._question(state, fit)
        if questioned is not fit:
            fit = questioned
            left = context.unexplained(state, fit)
        state = replace(
            state,
            values=fit.values,
            floor=left.floor,
            residual=left.residual,
            information=state.information.plus(fit.equations, fit.values),
        )
        anew = state.schedule.restarted == state.seconds
        state = replace(state, teeth=self._question_teeth(state, fit), tones=state.tones.after(fit.segments, anew=anew))
        state = replace(state, result=conclude(context, state, fit))
        return self.aged(state, sum(item.segment.duration for item in fit.segments))

    def _fit(self, state: State) -> tuple[State, Fit]:
        """Fit the newest segment on top of what is known; from time to time, while all are kept, all of them."""
        context = self._context
        if state.floor is None:
            state = replace(state, schedule=state.schedule.with_look(state.seconds))
            small, best = multistart_newest(context.problem_of_all(state), [state.values], rounds=_FEW_ROUNDS)
            return restart(context, state, small, [best.values], _FEW_ROUNDS)
        young = state.seconds <= WINDOW
        # Where errors resemble the stiffness, what was linearised at other values soon misleads
        ambiguous = bool(context.unknowns.transmission_error)
        if young and (ambiguous or state.seconds >= 2.0 * state.schedule.restarted):
            return self._fit_all(state, state.values)
        fit = context.problem(state, state.recent[-1:], context.known(state)).solve(state.values, rounds=_UPDATE_ROUNDS)
        change = fit.values - state.values
        if young and float(change @ state.information.matrix @ change) > _MOVED**2:
            return self._fit_all(state, fit.values)
        return state, fit

    def _fit_all(self, state: State, start: FloatArray) -> tuple[State, Fit]:
        state = state.restarted()
        return state, self._context.problem_of_all(state).solve(start, rounds=_ROUNDS)

    def _search(self, state: State, fit: Fit) -> tuple[State, Fit, Unexplained]:
        """Look for other solutions, as often as effort allows, if the fit leaves more at the lines than noise could."""
        context = self._context
        left = context.unexplained(state, fit)
        inflation = left.residual.inflation(state.coverage.span)
        state = replace(state, schedule=state.schedule.after(inflation, state.seconds))
        # With the wrong teeth no solution is right
        hopeless = state.teeth.doubt is not None and state.schedule.looked >= SECOND_LOOK
        if hopeless or not state.schedule.is_due(inflation, state.seconds):
            return state, fit, left
        state, fit = look_elsewhere(context, state, fit)
        left = context.unexplained(state, fit)
        if left.residual.inflation(state.coverage.span) > POOR:
            state, fit = turn_sensor(context, state, fit)
            left = context.unexplained(state, fit)
        return state, fit, left

    def _question(self, state: State, fit: Fit) -> tuple[State, Fit]:
        """Ask whether what was given agrees with the data, and estimate what does not."""
        context, u = self._context, self._context.unknowns
        candidates = [u.delay, u.frequency, u.damping] if context.settings.refine_dynamics else [u.delay]
        known = {u.frequency: FREQUENCY_KNOWN, u.damping: DAMPING_KNOWN} if state.coverage.speed_varies else {}
        for _ in candidates:
            information = context.known(state).plus(fit.equations, fit.values)
            waiting = [place for place in candidates if not state.active[place]]
            tests = score_tests(waiting, information, fit.values, state.active, u.given_std())
            wrong = [
                place
                for place in waiting
                if tests[place].significance > CONTRADICTION or tests[place].std < known.get(place, 0.0)
            ]
            if not wrong:
                break
            worst = max(wrong, key=lambda place: tests[place].significance)
            state = replace(state, active=state.active | u.mask(worst))
            segments = [item.segment for item in fit.segments]
            fit = context.problem(state, segments, context.known(state)).solve(fit.values, rounds=_ROUNDS)
        return state, fit

    def _question_teeth(self, state: State, fit: Fit) -> ToothWatch:
        """Ask whether other tooth numbers than those given explain the recent motion better."""
        context = self._context
        trial = ToothTrial(problem=context.problem_of_all(state), values=fit.values, builder=context.builder)
        return state.teeth.after(fit, context.given, anew=state.schedule.restarted == state.seconds).look(
            context.settings.reducer,
            context.unknowns.harmonics,
            trial.best,
            seconds=state.seconds,
            one_speed=not state.coverage.speed_varies,
        )

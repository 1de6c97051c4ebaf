"""The update of a state by a segment: fit it on top of what is known, doubt the fit, conclude."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...acquisition.record import Record
from ...errors import HdMonitorError
from ...limitation import LimitationCode, blocker
from ...settings import JointSettings
from ..fit.gauss_newton import Fit
from ..teeth.trial import ToothTrial
from ..teeth.watch import ToothWatch
from .conclusion import conclude
from .context import Context, Unexplained
from .schedule import POOR, SECOND_LOOK
from .search import (
    fit_wandering,
    is_followed,
    is_poor,
    let_inertia_wander,
    look_elsewhere,
    settle,
    turn_sensor,
)
from .state import WINDOW, State

WELL_KNOWN = 0.02
"""Standard deviation of the indexes over the larger of index and warn limit that satisfies."""

_WALK = 0.01**2 / 60.0
"""Variance of a random walk of ln fn [1/s]: temperature, load and pose move it by about 1 % in a minute."""

MOST_UNFOLLOWED = 3
"""Segments in a row that are left out since the course of the inertia was not found."""

_UPDATE_ROUNDS = 3
_MOVED = 3.0  # standard deviations by which values may move before earlier segments are linearised again
_UNSETTLED = 3.0  # factor by which motion grows between looks at one speed, where solutions resemble each other
_GROWN = 1.5  # factor by which motion may grow before that is done in any case


class Estimator:
    """Updates the state of an estimation; it has none of its own.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._context = Context.of(settings)

    def change(self, settings: JointSettings) -> None:
        """Put another ``load.torque`` in force for the segments to come, and other limits."""
        self._context = replace(self._context, settings=settings)

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
        context = self._context
        state = state.aged(duration, context.settings.analysis.memory)
        if not context.settings.uncertainty.natural_frequency:
            return state
        walked = state.information.diffused(context.unknowns.frequency, _WALK * duration)
        return replace(state, information=walked)

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
        if values.size < u.size:
            return state
        if float(np.ptp(values)) == 0.0:
            return replace(state, unusable=blocker(LimitationCode.VIBRATION_CONSTANT))
        fitted = self._fit(state.with_segment(segment, setup))
        if fitted is None:
            return replace(state, unfollowed=state.unfollowed + 1, unusable=blocker(LimitationCode.INERTIA_UNFOLLOWED))
        state, fit = fitted
        state, fit, left = self._search(state, fit)
        older = state.recent[: -len(fit.segments)]
        state = replace(
            state,
            recent=(*older, *(item.segment for item in fit.segments)),
            unfollowed=0,
            values=fit.values,
            floor=left.floor,
            residual=left.residual,
            information=state.information.plus(fit.equations, fit.values),
            heard=state.heard + fit.equations.silence - fit.equations.cost,
        )
        anew = state.schedule.restarted == state.seconds
        state = replace(state, teeth=self._question_teeth(state, fit), tones=state.tones.after(fit.segments, anew=anew))
        state = replace(state, result=conclude(context, state, fit))
        return self.aged(state, sum(item.segment.duration for item in fit.segments))

    def _fit(self, state: State) -> tuple[State, Fit] | None:
        """Fit the newest segment on top of what is known; while all are kept, all of them again if values move.

        None if the course of a wandering inertia was not found.
        """
        context = self._context
        if state.floor is None:
            return look_elsewhere(context, state, None)
        newest = context.problem(state, state.recent[-1:], context.known(state))
        if state.setup.wanders:
            fit = fit_wandering(newest, state.values, state.recent[-2] if len(state.recent) > 1 else None)
            if not is_followed(fit) and state.unfollowed < MOST_UNFOLLOWED:
                return None
            state = replace(state, recent=(*state.recent[:-1], fit.segments[-1].segment))
        else:
            fit = newest.solve(state.values, rounds=_UPDATE_ROUNDS)
        change = fit.values - state.values
        grown = state.seconds >= _GROWN * state.schedule.restarted
        if state.seconds <= WINDOW and (grown or float(change @ state.information.matrix @ change) > _MOVED**2):
            # In noise a wrong solution leaves no misfit: what was given is the likeliest to be right
            starts = [fit.values, context.unknowns.zero(), *([] if state.rival is None else [state.rival])]
            state = state.restarted()
            return settle(context.problem_of_all(state), state, starts)
        return state, fit

    def _search(self, state: State, fit: Fit) -> tuple[State, Fit, Unexplained]:
        """Look for other solutions, as often as effort allows, if the fit leaves more at the lines than noise could."""
        context = self._context
        left = context.unexplained(state, fit)
        inflation = left.residual.inflation(state.coverage.span)
        state = replace(state, schedule=state.schedule.after(inflation, state.seconds))
        ambiguous = bool(context.unknowns.transmission_error) and not state.coverage.speed_varies
        unsettled = ambiguous and _UNSETTLED * state.schedule.looked <= state.seconds <= WINDOW
        # With the wrong teeth no solution is right
        hopeless = state.teeth.doubt is not None and state.schedule.looked >= SECOND_LOOK
        # Where the inertia moves, another solution for a few seconds is one of its courses
        if hopeless or state.setup.wanders or not (unsettled or state.schedule.is_due(inflation, state.seconds)):
            return state, fit, left
        state, fit = look_elsewhere(context, state, fit)
        # An arm's inertia moves from the first move on: what changes later is a change of the reducer
        for other_model in (turn_sensor, let_inertia_wander):
            if state.seconds <= WINDOW and is_poor(context, state, fit):
                state, fit = other_model(context, state, fit)
        return state, fit, context.unexplained(state, fit)

    def _question_teeth(self, state: State, fit: Fit) -> ToothWatch:
        """Ask whether other tooth numbers than those given explain the recent motion better."""
        context = self._context
        one_speed = not state.coverage.speed_varies
        trial = ToothTrial(
            problem=context.problem_of_all(state), values=fit.values, builder=context.builder, one_speed=one_speed
        )
        return state.teeth.after(fit, context.given, anew=state.schedule.restarted == state.seconds).look(
            context.settings.reducer,
            context.unknowns.harmonics,
            trial.best,
            seconds=state.seconds,
            one_speed=one_speed,
            poor=state.residual.excess(state.coverage.span) > POOR,
        )

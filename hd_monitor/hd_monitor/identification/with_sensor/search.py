"""Looks for other solutions where a fit leaves more at the lines than noise could: the cost has local minima."""

from collections.abc import Sequence
from dataclasses import replace

from ...arrays import FloatArray
from ..fit.gauss_newton import Fit, Problem
from ..fit.multistart import is_better, load_starts, multistart_newest, newest_segments, other_starts, with_lags
from ..fit.noise import NoiseFloor
from ..segment.segment import Segment
from ..segment.wander import Wander
from .context import Context
from .schedule import POOR
from .state import State

FOLLOWED = 3.0
"""Cost over its expectation up to which the course of an inertia counts as found."""

_NOTICEABLE = 0.03  # amplitude left at the lines over that explained: less is noise that comes and goes with them
_ROUNDS = 10
_EFFORT = 16.0  # s of motion that a fit of all segments may predict
_FEWEST = 4
_INERTIAS = (-0.25, 0.0, 0.25)  # ln of an inertia over the mean one, from which a course is sought
_COARSE_ROUNDS, _WANDER_ROUNDS = 3, 12
_LIKELY = 2  # courses that are refined


def rounds_for(segments: Sequence[Segment]) -> int:
    """Rounds that a fit of some segments may take: a long fit goes on at the next update instead."""
    return max(_FEWEST, min(_ROUNDS, round(_EFFORT / sum(segment.duration for segment in segments))))


def look_elsewhere(context: Context, state: State, fit: Fit | None) -> tuple[State, Fit]:
    """Try other solutions on the newest segments, beside the present fit if there is one.

    If none is better there, the fit stays as it is, and no effort goes into all recent segments.
    """
    u = context.unknowns
    state = replace(state, schedule=state.schedule.with_look(state.seconds))
    present = state.values if fit is None else fit.values
    std, problem = context.given_std(state.setup), context.problem_of_all(state)
    starts = [present, *load_starts(u)]
    for start in [u.zero(), *other_starts(u, std)]:
        starts += with_lags(problem, start, std) if state.coverage.speed_varies else [start]
    found = multistart_newest(problem, starts, rounds=_ROUNDS)
    if fit is not None and not state.coverage.speed_varies:
        # At one speed several solutions explain the motion nearly as well: those on all of it decide
        state = state.restarted()
        return settle(context.problem_of_all(state), state, [fit.values, *(other.values for _, other in found)])
    if fit is not None and not is_better(*found[0], fit.values):
        return state, fit
    return restart(context, state, found[0][0].floor, [other.values for _, other in found])


def restart(context: Context, state: State, floor: NoiseFloor, starts: Sequence[FloatArray]) -> tuple[State, Fit]:
    """Fit all segments kept from several starts, the best first, and forget what was learnt from them before.

    A few rounds with a white floor come first: lines not explained yet would pass for coloured noise.
    """
    state = state.restarted()
    problem = context.problem_of_all(state)
    fit = replace(problem, floor=floor).solve(starts[0], rounds=_FEWEST)
    return settle(replace(problem, floor=fit.floor), state, [fit.values, *starts[1:]])


def settle(problem: Problem, state: State, starts: Sequence[FloatArray]) -> tuple[State, Fit]:
    """Solve from several starts, and keep in mind a second solution that the data do not exclude."""
    fit, rival = problem.contend(starts, rounds=rounds_for(problem.segments))
    return replace(state, rival=rival), fit


def turn_sensor(context: Context, state: State, fit: Fit) -> tuple[State, Fit]:
    """Try the sensor's sign the other way round: against that of the torque it is a matter of mounting.

    To first order the opposite sign only turns the phases of all β; the coupling of the lines decides. The load's
    local minima come in either sign, so it is turned only where no load explains the motion as it is.
    """
    u = context.unknowns
    turned = replace(
        state,
        recent=tuple(segment.mirrored() for segment in state.recent),
        setup=replace(state.setup, mounting=-state.setup.mounting),
    )
    small, best = multistart_newest(context.problem_of_all(turned), load_starts(u), rounds=_ROUNDS)[0]
    if not is_better(replace(small, segments=newest_segments(state.recent)), best, fit.values):
        return state, fit
    return _replaced(context, (state, fit), restart(context, turned, small.floor, [best.values]))


def let_inertia_wander(context: Context, state: State, fit: Fit) -> tuple[State, Fit]:
    """Try an inertia that moves along the motion, as an arm's does with its pose, if lines are left to be explained."""
    if context.unexplained(state, fit).residual.unexplained < _NOTICEABLE:
        return state, fit
    wandering = replace(
        state,
        recent=tuple(segment.wandering() for segment in state.recent),
        setup=replace(state.setup, moving_since=state.seconds),
    )
    starts = [fit.values, context.unknowns.zero()]
    small, best = multistart_newest(context.problem_of_all(wandering), starts, rounds=_ROUNDS)[0]
    if not is_better(replace(small, segments=newest_segments(state.recent)), best, fit.values):
        return state, fit
    return _replaced(context, (state, fit), restart(context, wandering, small.floor, [best.values]))


def _replaced(context: Context, present: tuple[State, Fit], other: tuple[State, Fit]) -> tuple[State, Fit]:
    """Return the solution of another model if it leaves next to nothing but noise: a misfit alone proves neither."""
    return present if is_poor(context, *other) else other


def is_poor(context: Context, state: State, fit: Fit) -> bool:
    """Whether a fit leaves more at the lines than noise could, or needs a torque that contradicts the one given."""
    excess = context.unexplained(state, fit).residual.excess(state.coverage.span)
    return excess > POOR or context.contradicts_torque(state.setup, fit.values)


def fit_wandering(problem: Problem, values: FloatArray, before: Segment | None) -> Fit:
    """Fit the newest segment, whose inertia may be anything at its start and move along it.

    Parameters
    ----------
    problem : Problem
        Of that segment on top of what is known.
    values : ndarray, shape (unknowns,)
    before : Segment or None
        The one before it, which may continue into it.
    """
    (segment,) = problem.segments
    starts = list(_INERTIAS)
    if before is not None and before.wander is not None:
        starts.append(float(before.wander.values[-1]))

    def solve(wander: Wander, rounds: int) -> Fit:
        return replace(problem, segments=[replace(segment, wander=wander)]).solve(values, rounds=rounds)

    coarse = [solve(Wander.coarse(segment.duration, start), _COARSE_ROUNDS) for start in starts]
    best: Fit | None = None
    for fit in sorted(coarse, key=lambda fit: fit.cost)[:_LIKELY]:
        course = fit.segments[0].segment.wander
        assert course is not None
        fine = solve(course.fine(), _WANDER_ROUNDS)
        best = fine if best is None or fine.cost < best.cost else best
        if is_followed(best):
            break
    assert best is not None
    return best


def is_followed(fit: Fit) -> bool:
    """Whether a fit explains the motion but for noise, as it does once the course of the inertia is found."""
    return fit.equations.cost < FOLLOWED * fit.equations.freedom

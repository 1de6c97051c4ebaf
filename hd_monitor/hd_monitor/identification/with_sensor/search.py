"""Looks for other solutions where a fit leaves more at the lines than noise could: the cost has local minima."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..fit.gauss_newton import Fit, Problem
from ..fit.multistart import is_better, load_starts, multistart_newest, newest_segments, other_starts
from .context import Context
from .state import State

_TURNED = 0.3  # part of the misfit that may be left once the sensor's sign is turned
_ROUNDS, _FEW_ROUNDS = 8, 4
_YOUNG = 10.0  # s of motion before which a look for other solutions tries all starts


def look_elsewhere(context: Context, state: State, fit: Fit) -> tuple[State, Fit]:
    """Try other solutions on the newest segments.

    If later none is better there, the fit stays as it is, and no effort goes into all recent segments.
    """
    u, refine, lag = context.unknowns, context.settings.refine_dynamics, state.coverage.speed_varies
    active = state.active & ~u.mask(u.frequency, u.damping, u.delay)
    if refine:
        active = active | u.mask(u.frequency, u.damping)
    if lag:
        active = active | u.mask(u.delay)
    thorough = state.seconds < _YOUNG
    state = replace(state, schedule=state.schedule.with_look(state.seconds))
    trial = replace(state, active=active)
    starts = load_starts(u, np.where(active, fit.values, 0.0), thorough=thorough)
    starts += other_starts(u, frequency=refine, delay=lag, thorough=thorough)
    small, best = multistart_newest(context.problem_of_all(trial), starts, rounds=_ROUNDS)
    if thorough:
        return restart(context, trial, small, [best.values, starts[0]], _ROUNDS)
    if is_better(small, best, fit.values):
        return restart(context, trial, small, [best.values], _FEW_ROUNDS)
    return state, fit


def restart(
    context: Context, state: State, small: Problem, starts: Sequence[FloatArray], rounds: int
) -> tuple[State, Fit]:
    """Fit all segments kept, starting from the newest ones' result, and forget what was learnt from them before."""
    state = state.restarted()
    problem = context.problem_of_all(state)
    whole = replace(problem, floor=small.floor)
    fit = min((whole.solve(start, rounds=rounds) for start in starts), key=lambda f: f.cost)
    return state, replace(problem, floor=fit.floor).solve(fit.values, rounds=rounds)


def turn_sensor(context: Context, state: State, fit: Fit) -> tuple[State, Fit]:
    """Try the sensor's sign the other way round: against that of the torque it is a matter of mounting.

    To first order the opposite sign only turns the phases of all β; the coupling of the lines decides. The load's
    local minima come in either sign, so it is turned only where no load explains the motion as it is.
    """
    u = context.unknowns
    active = state.active & ~u.mask(u.frequency, u.damping, u.delay)
    turned = replace(
        state,
        recent=tuple(segment.mirrored() for segment in state.recent),
        active=active,
        setup=replace(state.setup, mounting=-state.setup.mounting),
    )
    start = np.where(active, fit.values, 0.0) * np.where(u.mask(u.stiffness, u.displacement), -1.0, 1.0)
    starts = load_starts(u, start, thorough=True)
    small, best = multistart_newest(context.problem_of_all(turned), starts, rounds=_ROUNDS)
    if not is_better(replace(small, segments=newest_segments(state.recent)), best, fit.values):
        return state, fit
    turned, other = restart(context, turned, small, [best.values], _ROUNDS)
    left, left_turned = (context.unexplained(*pair).residual.misfit for pair in ((state, fit), (turned, other)))
    return (state, fit) if left_turned > _TURNED * left else (turned, other)

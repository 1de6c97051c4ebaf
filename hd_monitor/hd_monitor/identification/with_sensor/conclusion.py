"""From the state of an estimation to the result that diagnosis reads."""

import math

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...model.parameters import ParametricModel, StiffnessSeries, Torque
from ..checks.something_else import SomethingElse, something_else
from ..fit.gauss_newton import Fit
from ..fit.indexes import stiffness_indexes, transmission_errors
from ..fit.information import Information
from ..fit.unknowns import Unknowns
from ..result import Identification
from .context import Context
from .limitations import limitations_of
from .line_amplitudes import measure_lines
from .state import State

SCALE_UNKNOWN = 0.3
"""Standard deviation of ln(torque / inertia) from which the stiffness indexes mean something only by their ratio."""


def conclude(context: Context, state: State, fit: Fit) -> Identification:
    """Pack the result of a state whose newest fit is given."""
    u, reducer, residual, coverage = context.unknowns, context.settings.reducer, state.residual, state.coverage
    assert state.floor is not None
    active = context.active(state.setup)
    values, unit = fit.values, state.setup.reference_torque
    evidence = state.information.divided(state.inflation)
    known = context.prior(state.setup) + evidence
    noise, systematic = _of_noise_and_given(context, state, known, evidence)
    # What the model does not explain may have gone into the lines with any sign: it does not lift their squares either
    systematic += (1.0 - 1.0 / state.inflation) * noise
    noise /= state.inflation
    turn, clocks = _turn(u, known, active), [u.delay, u.drift]
    moves = [fit.step]  # a fit that has not arrived is off by about its next step
    if state.rival is not None:
        moves.append(state.rival - values)
    for move in moves:
        still = move - turn @ move[clocks]
        systematic += np.outer(still, still)
    covariance = noise + systematic
    covariance += turn @ known.covariance(active)[np.ix_(clocks, clocks)] @ turn.T
    # At one speed and an unmeasured torque only the coupling of the lines tells the stiffness from what resembles it
    vague = bool(u.transmission_error) and not state.setup.measured and not coverage.speed_varies
    scale_std = math.inf if state.relative or vague else math.sqrt(covariance[u.torque, u.torque])
    indexes = stiffness_indexes(u, values, noise, systematic)
    errors = transmission_errors(u, values, noise, systematic)
    dynamics = u.dynamics(context.given, values)
    loads = u.phasors(values, u.load)
    strongest = int(np.argmax(np.abs(loads)))
    load_std = math.sqrt(covariance[u.load, u.load].diagonal().reshape(2, -1).sum(axis=0)[strongest] / 2.0)
    circular_spline, flexspline = u.phasors(values, u.circular_spline), u.phasors(values, u.flexspline)
    model = ParametricModel(
        reducer=reducer,
        dynamics=dynamics,
        circular_spline=StiffnessSeries.from_phasors(circular_spline),
        flexspline=StiffnessSeries.from_phasors(flexspline),
        torque=Torque(mean=0.0),
    )
    return Identification(
        circular_spline=circular_spline,
        flexspline=flexspline,
        index=indexes.index,
        index_std=indexes.std,
        index_correlation=indexes.correlation,
        transmission_error=errors.size if errors else None,
        transmission_error_std=errors.std if errors else None,
        correlation=errors.correlation if errors else None,
        relative=scale_std > SCALE_UNKNOWN,
        scale_std=scale_std,
        lines=measure_lines(state.recent, reducer, u.harmonics, state.floor),
        travel=coverage.span,
        samples=coverage.samples,
        signal_to_noise=fit.signal_to_noise,
        misfit=residual.misfit,
        natural_frequency=dynamics.natural_frequency,
        natural_frequency_std=dynamics.natural_frequency * math.sqrt(covariance[u.frequency, u.frequency]),
        damping_ratio=dynamics.damping_ratio,
        damping_ratio_std=dynamics.damping_ratio * math.sqrt(covariance[u.damping, u.damping]),
        load_fluctuation=unit * float(abs(loads[strongest])),
        load_fluctuation_std=unit * load_std,
        model=model,
        fit_status=fit.status,
        something_else=_something_else(context, state),
        limitations=(
            *([state.teeth.doubt] if state.teeth.doubt else []),
            *limitations_of(context, state, fit, covariance),
        ),
        beta_covariance=np.stack([_of_phasors(covariance, part) for part in (u.circular_spline, u.flexspline)]),
    )


def _something_else(context: Context, state: State) -> tuple[SomethingElse, ...]:
    """What is left of a state's motion by its teeth; with the wrong ones it would be their lines."""
    if state.teeth.doubt is not None:
        return ()
    return something_else(
        state.teeth.signal,
        state.teeth.residual,
        state.tones,
        context.settings.reducer,
        context.unknowns.harmonics,
        state.coverage.mean_speed,
        min(segment.highest_frequency for segment in state.recent),
        one_speed=not state.coverage.speed_varies,
    )


def _of_noise_and_given(
    context: Context, state: State, known: Information, evidence: Information
) -> tuple[FloatArray, FloatArray]:
    """Covariance of the unknowns by noise in the lines, and by what was given: the prior, and scalars but the clocks'.

    A wrong torque moves all phasors of a spline together, and what the data leave to the prior stays where that has
    it: neither lifts the sum of their squares, as noise does.
    """
    u, active = context.unknowns, context.active(state.setup)
    every = known.covariance(active)
    phasors = active & u.mask(u.stiffness, u.load, u.displacement)
    scalars = active & ~phasors
    moving = scalars & ~u.mask(u.delay, u.drift)
    noise = known.covariance(phasors, evidence)
    noise[np.ix_(scalars, scalars)] = every[np.ix_(scalars, scalars)]
    response = _response(known, phasors, moving)
    given = known.covariance(phasors, context.prior(state.setup))
    given[np.ix_(phasors, phasors)] += response @ every[np.ix_(moving, moving)] @ response.T
    return noise, given


def _turn(u: Unknowns, known: Information, active: BoolArray) -> FloatArray:
    """How the phasors follow the clocks' lag and its drift, shape (unknowns, 2); 0 for all others.

    They turn, by any angle where the speed does not vary and so does not tell the lag: it leaves their size as it is.
    """
    phasors, clocks = active & u.mask(u.stiffness, u.load, u.displacement), u.mask(u.delay, u.drift)
    turn = np.zeros((u.size, 2))
    turn[phasors] = _response(known, phasors, clocks)
    return turn


def _response(information: Information, of: BoolArray, to: BoolArray) -> FloatArray:
    """Derivatives of the best values of some unknowns by others, shape (of, to)."""
    inverse = np.linalg.pinv(information.matrix[np.ix_(of, of)], rcond=1e-14, hermitian=True)
    return np.asarray(-inverse @ information.matrix[np.ix_(of, to)])


def _of_phasors(covariance: FloatArray, part: slice) -> FloatArray:
    """Covariance of real and imaginary part of each phasor of a part, shape (phasors, 2, 2)."""
    own = covariance[part, part]
    size = own.shape[0] // 2
    return np.asarray(np.einsum("akbk->kab", own.reshape(2, size, 2, size)))

"""From the state of an estimation to the result that diagnosis reads."""

import math

import numpy as np

from ...arrays import FloatArray
from ...model.parameters import ParametricModel, StiffnessSeries, Torque
from ..checks.residual import LineResidual
from ..checks.something_else import SomethingElse, something_else
from ..fit.gauss_newton import Fit
from ..fit.indexes import stiffness_indexes, transmission_errors
from ..fit.unknowns import Unknowns
from ..result import Identification
from .context import Context
from .limitations import limitations_of
from .line_amplitudes import measure_lines
from .state import State

UNSEEN = 3.0
"""Amplitude wrongly taken for defects, over that left at the lines: the unknowns follow what they can of anything."""


def conclude(context: Context, state: State, fit: Fit) -> Identification:
    """Pack the result of a state whose newest fit is given."""
    u, reducer, residual, coverage = context.unknowns, context.settings.reducer, state.residual, state.coverage
    assert state.floor is not None
    values, information, unit = fit.values, context.known(state), state.setup.reference_torque
    noise = state.inflation * information.covariance(state.active, state.information)
    systematic = _systematic(u, values, residual, coverage.span)
    systematic += information.covariance(state.active, context.prior)  # what the data leave to the prior
    covariance = noise + systematic
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
        relative=state.relative,
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
        model=None if state.relative else model,
        fit_status=fit.status,
        something_else=_something_else(context, state),
        limitations=(
            *([state.teeth.doubt] if state.teeth.doubt else []),
            *limitations_of(context, state, fit, indexes),
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


def _systematic(u: Unknowns, values: FloatArray, residual: LineResidual, span: float) -> FloatArray:
    """Covariance of errors that more data of the same kind would not average out, shape (unknowns, unknowns)."""
    covariance = np.zeros((u.size, u.size))
    if residual.inflation(span) > 1.0:
        size = UNSEEN * residual.unexplained * float(np.linalg.norm(values[u.stiffness]))
        for part in (u.circular_spline, u.flexspline):
            direction = values[part] / max(float(np.linalg.norm(values[part])), 1e-12)
            covariance[part, part] += size**2 * np.outer(direction, direction)
    return covariance


def _of_phasors(covariance: FloatArray, part: slice) -> FloatArray:
    """Covariance of real and imaginary part of each phasor of a part, shape (phasors, 2, 2)."""
    own = covariance[part, part]
    size = own.shape[0] // 2
    return np.asarray(np.einsum("akbk->kab", own.reshape(2, size, 2, size)))

"""From the state of an estimation to the result that diagnosis reads."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...model.parameters import Dynamics, ParametricModel, StiffnessSeries, Torque
from ...orders.line_amplitudes import measure_lines
from ...settings import JointSettings
from ..checks.coverage import Coverage
from ..checks.limitations import FitSummary, limitations_of
from ..checks.residual import LineResidual
from ..fit.information import Information
from ..fit.linearisation import Predictor
from ..fit.noise import NoiseFloor
from ..fit.normal_equations import LinearisedSegment
from ..fit.score_test import ScoreTest
from ..fit.unknowns import Unknowns
from ..result import Identification
from ..segment.segment import Segment
from .indexes import stiffness_indexes

WELL_KNOWN = 0.02
"""Standard deviation of the indexes over the larger of index and warn limit that satisfies."""

UNSEEN = 3.0
"""Amplitude wrongly taken for defects, over that left at the lines: the unknowns follow what they can of anything."""


class Conclusions:
    """Draws conclusions from the state of an estimation.

    Parameters
    ----------
    settings : JointSettings
    unknowns : Unknowns
    """

    def __init__(self, settings: JointSettings, unknowns: Unknowns) -> None:
        self._settings = settings
        self._unknowns = unknowns
        self._warn = settings.diagnosis.warn_index

    def sureness(self, result: Identification) -> float:
        """Standard deviation of the indexes that satisfies, over what they have; 0 where no part may be named."""
        if result.blockers:
            return 0.0
        return WELL_KNOWN * max(self._warn, *result.index) / max(*result.index_std, 1e-12)

    def conclude(
        self,
        *,
        predictor: Predictor,
        values: FloatArray,
        active: BoolArray,
        information: Information,
        score_tests: Mapping[int, ScoreTest],
        misfit: LineResidual,
        coverage: Coverage,
        recent: Sequence[Segment],
        evidence: Sequence[LinearisedSegment],
        floor: NoiseFloor,
        relative: bool,
    ) -> Identification:
        """Pack the result."""
        u = self._unknowns
        inflation = max(misfit.inflation(coverage.span), misfit.overdispersion.inflation)
        noise = inflation * information.covariance(active)
        systematic = self._systematic(values, misfit, coverage)
        covariance = noise + systematic
        indexes = stiffness_indexes(u, values, noise, systematic)
        dynamics = u.dynamics(predictor.given, values)
        loads = u.phasors(values, u.load)
        reference = predictor.reference_torque
        strongest = int(np.argmax(np.abs(loads)))
        load_std = math.sqrt(covariance[u.load, u.load].diagonal().reshape(2, -1).sum(axis=0)[strongest] / 2.0)
        snr = _signal_to_noise(evidence)
        limitations = limitations_of(
            FitSummary(
                predictor=predictor,
                values=values,
                active=active,
                indexes=indexes,
                score_tests=score_tests,
                inflation=inflation,
                unexplained=misfit.unexplained,
                highest_frequency=recent[-1].raw_highest,
                coverage=coverage,
                signal_to_noise=snr,
                relative=relative,
            ),
            self._settings.reducer,
            self._warn,
        )
        return Identification(
            circular_spline=u.phasors(values, u.circular_spline),
            flexspline=u.phasors(values, u.flexspline),
            index=indexes.index,
            index_std=indexes.std,
            index_correlation=indexes.correlation,
            relative=relative,
            lines=measure_lines(recent, self._settings.reducer, u.harmonics, floor),
            travel=coverage.span,
            samples=coverage.samples,
            signal_to_noise=snr,
            misfit=misfit.misfit,
            natural_frequency=dynamics.natural_frequency,
            natural_frequency_std=dynamics.natural_frequency * math.sqrt(covariance[u.frequency, u.frequency]),
            damping_ratio=dynamics.damping_ratio,
            damping_ratio_std=dynamics.damping_ratio * math.sqrt(covariance[u.damping, u.damping]),
            load_fluctuation=reference * float(abs(loads[strongest])),
            load_fluctuation_std=reference * load_std,
            model=None if relative else self._model(dynamics, values),
            limitations=limitations,
            beta_covariance=np.stack([_of_phasors(covariance, part) for part in (u.circular_spline, u.flexspline)]),
        )

    def _systematic(self, values: FloatArray, misfit: LineResidual, coverage: Coverage) -> FloatArray:
        """Covariance of errors that more data of the same kind would not average out, shape (unknowns, unknowns)."""
        u = self._unknowns
        covariance = np.zeros((u.size, u.size))
        if misfit.inflation(coverage.span) > 1.0:
            size = UNSEEN * misfit.unexplained * float(np.linalg.norm(values[u.stiffness]))
            for part in (u.circular_spline, u.flexspline):
                direction = values[part] / max(float(np.linalg.norm(values[part])), 1e-12)
                covariance[part, part] += size**2 * np.outer(direction, direction)
        return covariance

    def _model(self, dynamics: Dynamics, values: FloatArray) -> ParametricModel:
        """Return the reducer as identified, without its load."""
        u = self._unknowns
        return ParametricModel(
            reducer=self._settings.reducer,
            dynamics=dynamics,
            circular_spline=StiffnessSeries.from_phasors(u.phasors(values, u.circular_spline)),
            flexspline=StiffnessSeries.from_phasors(u.phasors(values, u.flexspline)),
            torque=Torque(mean=0.0),
        )


def _of_phasors(covariance: FloatArray, part: slice) -> FloatArray:
    """Covariance of real and imaginary part of each phasor of a part, shape (phasors, 2, 2)."""
    own = covariance[part, part]
    size = own.shape[0] // 2
    k = np.arange(size)
    places = np.stack([k, k + size], axis=1)
    return np.asarray(own[places[:, :, None], places[:, None, :]])


def _signal_to_noise(evidence: Sequence[LinearisedSegment]) -> float:
    """Power of the predicted vibration over that of the residual [dB], in the band that was fitted."""
    explained = sum(float(np.sum(e.segment.transform(e.linearisation.predicted[:, None]) ** 2)) for e in evidence)
    residual = sum(float(np.sum(e.residual**2)) for e in evidence)
    return 10.0 * math.log10(max(explained, 1e-300) / max(residual, 1e-300))

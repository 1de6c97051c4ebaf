"""What an estimation is given and never changes: settings, unknowns, prior; and the segments and fits made with it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import BoolArray, FloatArray
from ...model.parameters import Dynamics
from ...settings import JointSettings
from ..checks.residual import LineResidual
from ..fit.gauss_newton import Fit, Problem
from ..fit.information import Information
from ..fit.linearisation import Predictor
from ..fit.multistart import signal_level
from ..fit.noise import NoiseFloor
from ..fit.unknowns import ASSUMED_LOAD, MEASURED_LOAD, RELATIVE, TORQUE_LINES, Unknowns
from ..segment.segment import Segment, SegmentBuilder
from .state import Setup, State

NOMINAL_INDEX = 0.05
"""Of the larger spline, where an unknown torque leaves the scale open."""

INCREDIBLE = 4.0
"""Standard deviations, as given, by which torque and inertia may be wrong: beyond them something else is."""

_TRIAL_WIND_UP = 1e-3  # rad


class Unexplained(NamedTuple):
    """What fits leave: the noise floor, and what exceeds it at the lines."""

    floor: NoiseFloor
    residual: LineResidual


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Context:
    """The constant part of an estimation.

    Attributes
    ----------
    settings : JointSettings
    unknowns : Unknowns
    builder : SegmentBuilder
    """

    settings: JointSettings
    unknowns: Unknowns
    builder: SegmentBuilder

    @classmethod
    def of(cls, settings: JointSettings) -> "Context":
        """Return the context that a joint's settings make."""
        unknowns = Unknowns(
            harmonics=settings.analysis.harmonics,
            load_orders=tuple(TORQUE_LINES),
            transmission_error=settings.transmission_error,
            uncertainty=settings.uncertainty,
        )
        builder = SegmentBuilder(
            reducer=settings.reducer,
            harmonics=unknowns.harmonics,
            load_orders=unknowns.load_orders,
            natural_frequency=settings.dynamics.natural_frequency,
            inertial=settings.vibration.gravity,
            bandwidth=settings.input.bandwidth,
        )
        return cls(settings=settings, unknowns=unknowns, builder=builder)

    @property
    def given(self) -> Dynamics:
        """The oscillator as the parameters have it."""
        return self.settings.dynamics

    @property
    def given_torque(self) -> float:
        """Torque [N·m] where none is measured, as the parameters have it; 0 if they have none."""
        load = self.settings.load
        return load.torque if load.source in ("auto", "parameter") else 0.0

    def segment(self, records: Sequence[Record], setup: Setup) -> tuple[Segment, Setup]:
        """Make a segment of records that follow each other; a nominal torque replaces an unknown one.

        Raises
        ------
        ParameterError
            If the sampling rate is far too low for the lines and the natural frequency.
        """
        torque = None
        if not np.isfinite(records[0].torque).all():
            setup = replace(setup, measured=False)
            torque = self.given_torque or setup.nominal_torque
            if torque is None:
                torque = self._find_nominal(records)
                setup = replace(setup, nominal_torque=torque)
        if setup.origin is None:
            setup = replace(setup, origin=records[0].start)
        segment = self.builder.build(records, torque, origin=setup.origin or 0.0)
        if not setup.reference_torque:
            level = float(np.sqrt(np.mean(segment.at_steps.torque**2)))
            kept_from_zero = max(level, 0.1 * abs(self.given_torque), 1e-9 * self.given.stiffness)
            setup = replace(setup, reference_torque=kept_from_zero)
        levels, (least, most) = np.abs(segment.at_steps.torque), setup.torques
        setup = replace(setup, torques=(min(least, float(levels.min())), max(most, float(levels.max()))))
        if setup.wanders:
            segment = segment.wandering()
        return (segment if setup.mounting > 0.0 else segment.mirrored()), setup

    def predictor(self, setup: Setup) -> Predictor:
        """Predictor in the unit of load fluctuations that a setup has found."""
        return Predictor(unknowns=self.unknowns, given=self.given, reference_torque=setup.reference_torque)

    def given_std(self, setup: Setup) -> FloatArray:
        """Standard deviations of the unknowns before any data, shape (unknowns,)."""
        sure = self.settings.uncertainty
        if setup.nominal_torque is not None:
            std = self.unknowns.given_std(RELATIVE, ASSUMED_LOAD)
        elif setup.measured:
            std = self.unknowns.given_std(sure.measured_torque, MEASURED_LOAD)
        else:
            std = self.unknowns.given_std(sure.assumed_torque, ASSUMED_LOAD)
        if not setup.torque_varies:
            std[self.unknowns.hardening] = 0.0
        return std

    def contradicts_torque(self, setup: Setup, values: FloatArray) -> bool:
        """Whether some values of the unknowns need a torque that is not credible beside the one given or measured."""
        place = self.unknowns.torque
        known = setup.nominal_torque is None
        return known and abs(float(values[place])) > INCREDIBLE * float(self.given_std(setup)[place])

    def prior(self, setup: Setup) -> Information:
        """What is known of the unknowns before any data."""
        return Information.gaussian(self.given_std(setup))

    def active(self, setup: Setup) -> BoolArray:
        """Unknowns that are fitted: all but what was given as exact, shape (unknowns,)."""
        return np.asarray(self.given_std(setup) > 0.0)

    def known(self, state: State) -> Information:
        """Return all that is known of the unknowns: what was given, and what a state has learnt."""
        return self.prior(state.setup) + state.information

    def problem(self, state: State, segments: Sequence[Segment], prior: Information) -> Problem:
        """Return the problem of explaining some segments with what a state allows."""
        return Problem(
            segments=segments,
            predictor=self.predictor(state.setup),
            prior=prior,
            floor=signal_level(segments) if state.floor is None else state.floor,
            active=self.active(state.setup),
        )

    def problem_of_all(self, state: State) -> Problem:
        """Return the problem of explaining all segments kept."""
        return self.problem(state, state.recent, self.prior(state.setup))

    def unexplained(self, state: State, fit: Fit) -> Unexplained:
        """What is not explained by a fit and those before it."""
        if state.floor is None or state.schedule.restarted == state.seconds:
            floor, residual = fit.floor, LineResidual.empty(self.unknowns.harmonics)
        else:
            floor, residual = state.floor + fit.floor, state.residual
        for item in fit.segments:
            residual = residual.plus(item, fit.covariance, floor, self.settings.reducer)
        return Unexplained(floor, residual)

    def _find_nominal(self, records: Sequence[Record]) -> float:
        """Torque [N·m] at which the lines would indicate a defect of typical size."""
        unit = self.given.stiffness * _TRIAL_WIND_UP
        u, segment = self.unknowns, self.builder.build(records, unit)
        problem = Problem(
            segments=[segment],
            predictor=self.predictor(Setup(reference_torque=unit)),
            prior=self.prior(Setup()),
            floor=signal_level([segment]),
            active=u.mask(u.stiffness),
        )
        step = problem.at(u.zero()).step
        size = max(float(np.linalg.norm(step[part])) for part in (u.circular_spline, u.flexspline))
        return unit * max(size, 1e-6) / NOMINAL_INDEX

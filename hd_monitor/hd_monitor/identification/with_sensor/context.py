"""What an estimation is given and never changes: settings, unknowns, prior; and the fits that follow from a state."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...model.parameters import Dynamics
from ...settings import JointSettings
from ..checks.residual import LineResidual
from ..fit.gauss_newton import Fit, Problem
from ..fit.information import Information
from ..fit.linearisation import Predictor
from ..fit.multistart import signal_level
from ..fit.noise import NoiseFloor
from ..fit.unknowns import TORQUE_LINES, Unknowns
from ..segment.preparation import Preparation
from ..segment.segment import Segment
from .state import State


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
    prior : Information
        What is known of the unknowns before any data.
    preparation : Preparation
    """

    settings: JointSettings
    unknowns: Unknowns
    prior: Information
    preparation: Preparation

    @classmethod
    def of(cls, settings: JointSettings) -> "Context":
        """Return the context that a joint's settings make."""
        unknowns = Unknowns(harmonics=settings.analysis.harmonics, load_orders=tuple(TORQUE_LINES))
        prior = Information.gaussian(unknowns.given_std())
        return cls(
            settings=settings,
            unknowns=unknowns,
            prior=prior,
            preparation=Preparation(settings, unknowns, prior),
        )

    @property
    def given(self) -> Dynamics:
        """The oscillator as the parameters have it."""
        return self.settings.dynamics

    def predictor(self, state: State) -> Predictor:
        """Predictor in the units of a state."""
        return Predictor(unknowns=self.unknowns, given=self.given, reference_torque=state.setup.reference_torque)

    def problem(self, state: State, segments: Sequence[Segment], prior: Information) -> Problem:
        """Return the problem of explaining some segments with what a state allows."""
        return Problem(
            segments=segments,
            predictor=self.predictor(state),
            prior=prior,
            floor=signal_level(segments) if state.floor is None else state.floor,
            active=state.active,
        )

    def problem_of_all(self, state: State) -> Problem:
        """Return the problem of explaining all segments kept."""
        return self.problem(state, state.recent, self.prior)

    def unexplained(self, state: State, fit: Fit) -> Unexplained:
        """What is not explained by a fit and those before it."""
        if state.floor is None or state.schedule.restarted == state.seconds:
            floor, residual = fit.floor, LineResidual.empty(self.unknowns.harmonics)
        else:
            floor, residual = state.floor + fit.floor, state.residual
        for item in fit.segments:
            residual = residual.plus(item, fit.covariance, floor, self.settings.reducer)
        return Unexplained(floor, residual)

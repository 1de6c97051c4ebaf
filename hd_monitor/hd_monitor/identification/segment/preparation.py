"""From records to segments: with the torque, known or nominal, and the sensor's sign as found so far."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...acquisition.record import Record
from ...settings import JointSettings
from ..fit.gauss_newton import Problem
from ..fit.information import Information
from ..fit.linearisation import Predictor
from ..fit.multistart import signal_level
from ..fit.unknowns import Unknowns
from .segment import Segment, SegmentBuilder

NOMINAL_INDEX = 0.05
"""Of the larger spline, where an unknown torque leaves the scale open."""

_TRIAL_WIND_UP = 1e-3  # rad


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """What the data have said of torque and sensor.

    Attributes
    ----------
    nominal_torque : float or None
        Torque [N·m] used in place of an unknown one; None as long as the torque is known.
    reference_torque : float
        Torque [N·m] in whose unit load fluctuations are expressed; 0 before the first segment.
    mounting : float
        1, or -1 for a sensor whose sign is against that of the torque.
    """

    nominal_torque: float | None = None
    reference_torque: float = 0.0
    mounting: float = 1.0


class Preparation:
    """Makes segments of one joint's records.

    Parameters
    ----------
    settings : JointSettings
    unknowns : Unknowns
    prior : Information
        What is known of them before any data.
    """

    def __init__(self, settings: JointSettings, unknowns: Unknowns, prior: Information) -> None:
        self._given = settings.dynamics
        self._torque = settings.load.torque if settings.load.source in ("auto", "parameter") else 0.0
        self._unknowns = unknowns
        self._prior = prior
        self._builder = SegmentBuilder(
            reducer=settings.reducer,
            harmonics=unknowns.harmonics,
            load_orders=unknowns.load_orders,
            natural_frequency=self._given.natural_frequency,
            inertial=settings.vibration.gravity,
        )

    @property
    def inertial(self) -> bool:
        """Whether the sensor also feels gravity."""
        return self._builder.inertial

    def build(self, records: Sequence[Record], setup: Setup) -> tuple[Segment, Setup]:
        """Make a segment of records that follow each other; a nominal torque replaces an unknown one.

        Raises
        ------
        ParameterError
            If the sampling rate is far too low for the lines and the natural frequency.
        """
        torque = None
        if not np.isfinite(records[0].torque).all():
            torque = self._torque or setup.nominal_torque
            if torque is None:
                torque = self._find_nominal(records)
                setup = replace(setup, nominal_torque=torque)
        segment = self._builder.build(records, torque)
        if not setup.reference_torque:
            setup = replace(setup, reference_torque=self._reference_torque(segment))
        return (segment if setup.mounting > 0.0 else segment.mirrored()), setup

    def _reference_torque(self, segment: Segment) -> float:
        """Root mean square [N·m] of the known torque, kept from zero."""
        level = float(np.sqrt(np.mean(segment.at_steps.torque**2)))
        return max(level, 0.1 * abs(self._torque), 1e-9 * self._given.stiffness)

    def _find_nominal(self, records: Sequence[Record]) -> float:
        """Torque [N·m] at which the lines would indicate a defect of typical size."""
        unit = self._given.stiffness * _TRIAL_WIND_UP
        u, segment = self._unknowns, self._builder.build(records, unit)
        problem = Problem(
            segments=[segment],
            predictor=Predictor(unknowns=u, given=self._given, reference_torque=unit),
            prior=self._prior,
            floor=signal_level([segment]),
            active=u.mask(u.stiffness),
        )
        step = problem.at(u.zero()).step
        size = max(float(np.linalg.norm(step[part])) for part in (u.circular_spline, u.flexspline))
        return unit * max(size, 1e-6) / NOMINAL_INDEX

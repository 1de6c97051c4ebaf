"""From records to segments: with the torque that is known or stands for it, and the sensor's sign as found so far."""

from collections.abc import Sequence

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


class Preparation:
    """Makes segments of one joint's records.

    Parameters
    ----------
    settings : JointSettings
    unknowns : Unknowns
    prior : Information
        What is known of them before any data.

    Attributes
    ----------
    nominal_torque : float or None
        Torque [N·m] that stands for one that nobody knows; None as long as the torque is known.
    mounting : float
        1, or -1 for a sensor whose sign is against that of the torque.
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
        self.nominal_torque: float | None = None
        self.mounting = 1.0

    @property
    def inertial(self) -> bool:
        """Whether the sensor also feels gravity."""
        return self._builder.inertial

    def build(self, records: Sequence[Record]) -> Segment:
        """Make a segment of records that follow each other; where nobody knows the torque, a nominal one stands for it.

        Raises
        ------
        ParameterError
            If the sampling rate is far too low for the lines and the natural frequency.
        """
        segment = self._builder.build(records, self._known_torque(records))
        return segment if self.mounting > 0.0 else segment.mirrored()

    def reference_torque(self, segments: Sequence[Segment]) -> float:
        """Torque [N·m] in whose unit load fluctuations are expressed: the root mean square of the known one."""
        torque = np.concatenate([s.at_steps.torque for s in segments])
        return max(float(np.sqrt(np.mean(torque**2))), 0.1 * abs(self._torque), 1e-9 * self._given.stiffness)

    def _known_torque(self, records: Sequence[Record]) -> float | None:
        """Torque [N·m] to be used instead of the records'; None where they have it."""
        if np.isfinite(records[0].torque).all():
            return None
        if self._torque:
            return self._torque
        if self.nominal_torque is None:
            self.nominal_torque = self._find_nominal(records)
        return self.nominal_torque

    def _find_nominal(self, records: Sequence[Record]) -> float:
        """Torque [N·m] at which the lines would speak of a defect of common size."""
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

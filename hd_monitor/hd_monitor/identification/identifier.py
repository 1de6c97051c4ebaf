"""Identification of the stiffness indexes from the vibration and the motion it belongs to."""

import math

import numpy as np

from ..acquisition.record import Record
from ..settings import JointSettings
from .result import Identification
from .segment.assembly import SegmentAssembler
from .with_sensor.estimator import Estimator

CRUISE_SEGMENT, SHORTEST_SEGMENT = 2.0, 1.0
"""Length [s] of the segments looked at once the indexes are known well enough, and once they are known far better."""

CRUISE_PERIOD, LONGEST_PERIOD = 32.0, 64.0
"""Time [s] from one such segment to the next where the indexes are known just well enough, and where far better."""

LONGEST_SEGMENT = 4.0
"""Length [s] to which segments grow while evidence is collected."""


class Identifier:
    """Identifies one joint's reducer from accelerations, a record at a time.

    Parameters
    ----------
    settings : JointSettings
    sparing : bool
        Whether to look at a part of the motion only, once the indexes are known well enough for a verdict.

    Notes
    -----
    Prediction-error method in the time domain: the parametric model (eqs. 2-4 of Gu et al. 2021) is simulated along
    the measured motion, and the phasors of both splines' β and transmission errors, those of unknown load
    fluctuations, and all that is given (natural frequency, damping, torque, the lag between the clocks) are fitted to
    the measured acceleration by Gauss-Newton steps, weighted by the noise floor that the fit leaves. It holds for any
    motion (dwell, run-up, strokes), since stiffness and load are functions of the absolute angle, and for Gaussian
    noise it is the maximum of the posterior. What is computed, and when, depends on the data alone.

    Examples
    --------
    >>> identifier = Identifier(JointSettings.from_mapping())
    >>> identifier.estimate() is None
    True
    """

    def __init__(self, settings: JointSettings, *, sparing: bool = True) -> None:
        self._minimum_speed = settings.analysis.minimum_speed * math.tau / 60.0 / settings.reducer.reduction
        self._assembler = SegmentAssembler(self._minimum_speed)
        self._estimator = Estimator(settings)
        self._state = self._estimator.initial()
        self._sparing = sparing
        self._skip = 0.0
        self._passed = 0.0

    def change(self, settings: JointSettings) -> None:
        """Put other settings in force that leave the evidence valid: ``load.torque`` and the limits."""
        self._estimator.change(settings)

    def add(self, record: Record) -> None:
        """Take the next record."""
        if self._skip > 0.0:
            # The indexes are known well: what lies between the segments looked at makes the evidence older, no more
            if float(np.abs(record.speed).max(initial=0.0)) >= self._minimum_speed:
                self._skip -= len(record) * record.period
                self._passed += len(record) * record.period
            return
        if self._passed:
            self._state = self._estimator.aged(self._state, self._passed)
            self._passed = 0.0
        for records in self._assembler.add(record, self._segment_length):
            self._state = self._estimator.update(self._state, records)
            if self._is_cruising:
                period = min(CRUISE_PERIOD * self._sureness, LONGEST_PERIOD)
                self._skip = period - self._segment_length

    def estimate(self) -> Identification | None:
        """Return the newest estimate; None as long as there was not enough motion."""
        result, unusable = self._state.result, self._state.unusable
        if unusable is None:
            return result
        if result is None:
            return Identification.none((unusable,), relative=False)
        return result.limited(unusable)

    def finish(self) -> Identification | None:
        """Use what is still waiting to become a longer segment, and return the estimate on everything."""
        for records in self._assembler.flush():
            self._state = self._estimator.update(self._state, records)
        return self.estimate()

    @property
    def _sureness(self) -> float:
        return self._estimator.sureness(self._state)

    @property
    def _is_cruising(self) -> bool:
        return self._sparing and self._sureness >= 1.0

    @property
    def _segment_length(self) -> float:
        if self._is_cruising:  # once the period grows no further, the segments get shorter
            surplus = CRUISE_PERIOD * self._sureness / LONGEST_PERIOD
            return min(CRUISE_SEGMENT, max(SHORTEST_SEGMENT, CRUISE_SEGMENT / surplus))
        return min(LONGEST_SEGMENT, max(1.0, 0.25 * self._state.seconds))

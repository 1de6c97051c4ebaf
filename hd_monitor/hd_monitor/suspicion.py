"""Looks for the cause in the inputs where the model does not explain them, so that no innocent parameter is blamed."""

from collections import deque
from collections.abc import Sequence

import numpy as np

from .acquisition.flaws import effort_flaw, motion_flaw, vibration_flaw
from .acquisition.record import JointSamples, Record
from .acquisition.recorder import AssembledPeriod
from .identification.checks.following import LineShares, line_shares
from .identification.checks.stamps import compare_stamps
from .identification.result import Identification
from .limitation import Limitation, LimitationCode, blocker, doubt
from .settings import JointSettings

RECENT = 16.0
"""Time [s] that is looked at."""

_FELL = 0.25  # of the level before: a quieter vibration is asked whether it still holds lines
_HEARD = 0.5  # part of the power: where lines explain most of it the sensor hears the joint
_DOUBTFUL = 0.0  # dB of signal to noise: the model explains less than half of the power
_NEAR, _FOLLOWS = 0.03, 0.2  # part of the power near the lines, and that of it that follows the angle
_AS_FAST = 0.8  # of the speed before


class Suspicion:
    """What of one joint's inputs looks wrong.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._settings = settings
        self._recent: deque[Record] = deque()
        self._period: AssembledPeriod | None = None
        self._silent = False
        self._asked: tuple[Identification, Identification] | None = None

    def add(self, period: AssembledPeriod) -> None:
        """Take in another period."""
        self._period = period
        self._recent.extend(period.records)
        while self._recent and self._recent[-1].start - self._recent[0].start > RECENT:
            self._recent.popleft()
        self._asked = None
        if period.records:
            self._silent = self._is_silent(period.records)

    def qualified(self, found: Identification) -> Identification:
        """Return a result with the cause in place of its consequences, if one shows."""
        if self._asked is None or self._asked[0] is not found:
            self._asked = found, self._qualified(found)
        return self._asked[1]

    def _qualified(self, found: Identification) -> Identification:
        period = self._period
        if period is None or not found.samples:  # what keeps all samples from being used is the cause itself
            return found
        flaw = doubt(LimitationCode.SENSOR_SILENT) if self._silent else vibration_flaw(period.vibration)
        cause = None
        if found.blockers or found.is_hidden_by_misfit(self._settings.diagnosis.warn_index):
            cause = flaw or self._cause(period.joint_samples, found.blockers)
        elif found.signal_to_noise < _DOUBTFUL:
            cause = self._foreign()
        if cause is not None:
            return found.explained(cause)
        return found if flaw is None else found.limited(flaw)

    def _cause(self, samples: JointSamples, blockers: Sequence[Limitation]) -> Limitation | None:
        """Return what explains some limitations, by the last period's joint states or the stamps."""
        reducer = self._settings.reducer
        return (
            motion_flaw(samples, max(reducer.output_orders))
            or compare_stamps(self._recent, reducer, self._settings.dynamics, self._settings.analysis.harmonics)
            or self._foreign()
            or (effort_flaw(samples) if any(map(_questions_torque, blockers)) else None)
        )

    def _foreign(self) -> Limitation | None:
        """Return that what is near the lines does not follow the joint's angle, if so."""
        by_window, throughout = self._shares(self._recent)
        if by_window < _NEAR or throughout > _FOLLOWS * by_window:
            return None
        return blocker(LimitationCode.VIBRATION_FOREIGN)

    def _is_silent(self, newest: Sequence[Record]) -> bool:
        """Whether the newest records hold no lines although the joint moves as it did when it was heard."""
        earlier = list(self._recent)[: -len(newest)]
        if not self._silent:
            if not earlier or _typical(newest, "acceleration") > _FELL * _typical(earlier, "acceleration"):
                return False
            if _typical(newest, "speed") < _AS_FAST * _typical(earlier, "speed"):
                return False
            if self._shares(earlier).by_window < _HEARD:
                return False
        return self._shares(newest).by_window < _HEARD

    def _shares(self, records: Sequence[Record]) -> LineShares:
        settings = self._settings
        return line_shares(records, settings.reducer, settings.dynamics, settings.analysis.harmonics)


def _questions_torque(limitation: Limitation) -> bool:
    on_bound = limitation.code is LimitationCode.VALUE_ON_BOUND and "torque" in str(limitation.values["names"])
    return on_bound or limitation.code is LimitationCode.TORQUE_CONTRADICTED


def _typical(records: Sequence[Record], name: str) -> float:
    """Root mean square of a signal, NaN counted as 0, in the middle one of some records."""
    return float(np.median([np.sqrt(np.mean(np.nan_to_num(getattr(record, name)) ** 2)) for record in records]))

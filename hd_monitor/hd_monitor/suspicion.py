"""Looks for the cause in the inputs where the model does not explain them, so that no innocent parameter is blamed."""

from collections import deque
from collections.abc import Sequence, Set

import numpy as np

from .acquisition.flaws import effort_flaw, motion_flaw, vibration_flaw
from .acquisition.record import JointSamples, Record
from .acquisition.recorder import AssembledPeriod
from .identification.checks.stamps import compare_stamps, explained_share
from .identification.result import Identification
from .limitation import Limitation, LimitationCode, doubt
from .settings import JointSettings

RECENT = 16.0
"""Time [s] that is looked at."""

_TORQUE = {LimitationCode.TORQUE_TOO_SMALL, LimitationCode.TORQUE_TOO_LARGE}
_FELL = 0.25  # of the level before: a quieter vibration is asked whether it still holds lines
_HEARD, _UNHEARD = 0.5, 0.15  # part of the power that lines explain where a sensor hears the joint, and where not
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
        if (period := self._period) is None:
            return found
        flaw = doubt(LimitationCode.SENSOR_SILENT) if self._silent else vibration_flaw(period.vibration)
        if not found.blockers:
            return found if flaw is None else found.limited(flaw)
        cause = flaw or self._cause(period.joint_samples, {limitation.code for limitation in found.blockers})
        return found if cause is None else found.explained(cause)

    def _cause(self, samples: JointSamples, codes: Set[LimitationCode]) -> Limitation | None:
        """Return what explains the limitations with these codes, by the last period's joint states or the stamps."""
        reducer = self._settings.reducer
        return (
            motion_flaw(samples, max(reducer.output_orders))
            or compare_stamps(self._recent, reducer, self._settings.dynamics, self._settings.analysis.harmonics)
            or (effort_flaw(samples) if codes & _TORQUE else None)
        )

    def _is_silent(self, newest: Sequence[Record]) -> bool:
        """Whether the newest records hold no lines although the joint moves as it did when it was heard."""
        earlier = list(self._recent)[: -len(newest)]
        if not self._silent:
            if not earlier or _typical(newest, "acceleration") > _FELL * _typical(earlier, "acceleration"):
                return False
            if _typical(newest, "speed") < _AS_FAST * _typical(earlier, "speed") or self._heard(earlier) < _HEARD:
                return False
        return self._heard(newest) < _UNHEARD

    def _heard(self, records: Sequence[Record]) -> float:
        return explained_share(
            records, self._settings.reducer, self._settings.dynamics, self._settings.analysis.harmonics
        )


def _typical(records: Sequence[Record], name: str) -> float:
    """Root mean square of a signal, NaN counted as 0, in the middle one of some records."""
    return float(np.median([np.sqrt(np.mean(np.nan_to_num(getattr(record, name)) ** 2)) for record in records]))

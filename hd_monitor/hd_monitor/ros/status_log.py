"""What the log says of statuses: level and code at once, another kind of reason now and then."""

from collections.abc import Sequence
from typing import NamedTuple

from rclpy.impl.rcutils_logger import RcutilsLogger

from ..contract import NANOSECONDS
from ..diagnosis.status import Status
from ..diagnosis.verdict import Level

QUIET = 30 * NANOSECONDS
"""Shortest time between two lines that differ in the kind of the reason alone [ns]."""


class _Logged(NamedTuple):
    severity: tuple[int, str, str]
    kind: tuple[str, ...]
    at: int

    def is_stale(self, status: Status, now: int) -> bool:
        """Whether the reason is of another kind, and the line is old enough at `now` [ns]."""
        return self.kind != status.kind and now - self.at >= QUIET


class StatusLog:
    """Logs a status where it differs from what the log says of it.

    Parameters
    ----------
    logger : RcutilsLogger
    """

    def __init__(self, logger: RcutilsLogger) -> None:
        self._logger = logger
        self._logged: dict[str, _Logged] = {}
        self._errors: set[str] = set()

    def note(self, statuses: Sequence[Status], now: int) -> None:
        """Log what is new at `now` [ns]."""
        for status in statuses:
            component = dict(status.values).get("component", "")
            severity = status.level, component, status.value("fault_code")
            before = self._logged.get(status.subject)
            if before is None or before.severity != severity or before.is_stale(status, now):
                self._logged[status.subject] = _Logged(severity, status.kind, now)
                self._write(status)

    def note_error(self, joint: str, traceback: str) -> None:
        """Log a traceback the first time it appears."""
        if traceback and traceback not in self._errors:
            self._errors.add(traceback)
            self._logger.error(f"{joint}: {traceback}")

    def _write(self, status: Status) -> None:
        text = f"{status.subject}: {status.value('reason')}"
        # A logger's line of code keeps its severity: one call for all three would raise.
        if status.level == Level.OK:
            self._logger.info(text)
        elif status.level == Level.WARN:
            self._logger.warning(text)
        else:
            self._logger.error(text)

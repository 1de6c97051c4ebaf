"""The log says what the statuses say, without a line for every number that changes."""

from typing import Any

import pytest

from hd_monitor.diagnosis.status import Status

pytestmark = pytest.mark.ros

SECOND = 1_000_000_000


class Logger:
    def __init__(self) -> None:
        self.lines: list[str] = []

    def info(self, text: str) -> None:
        self.lines.append(f"info {text}")

    def warning(self, text: str) -> None:
        self.lines.append(f"warning {text}")

    def error(self, text: str) -> None:
        self.lines.append(f"error {text}")


@pytest.fixture
def logger() -> Logger:
    return Logger()


@pytest.fixture
def log(logger: Logger) -> Any:
    from hd_monitor.ros.status_log import StatusLog

    return StatusLog(logger)  # type: ignore[arg-type]


def status(reason: str, *kind: str, level: int = 1, code: str = "HD_UNDETERMINED") -> list[Status]:
    values = (("component", "undetermined"), ("fault_code", code), ("reason", reason))
    return [Status(subject="elbow reducer", level=level, message="", hardware_id="", kind=kind, values=values)]


def test_level_and_code_are_logged_at_once_and_numbers_never(log: Any, logger: Logger) -> None:
    log.note(status("lag 3 ms", "lag"), 0)
    log.note(status("lag 4 ms", "lag"), 100 * SECOND)
    log.note(status("lag 4 ms", "lag", level=2), 101 * SECOND)
    log.note(status("sound", level=0, code="HD_OK"), 102 * SECOND)
    assert logger.lines == [
        "warning elbow reducer: lag 3 ms",
        "error elbow reducer: lag 4 ms",
        "info elbow reducer: sound",
    ]


def test_another_kind_of_reason_is_logged_but_not_every_second(log: Any, logger: Logger) -> None:
    for second in range(100):
        log.note(status(f"reason {second}", "lag" if second % 2 else "teeth"), second * SECOND)
    assert logger.lines == [f"warning elbow reducer: reason {second}" for second in (0, 31, 62, 93)]


def test_a_kind_that_came_while_the_log_was_quiet_is_logged_later(log: Any, logger: Logger) -> None:
    log.note(status("lag", "lag"), 0)
    for second in (1, 20, 40, 60):
        log.note(status("teeth", "teeth"), second * SECOND)
    assert logger.lines == ["warning elbow reducer: lag", "warning elbow reducer: teeth"]


def test_an_error_of_the_core_is_logged_once(log: Any, logger: Logger) -> None:
    for _ in range(2):
        log.note_error("elbow", "Traceback: x")
        log.note_error("elbow", "")
    assert logger.lines == ["error elbow: Traceback: x"]

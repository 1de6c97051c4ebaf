"""A long replay says how far it is and how long it still takes."""

import io
import sys
import time
from types import SimpleNamespace
from typing import Any, cast

import pytest

from hd_monitor.offline.progress import ProgressLine

SECOND = 1_000_000_000


def shown(span: tuple[int, int] | None, monkeypatch: pytest.MonkeyPatch) -> str:
    """Line of a replay that has taken 10 s for the first 100 s of a recording."""
    clock = iter((1000.0, 1010.0))
    monkeypatch.setattr(time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    line = ProgressLine(cast(Any, SimpleNamespace(span=span)))
    line(cast(Any, SimpleNamespace(start=0, end=100 * SECOND)))
    return cast(io.StringIO, sys.stderr).getvalue()


def test_part_pace_and_time_left(monkeypatch: pytest.MonkeyPatch) -> None:
    assert shown((0, 400 * SECOND), monkeypatch) == " 25%: 100 s of the recording, 10 times real time, 30 s left\n"


def test_without_a_known_length_neither_part_nor_time_left(monkeypatch: pytest.MonkeyPatch) -> None:
    assert shown(None, monkeypatch) == "100 s of the recording, 10 times real time\n"

"""What a node remembers over a restart, an exchange and a ledger that fails."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.hd_monitor.ros.test_joint_watch import alone, explain

from hd_monitor.errors import ParameterError
from hd_monitor.history.entry import Kind
from hd_monitor.history.ledger import Ledger
from hd_monitor.ros.joint_watch import JointWatch
from hd_monitor.ros.memory import Memory
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

pytestmark = pytest.mark.ros

SECOND = 1_000_000_000
DAY = 86_400.0

Feed = Callable[[float, float], list[bytes]]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "ledger.sqlite"


@pytest.fixture
def complaints() -> list[str]:
    return []


@pytest.fixture
def start_watch(path: Path, complaints: list[str]) -> Callable[..., JointWatch]:
    def start(date: float, serial: str = "A1", **parameters: Any) -> JointWatch:
        given = {"input.source": "joint_effort", "history.path": str(path), "reducer.serial": serial}
        settings = JointSettings.from_mapping(given | {k.replace("__", "."): v for k, v in parameters.items()})
        memory = Memory("elbow", settings, complaints.append)
        return JointWatch("elbow", settings, SECOND, explain, alone, memory, lambda: date)

    return start


def swinging(start: float, seconds: float, line: float = 0.3) -> list[bytes]:
    """Return joint states of a swinging joint, 100 a second; the circular spline's line is in its effort."""
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import JointState

    times = np.arange(0.0, seconds, 0.01)
    angle = 1.4 * np.sin(0.55 * times) + 0.2 * np.sin(1.3 * times)
    speed = 0.77 * np.cos(0.55 * times) + 0.26 * np.cos(1.3 * times)
    noise = np.random.default_rng(1).standard_normal(times.size)
    effort = 4.0 * np.sin(angle) + line * np.cos(160 * angle) + 0.1 * noise
    messages = []
    for at, where, pace, pull in zip(times, angle, speed, effort, strict=True):
        message = JointState(name=["elbow"], position=[where], velocity=[pace], effort=[pull])
        message.header.stamp.sec = int(start + at)
        message.header.stamp.nanosec = round((start + at) % 1 * SECOND)
        messages.append(serialize_message(message))
    return messages


def swing(watch: JointWatch, start: float, seconds: float, line: float = 0.3) -> None:
    """Let the joint swing."""
    messages = swinging(start, seconds, line)
    for first in range(0, len(messages), 100):
        watch.feed({Quantity.MOTION: messages[first : first + 100]}, round((1.0 + first / 100) * SECOND))


def test_a_restart_shows_the_last_verdict_with_its_age(start_watch: Callable[..., JointWatch]) -> None:
    watch = start_watch(DAY)
    assert watch.statuses()[0].value("fault_code") == "HD_WAITING"
    swing(watch, DAY, 60.0)
    assert watch.statuses()[0].value("component") == "circular_spline"
    watch.close()
    status = start_watch(DAY + 60.0 + 7200.0).statuses()[0]
    assert status.value("component") == "circular_spline"
    assert float(status.value("evidence age (s)")) == pytest.approx(7200.0, abs=2.0)
    assert status.message.startswith("The circular spline dominates")


def test_a_restart_goes_on_with_the_evidence(start_watch: Callable[..., JointWatch]) -> None:
    watch = start_watch(DAY)
    swing(watch, DAY, 60.0)
    watch.close()
    for serial, known in (("A1", "circular_spline"), ("B2", "undetermined")):
        again = start_watch(2 * DAY, serial)
        swing(again, 2 * DAY, 5.0)
        assert again.present.verdict.component == known
        assert again.statuses()[0].value("evidence age (s)") == "0"


def test_a_verdict_that_is_only_recalled_gets_no_newer(start_watch: Callable[..., JointWatch], path: Path) -> None:
    watch = start_watch(DAY)
    swing(watch, DAY, 60.0)
    watch.close()
    with Ledger(path) as ledger:
        before = ledger.entries("A1")
    again = start_watch(3 * DAY, analysis__memory=60.0)  # so that the evidence of then has faded
    swing(again, 3 * DAY, 1.5)
    reducer, inputs = again.statuses()
    assert inputs.value("fault_code") == "HD_INPUT_OK"
    assert reducer.value("component") == "circular_spline"
    assert float(reducer.value("evidence age (s)")) == pytest.approx(2 * DAY - 60.0, abs=3.0)
    again.close()
    with Ledger(path) as ledger:
        assert ledger.entries("A1") == before


def test_the_ledger_gets_an_entry_each_interval_and_at_each_transition(
    start_watch: Callable[..., JointWatch], path: Path
) -> None:
    watch = start_watch(DAY, history__interval=20.0)
    swing(watch, DAY, 70.0)
    with Ledger(path) as ledger:
        kinds = [entry.kind for entry in ledger.entries("A1")]
        assert kinds.count(Kind.EVIDENCE) >= 2
        assert kinds.count(Kind.TRANSITION) >= 1
        newest = ledger.entries("A1")[-1]
        watch.close()
        entries = ledger.entries("A1")
    assert entries[-1].time > newest.time
    assert sum(entry.seconds for entry in entries) == pytest.approx(66.0, abs=6.0)
    assert entries[-1].evidence
    assert entries[-1].lines[0].amplitude.circular_spline == pytest.approx(0.3, abs=0.03)


def test_a_reset_marks_an_exchange(start_watch: Callable[..., JointWatch], path: Path) -> None:
    watch = start_watch(DAY)
    swing(watch, DAY, 60.0)
    watch.reset()
    with Ledger(path) as ledger:
        assert ledger.entries("A1") == []
    watch.close()
    assert start_watch(2 * DAY).statuses()[0].value("fault_code") == "HD_WAITING"


def test_a_ledger_that_cannot_be_opened_costs_no_verdict(
    start_watch: Callable[..., JointWatch], path: Path, complaints: list[str]
) -> None:
    path.mkdir()
    watch = start_watch(DAY)
    swing(watch, DAY, 60.0)
    watch.reset_latch()
    assert watch.statuses()[0].value("component") == "circular_spline"
    watch.reset()
    watch.close()
    (complaint,) = complaints
    assert complaint.startswith("elbow: the history is not kept: ")
    assert "cannot be opened" in complaint


def test_a_baseline_rates_what_joint_states_alone_show(start_watch: Callable[..., JointWatch]) -> None:
    watch = start_watch(DAY, history__interval=20.0)
    swing(watch, DAY, 60.0)
    assert watch.statuses()[0].value("fault_code") == "HD_UNRATED"
    watch.set_baseline()
    swing(watch, DAY + 60.0, 10.0)
    assert watch.statuses()[0].value("fault_code") == "HD_OK"
    watch.close()
    grown = start_watch(2 * DAY, analysis__memory=60.0)
    swing(grown, 2 * DAY, 60.0, line=0.45)
    status = grown.statuses()[0]
    assert (status.level, status.value("fault_code")) == (1, "HD_CIRCULAR_SPLINE")
    assert "The circular spline's line has grown" in status.message


def test_what_was_seen_before_a_baseline_is_set_belongs_to_it(start_watch: Callable[..., JointWatch]) -> None:
    watch = start_watch(DAY)  # whose interval is far longer
    swing(watch, DAY, 60.0)
    watch.set_baseline()
    swing(watch, DAY + 60.0, 10.0)
    assert watch.statuses()[0].value("fault_code") == "HD_OK"


def test_a_baseline_needs_a_ledger() -> None:
    watch = JointWatch("elbow", JointSettings.from_mapping(), SECOND, explain, alone)
    with pytest.raises(ParameterError, match=r"history\.path is empty"):
        watch.set_baseline()

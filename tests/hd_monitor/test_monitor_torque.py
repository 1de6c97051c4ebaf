"""The transmitted torque from a force-torque sensor: used in place of efforts, and missed where it is lost."""

from collections.abc import Callable

import numpy as np
import pytest
from tests.hd_monitor.monitored import BLOCK, EPOCH, PAPER, RATE, Recording, latest

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.assessment import Assessment
from hd_monitor.diagnosis.inputs import InputCode
from hd_monitor.diagnosis.verdict import Component, Level
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

SECOND = 1_000_000_000
BLOCK_TIME = SECOND * BLOCK // RATE
# A parameter that would make the indexes three times too small, were it used.
GIVEN = PAPER | {"load.source": "wrench", "load.torque": 30.0}
SETTINGS = JointSettings.from_mapping(GIVEN)

Torque = tuple[IntArray, FloatArray]


@pytest.fixture(scope="module")
def recording() -> Recording:
    """No effort is measured."""
    recording = Recording()
    recording.effort[:] = np.nan
    return recording


@pytest.fixture(scope="module")
def torque(recording: Recording) -> Torque:
    """A sensor with a clock of its own: 73 Hz."""
    stamps = np.arange(EPOCH - SECOND // 10, EPOCH + 12.1 * SECOND, SECOND / 73).astype(np.int64)
    return stamps, 10.0 + np.random.default_rng(5).normal(0.0, 0.05, stamps.size)


def feed(monitor: Monitor, recording: Recording, torque: Torque) -> list[Assessment]:
    recording.feed_motion(monitor)
    for block in recording.blocks():
        monitor.add_block(block)
    monitor.add(Quantity.TORQUE, *torque)
    return monitor.advance()


def damaged(torque: Torque, where: Callable[[FloatArray], object], value: float | None) -> Torque:
    """Replace torques at chosen times [s], or leave them out."""
    stamps, values = torque[0], torque[1].copy()
    chosen = np.asarray(where((stamps - EPOCH) / SECOND))
    if value is None:
        return stamps[~chosen], values[~chosen]
    values[chosen] = value
    return stamps, values


def test_the_part_is_named_by_the_measured_torque_alone(recording: Recording, torque: Torque) -> None:
    monitor = Monitor(SETTINGS)
    feed(monitor, recording, torque)
    said = monitor.finish()
    assert said is not None
    assert said.verdict.component is Component.FLEXSPLINE
    assert said.torque_source == "wrench"
    assert said.identification is not None
    assert not said.identification.relative
    assert said.identification.index.flexspline == pytest.approx(0.0926, rel=0.05)
    assert said.quality.torque_messages > 12 * 70
    assert said.quality.torque_faults == 0


def test_the_result_does_not_depend_on_how_the_torque_comes(recording: Recording, torque: Torque) -> None:
    together, apart = Monitor(SETTINGS), Monitor(SETTINGS)
    expected = feed(together, recording, torque)
    stamps, values = torque
    said = []
    for number, block in enumerate(recording.blocks()):
        recording.feed_motion(apart, slice(10 * number, 10 * number + 10))
        apart.add_block(block)
        late = (stamps // SECOND * SECOND // BLOCK_TIME) == (block.stamp // BLOCK_TIME - 12)
        apart.add(Quantity.TORQUE, stamps[late], values[late])  # whole seconds at once, and late
        said += apart.advance()
    assert len(said) >= len(expected) - 3
    assert [s.verdict for s in said] == [s.verdict for s in expected[: len(said)]]


@pytest.mark.parametrize("value", [None, np.nan], ids=["lost", "not finite"])
def test_short_holes_are_bridged(recording: Recording, torque: Torque, value: float | None) -> None:
    monitor = Monitor(SETTINGS)
    said = feed(monitor, recording, damaged(torque, lambda t: t % 0.5 < 0.05, value))
    assert {s.torque_source for s in said} == {"wrench"}
    assert latest(monitor).verdict.component is Component.FLEXSPLINE
    assert all(np.isfinite(record.torque).all() for s in said for record in s.records)
    assert sum(len(record) for s in said for record in s.records) > 0.99 * sum(len(s.records[0]) for s in said)


@pytest.mark.parametrize(
    ("value", "code", "words"),
    [(None, InputCode.LOST, "No torque signal"), (np.nan, InputCode.INVALID, "not finite")],
    ids=["lost", "not finite"],
)
def test_a_failed_sensor_is_named_and_its_return_continues_with_the_evidence(
    recording: Recording, torque: Torque, value: float | None, code: InputCode, words: str
) -> None:
    monitor = Monitor(JointSettings.from_mapping(GIVEN | {"input.timeout": 2.0}))
    said = feed(monitor, recording, damaged(torque, lambda t: (t > 4.0) & (t < 8.5), value))
    during = [s for s in said if s.input.code is code]
    assert during
    assert {s.input.level for s in during} == {Level.ERROR}
    assert all(words in s.input.reason for s in during)
    assert {s.verdict.component for s in during} == {Component.FLEXSPLINE}
    assert all(not s.records for s in during)  # no torque is put in the place of the measured one
    assert all(s.identification is not None for s in during)
    assert latest(monitor).verdict.component is Component.FLEXSPLINE
    assert latest(monitor).torque_source == "wrench"


def test_a_sensor_that_never_comes_is_missed(recording: Recording) -> None:
    monitor = Monitor(JointSettings.from_mapping(GIVEN | {"input.startup_warning": 3.0}))
    said = feed(monitor, recording, (np.empty(0, dtype=np.int64), np.empty(0)))
    assert (said[-1].input.level, said[-1].input.code) == (Level.WARN, InputCode.WAITING)
    assert "torque signal" in said[-1].input.reason
    assert "joint states" not in said[-1].input.reason
    assert said[-1].verdict.reason == "No verdict yet: no torque signal so far"


def test_zeros_do_not_count_as_measured(recording: Recording, torque: Torque) -> None:
    monitor = Monitor(SETTINGS)
    feed(monitor, recording, (torque[0], 0.0 * torque[1]))
    said = latest(monitor)
    assert said.torque_source == "unknown"
    assert said.identification is not None
    assert said.identification.relative

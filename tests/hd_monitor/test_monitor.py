"""The monitor as a whole: right on simulated reducers, and deterministic however its input is bundled."""

from collections.abc import Callable

import numpy as np
import pytest
from tests.hd_monitor.monitored import BLOCK, EPOCH, PAPER, SETTINGS, UNITS, Recording, latest, run

from hd_monitor.assessment import Assessment
from hd_monitor.diagnosis.status import Status, status_of
from hd_monitor.diagnosis.verdict import Component, FaultCode, Level
from hd_monitor.identification.identifier import LONGEST_PERIOD, LONGEST_SEGMENT
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity


@pytest.fixture(scope="module")
def recording() -> Recording:
    return Recording()


@pytest.mark.parametrize("component", list(UNITS))
def test_names_the_component(component: Component) -> None:
    verdict = latest(run(Recording(component))).verdict
    assert verdict.component is component
    assert verdict.level is (Level.OK if component is Component.NONE else Level.ERROR)


def test_a_defect_that_appears_at_once_is_noticed_at_the_next_look() -> None:
    """By then the identifier knows the sound reducer so well that it looks at a second a minute."""
    turns = 48.0  # s; whole ones, so that the angle is continuous
    sound, worn = Recording(Component.NONE, seconds=turns), Recording(Component.FLEXSPLINE, seconds=160.0)
    monitor = run(sound)
    assert latest(monitor).verdict.component is Component.NONE
    later = round(turns * 1e9)
    monitor.add(Quantity.MOTION, worn.joint_stamps + later, worn.position, worn.velocity, worn.effort)
    monitor.add(Quantity.VIBRATION, worn.stamps + later, worn.values)
    said = [(a.stamp - EPOCH - later, a.verdict.component) for a in monitor.advance()]
    look = round((LONGEST_PERIOD + 2.0 * LONGEST_SEGMENT) * 1e9)
    assert Component.NONE not in {component for after, component in said if after > look}
    assert Component.CIRCULAR_SPLINE not in {component for _, component in said}
    assert {component for after, component in said if after > 2 * look} == {Component.FLEXSPLINE}


def test_assesses_every_whole_second_of_the_stamps_once(recording: Recording) -> None:
    monitor = Monitor(SETTINGS)
    recording.feed_motion(monitor)
    for block in recording.blocks():
        monitor.add_block(block)
    stamps = [assessment.stamp for assessment in monitor.advance()]
    assert stamps == [(EPOCH // 10**9 + i) * 10**9 for i in range(1, 13)]


def statuses(feed: Callable[[Monitor], list[Assessment]]) -> list[Status]:
    monitor = Monitor(SETTINGS)
    return [status_of(assessment, "joint") for assessment in feed(monitor)]


def test_statuses_do_not_depend_on_grouping_or_interleaving(recording: Recording) -> None:
    def topic_by_topic(monitor: Monitor) -> list[Assessment]:
        recording.feed_motion(monitor)
        for block in recording.blocks():
            monitor.add_block(block)
        return monitor.advance()

    def as_a_node_sees_them(monitor: Monitor) -> list[Assessment]:
        found = []
        for number, block in enumerate(recording.blocks()):
            recording.feed_motion(monitor, slice(10 * number, 10 * number + 4))
            monitor.add_block(block)
            found += monitor.advance()
            recording.feed_motion(monitor, slice(10 * number + 4, 10 * number + 10))
            found += monitor.advance()
        return found

    def vibration_first_in_odd_chunks(monitor: Monitor) -> list[Assessment]:
        found = []
        for first in range(0, recording.values.size - recording.values.size % BLOCK, 777):
            last = min(first + 777, recording.values.size - recording.values.size % BLOCK)
            monitor.add(Quantity.VIBRATION, recording.stamps[first:last], recording.values[first:last])
            found += monitor.advance()
            recording.feed_motion(monitor, slice(first // 10 + (first % 10 > 0), last // 10 + (last % 10 > 0)))
            found += monitor.advance()
        return found

    expected = statuses(topic_by_topic)
    assert len(expected) == 12
    assert statuses(as_a_node_sees_them) == expected
    assert statuses(vibration_first_in_odd_chunks) == expected


def test_nothing_is_said_before_both_inputs_came(recording: Recording) -> None:
    monitor = Monitor(SETTINGS)
    recording.feed_motion(monitor, slice(0, 150))
    assert monitor.advance() == []
    assert monitor.latest is None


def test_a_standing_joint_has_no_verdict_yet_and_says_why() -> None:
    stamps = EPOCH + np.arange(5000, dtype=np.int64) * 1_000_000
    monitor = Monitor(SETTINGS)
    still = np.zeros(500)
    monitor.add(Quantity.MOTION, stamps[::10], still + 0.3, still, still + 10.0)
    monitor.add(Quantity.VIBRATION, stamps, np.random.default_rng(1).normal(0.0, 0.1, 5000))
    monitor.finish()
    verdict = latest(monitor).verdict
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.OK)
    assert verdict.fault_code is FaultCode.WAITING
    assert verdict.reason.startswith("No verdict yet: the joint has not turned enough")


def test_a_recording_shorter_than_a_period_is_assessed(recording: Recording) -> None:
    monitor = Monitor(SETTINGS)
    recording.feed_motion(monitor, slice(0, 60))
    for block in recording.blocks()[:5]:
        monitor.add_block(block)
    assert monitor.advance() == []
    assert monitor.finish() is not None


def test_a_clip_of_a_second_and_a_third_gets_its_verdict_in_the_end() -> None:
    """Shorter than the segments of motion that a node waits for, and no second look to confirm it."""
    clip = Recording(Component.FLEXSPLINE, rpm=1500.0, seconds=1.3)
    monitor = Monitor(SETTINGS)
    clip.feed_motion(monitor)
    for block in clip.blocks():
        monitor.add_block(block)
    assert all(said.verdict.fault_code is FaultCode.WAITING for said in monitor.advance())
    last = monitor.finish()
    assert last is not None
    assert last.identification is not None
    assert last.verdict.component is Component.FLEXSPLINE


def test_reset_forgets_the_evidence_but_not_the_counters(recording: Recording) -> None:
    monitor = run(recording)
    monitor.reset()
    silent = monitor.silence(EPOCH)
    assert silent.identification is None
    assert silent.rms_curve == ()
    assert silent.quality.samples > 0


def test_zoom_spectrum_and_rms_curve(recording: Recording) -> None:
    assessment = latest(run(recording))
    zoom = assessment.zoom
    assert zoom is not None
    assert zoom.frequencies.size <= 50
    assert zoom.resolved
    assert zoom.line_amplitudes.flexspline > zoom.line_amplitudes.circular_spline
    (only,) = assessment.rms_curve
    assert only.rpm == pytest.approx(1000.0)
    expected = 0.55 * np.sqrt(np.mean(recording.values**2))
    assert only.rms == pytest.approx(expected, rel=0.02)


def test_without_any_torque_the_result_is_relative(recording: Recording) -> None:
    settings = JointSettings.from_mapping(PAPER | {"load.source": "unknown"})
    assessment = latest(run(recording, settings=settings))
    assert assessment.identification is not None
    assert assessment.identification.relative
    assert assessment.verdict.component is Component.FLEXSPLINE


@pytest.mark.parametrize(("sensor", "effort"), [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])
def test_signs_of_sensor_and_effort_are_a_matter_of_mounting(
    recording: Recording, sensor: float, effort: float
) -> None:
    monitor = Monitor(SETTINGS)
    monitor.add(
        Quantity.MOTION, recording.joint_stamps, recording.position, recording.velocity, effort * recording.effort
    )
    for block in recording.blocks():
        monitor.add_block(block._replace(samples=sensor * block.samples))
    monitor.finish()
    found, expected = latest(monitor).identification, latest(run(recording)).identification
    assert found is not None
    assert expected is not None
    for one, other, std in zip(found.index, expected.index, expected.index_std, strict=True):
        assert one == pytest.approx(other, abs=3.0 * std)

"""The monitor as a whole: right on simulated reducers, deterministic, and calm about every kind of bad input."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from hd_monitor.assessment import Assessment
from hd_monitor.contract import Block
from hd_monitor.diagnosis.status import Status, status_of
from hd_monitor.diagnosis.verdict import Component, FaultCode, Level
from hd_monitor.model import ParametricModel, StiffnessSeries
from hd_monitor.model.simulation import constant_speed, simulate
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings

EPOCH = 1_700_000_000_250_000_000
RATE = 1000
BLOCK = 100
SETTINGS = JointSettings.from_mapping({"reducer.serial": "SHG-20-80 no. 7"})

SOUND, WORN = (0.012, 0.008, 0.004), (0.075, 0.045, 0.03)
UNITS = {
    Component.NONE: (SOUND, SOUND),
    Component.CIRCULAR_SPLINE: (WORN, SOUND),
    Component.FLEXSPLINE: (SOUND, WORN),
    Component.BOTH: (WORN, WORN),
}


class Recording:
    """Arrays of a simulated run at one speed: what the messages would carry."""

    def __init__(self, component: Component = Component.FLEXSPLINE, rpm: float = 1000.0, seconds: float = 12.0) -> None:
        cs, fs = UNITS[component]
        model = ParametricModel(
            circular_spline=StiffnessSeries(cs, (0.4, 1.0, -2.0)), flexspline=StiffnessSeries(fs, (-1.2, 0.3, 2.5))
        )
        run = simulate(model, constant_speed(model.reducer, rpm), duration=seconds, rate=4.0 * RATE)
        rng = np.random.default_rng(20)
        self.stamps = EPOCH + np.rint(run.times[::4] * 1e9).astype(np.int64)
        self.values = run.acceleration[::4] + rng.normal(0.0, 0.3, self.stamps.size)
        self.joint_stamps = self.stamps[::10]
        self.position = run.output_angle[::40]
        self.velocity = np.full(self.position.size, float(run.output_angle[-1] / run.times[-1]))
        self.effort = np.full(self.position.size, 10.0)

    def blocks(self) -> list[Block]:
        return [
            Block(int(self.stamps[i]), 1.0 / RATE, i // BLOCK, self.values[i : i + BLOCK])
            for i in range(0, self.values.size - BLOCK + 1, BLOCK)
        ]

    def feed_motion(self, monitor: Monitor, chosen: slice = slice(None)) -> None:
        monitor.add_motion(self.joint_stamps[chosen], self.position[chosen], self.velocity[chosen], self.effort[chosen])


@pytest.fixture(scope="module")
def recording() -> Recording:
    return Recording()


def run(recording: Recording, blocks: Sequence[Block] | None = None, settings: JointSettings = SETTINGS) -> Monitor:
    monitor = Monitor("joint", settings)
    recording.feed_motion(monitor)
    for block in recording.blocks() if blocks is None else blocks:
        monitor.add_block(block)
    monitor.finish()
    return monitor


def latest(monitor: Monitor) -> Assessment:
    assert monitor.latest is not None
    return monitor.latest


@pytest.mark.parametrize("component", list(UNITS))
def test_names_the_component(component: Component) -> None:
    verdict = latest(run(Recording(component))).verdict
    assert verdict.component is component
    assert verdict.level is (Level.OK if component is Component.NONE else Level.ERROR)


def test_assesses_every_whole_second_of_the_stamps_once(recording: Recording) -> None:
    monitor = Monitor("joint", SETTINGS)
    recording.feed_motion(monitor)
    for block in recording.blocks():
        monitor.add_block(block)
    stamps = [assessment.stamp for assessment in monitor.advance()]
    assert stamps == [(EPOCH // 10**9 + i) * 10**9 for i in range(1, 13)]


def statuses(feed: Callable[[Monitor], list[Assessment]]) -> list[Status]:
    monitor = Monitor("joint", SETTINGS)
    return [status_of(assessment, "joint", SETTINGS) for assessment in feed(monitor)]


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
            monitor.add_vibration(recording.stamps[first:last], recording.values[first:last])
            found += monitor.advance()
            recording.feed_motion(monitor, slice(first // 10 + (first % 10 > 0), last // 10 + (last % 10 > 0)))
            found += monitor.advance()
        return found

    expected = statuses(topic_by_topic)
    assert len(expected) == 12
    assert statuses(as_a_node_sees_them) == expected
    assert statuses(vibration_first_in_odd_chunks) == expected


def test_nothing_is_said_before_both_inputs_came(recording: Recording) -> None:
    monitor = Monitor("joint", SETTINGS)
    recording.feed_motion(monitor, slice(0, 150))
    assert monitor.advance() == []
    assert monitor.latest is None


@pytest.mark.parametrize("missing", ["joint states", "vibration"])
def test_a_missing_input_is_named(recording: Recording, missing: str) -> None:
    monitor = Monitor("joint", SETTINGS)
    if missing == "vibration":
        recording.feed_motion(monitor)
    else:
        for block in recording.blocks():
            monitor.add_block(block)
    verdict = monitor.advance()[-1].verdict
    assert (verdict.component, verdict.fault_code) == (Component.UNDETERMINED, FaultCode.INPUT_LOST)
    assert verdict.level is Level.ERROR
    assert missing in verdict.reason


def test_silence_keeps_the_evidence(recording: Recording) -> None:
    monitor = run(recording)
    before = latest(monitor)
    silent = monitor.silence(before.stamp + 5 * 10**9)
    assert silent.verdict.fault_code is FaultCode.INPUT_LOST
    assert silent.identification is before.identification
    assert latest(monitor) is before


def test_loss_of_an_input_midway_and_its_return(recording: Recording) -> None:
    lost = slice(30, 70)
    blocks = recording.blocks()
    del blocks[lost]
    monitor = Monitor("joint", SETTINGS)
    recording.feed_motion(monitor)
    for block in blocks:
        monitor.add_block(block)
    codes = [assessment.verdict.fault_code for assessment in monitor.advance()]
    assert FaultCode.INPUT_LOST in codes
    assert codes[-1] is FaultCode.FLEXSPLINE
    assert latest(monitor).quality.gaps == 1
    assert latest(monitor).quality.lost == 4000


def test_bad_samples_are_counted_and_survived(recording: Recording) -> None:
    rng = np.random.default_rng(3)
    blocks = []
    for block in recording.blocks():
        samples = block.samples.copy()
        samples[rng.integers(0, BLOCK)] = np.nan
        samples[rng.integers(1, BLOCK // 3) * 3 - 1] += 500.0
        blocks.append(block._replace(samples=samples))
    assessment = latest(run(recording, blocks))
    times = recording.stamps[: BLOCK * len(blocks)]
    broken = np.isnan(np.concatenate([block.samples for block in blocks]))
    assert assessment.quality.not_finite == broken[times < assessment.stamp].sum()
    assert assessment.quality.spikes >= 0.9 * len(blocks)
    assert assessment.verdict.component is Component.FLEXSPLINE


def test_lost_repeated_and_swapped_blocks_are_counted_and_survived(recording: Recording) -> None:
    blocks = recording.blocks()
    blocks[20], blocks[21] = blocks[21], blocks[20]  # 0.1 s late: beyond what is waited for
    blocks.insert(50, blocks[49])
    del blocks[80]
    assessment = latest(run(recording, blocks))
    assert assessment.quality.duplicates == BLOCK
    assert assessment.quality.out_of_order > 0
    assert assessment.quality.gaps >= 1
    assert assessment.verdict.component is Component.FLEXSPLINE


def test_a_publisher_that_numbers_no_blocks_loses_none(recording: Recording) -> None:
    blocks = [block._replace(sequence=0) for block in recording.blocks()]
    assert latest(run(recording, blocks)).quality == latest(run(recording)).quality


def test_two_publishers_of_one_topic_are_noticed(recording: Recording) -> None:
    blocks = [twin for block in recording.blocks() for twin in (block, block._replace(samples=-block.samples))]
    assessment = latest(run(recording, blocks))
    assert assessment.quality.rejected == len(recording.blocks())
    assert "two publishers" in assessment.quality.last_fault
    assert assessment.verdict.component is Component.FLEXSPLINE


def test_a_stuck_sensor_gives_no_verdict(recording: Recording) -> None:
    blocks = [block._replace(samples=np.full(BLOCK, 0.25)) for block in recording.blocks()]
    assessment = latest(run(recording, blocks))
    assert assessment.quality.stuck == assessment.quality.samples
    assert assessment.verdict.component is Component.UNDETERMINED
    assert assessment.verdict.fault_code is FaultCode.INPUT_INVALID
    assert "did not change" in assessment.verdict.reason
    assert assessment.zoom is None


def test_a_sensor_that_breaks_later_is_not_covered_by_old_evidence(recording: Recording) -> None:
    blocks = [
        block._replace(samples=np.full(BLOCK, np.nan)) if block.sequence > 60 else block for block in recording.blocks()
    ]
    assessment = latest(run(recording, blocks))
    assert assessment.identification is not None
    assert assessment.verdict.fault_code is FaultCode.INPUT_INVALID
    assert "not finite" in assessment.verdict.reason


def test_a_clock_set_back_loses_no_evidence(recording: Recording) -> None:
    monitor = run(recording)
    before = latest(monitor).identification
    assert before is not None
    shift = 3600 * 10**9
    monitor.add_motion(recording.joint_stamps - shift, recording.position, recording.velocity, recording.effort)
    for block in recording.blocks():
        monitor.add_block(block._replace(stamp=block.stamp - shift, sequence=block.sequence + 500))
    monitor.advance()
    after = latest(monitor)
    assert after.quality.clock_jumps == 2
    assert after.stamp < EPOCH
    assert after.identification is not None
    assert after.identification.samples > before.samples
    assert after.verdict.component is Component.FLEXSPLINE


def test_rejected_messages_show(recording: Recording) -> None:
    monitor = run(recording)
    monitor.reject("a block has 2 dimensions")
    assert monitor.silence(0).quality.rejected == 1
    assert "2 dimensions" in monitor.silence(0).quality.last_fault


def test_efforts_of_zero_are_no_measurement(recording: Recording) -> None:
    monitor = Monitor("joint", SETTINGS)
    monitor.add_motion(recording.joint_stamps, recording.position, recording.velocity, 0.0 * recording.effort)
    for block in recording.blocks():
        monitor.add_block(block)
    monitor.finish()
    found = latest(monitor).identification
    assert found is not None
    assert not found.relative  # load.torque stands in, and the status says so
    assert latest(monitor).torque_source == "assumed"
    assert "taken to be 10 N·m" in latest(monitor).verdict.reason
    assert latest(monitor).verdict.component is Component.FLEXSPLINE


def test_a_standing_joint_is_undetermined_and_says_why() -> None:
    stamps = EPOCH + np.arange(5000, dtype=np.int64) * 1_000_000
    monitor = Monitor("joint", SETTINGS)
    still = np.zeros(500)
    monitor.add_motion(stamps[::10], still + 0.3, still, still + 10.0)
    monitor.add_vibration(stamps, np.random.default_rng(1).normal(0.0, 0.1, 5000))
    monitor.finish()
    verdict = latest(monitor).verdict
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.WARN)
    assert "turn" in verdict.reason


def test_positions_in_degrees_are_suspected(recording: Recording) -> None:
    monitor = Monitor("joint", SETTINGS)
    wrong = np.degrees(recording.position), np.degrees(recording.velocity)
    monitor.add_motion(recording.joint_stamps, *wrong, recording.effort)
    for block in recording.blocks():
        monitor.add_block(block)
    monitor.finish()
    verdict = latest(monitor).verdict
    assert verdict.component is Component.UNDETERMINED
    assert "in rad" in verdict.reason


def test_a_recording_shorter_than_a_period_is_assessed(recording: Recording) -> None:
    monitor = Monitor("joint", SETTINGS)
    recording.feed_motion(monitor, slice(0, 60))
    for block in recording.blocks()[:5]:
        monitor.add_block(block)
    assert monitor.advance() == []
    assert monitor.finish() is not None


def test_reset_forgets_the_evidence_but_not_the_counters(recording: Recording) -> None:
    monitor = run(recording)
    monitor.reset()
    silent = monitor.silence(EPOCH)
    assert silent.identification is None
    assert silent.rms_curve.bins == ()
    assert silent.quality.samples > 0


def test_zoom_spectrum_and_rms_curve(recording: Recording) -> None:
    assessment = latest(run(recording))
    zoom = assessment.zoom
    assert zoom is not None
    assert zoom.frequencies.size <= 50
    assert zoom.resolved
    assert zoom.line_amplitudes.flexspline > zoom.line_amplitudes.circular_spline
    (only,) = assessment.rms_curve.bins
    assert only.rpm == pytest.approx(1000.0)
    expected = 0.55 * np.sqrt(np.mean(recording.values**2))
    assert only.rms == pytest.approx(expected, rel=0.02)


def test_without_any_torque_the_result_is_relative(recording: Recording) -> None:
    settings = JointSettings.from_mapping({"load.source": "unknown"})
    assessment = latest(run(recording, settings=settings))
    assert assessment.identification is not None
    assert assessment.identification.relative
    assert assessment.verdict.component is Component.FLEXSPLINE


@pytest.mark.parametrize(("sensor", "effort"), [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])
def test_signs_of_sensor_and_effort_are_a_matter_of_mounting(
    recording: Recording, sensor: float, effort: float
) -> None:
    monitor = Monitor("joint", SETTINGS)
    monitor.add_motion(recording.joint_stamps, recording.position, recording.velocity, effort * recording.effort)
    for block in recording.blocks():
        monitor.add_block(block._replace(samples=sensor * block.samples))
    monitor.finish()
    found, expected = latest(monitor).identification, latest(run(recording)).identification
    assert found is not None
    assert expected is not None
    for one, other, std in zip(found.index, expected.index, expected.index_std, strict=True):
        assert one == pytest.approx(other, abs=3.0 * std)

"""Every kind of bad input is counted and tolerated, and named where it prevents a verdict."""

import tracemalloc

import numpy as np
import pytest
from tests.hd_monitor.monitored import BLOCK, EPOCH, PAPER, RATE, Recording, latest, run

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import Block
from hd_monitor.diagnosis.inputs import InputCode
from hd_monitor.diagnosis.verdict import Component, FaultCode, Level
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

HASTY = JointSettings.from_mapping(PAPER | {"input.timeout": 2.0})


@pytest.fixture(scope="module")
def recording() -> Recording:
    return Recording()


@pytest.mark.parametrize("missing", ["joint states", "vibration"])
def test_an_input_that_never_comes_is_awaited_then_overdue_then_lost(recording: Recording, missing: str) -> None:
    times = {"input.timeout": 2.0, "input.startup_warning": 4.0, "input.startup_timeout": 7.0}
    monitor = Monitor(JointSettings.from_mapping(PAPER | times))
    if missing == "vibration":
        recording.feed_motion(monitor)
    else:
        for block in recording.blocks():
            monitor.add_block(block)
    said = monitor.advance()
    states = [(assessment.input.level, assessment.input.code) for assessment in said]
    waiting = [(Level.OK, InputCode.WAITING)] * 3 + [(Level.WARN, InputCode.WAITING)] * 3
    assert states == [*waiting, *[(Level.ERROR, InputCode.LOST)] * (len(said) - 6)]
    assert len(said) > 6
    assert all(missing in assessment.input.reason for assessment in said)
    assert {(assessment.verdict.fault_code, assessment.verdict.level) for assessment in said} == {
        (FaultCode.WAITING, Level.OK)
    }
    assert f"no {missing}" in said[0].verdict.reason


def test_silence_keeps_verdict_and_evidence(recording: Recording) -> None:
    monitor = run(recording)
    before = latest(monitor)
    silent = monitor.silence(before.stamp + 5 * 10**9)
    assert silent.input.code is InputCode.LOST
    assert silent.verdict.component is Component.FLEXSPLINE
    assert silent.verdict.level is Level.ERROR
    assert silent.evidence_age == pytest.approx(before.evidence_age + 5.0)
    assert silent.identification is before.identification
    assert latest(monitor) is before


def test_loss_of_an_input_midway_and_its_return(recording: Recording) -> None:
    lost = slice(40, 80)
    blocks = recording.blocks()
    del blocks[lost]
    monitor = Monitor(HASTY)
    recording.feed_motion(monitor)
    for block in blocks:
        monitor.add_block(block)
    said = monitor.advance()
    during = [assessment for assessment in said if assessment.input.code is InputCode.LOST]
    assert during
    assert {assessment.verdict.fault_code for assessment in during} == {FaultCode.FLEXSPLINE}
    assert [assessment.evidence_age for assessment in during] == [float(n) for n in range(2, 2 + len(during))]
    assert (said[-1].verdict.fault_code, said[-1].input.code) == (FaultCode.FLEXSPLINE, InputCode.OK)
    assert said[-1].evidence_age == 0.0
    assert latest(monitor).quality.gaps == 1
    assert latest(monitor).quality.lost == 4000


def test_without_a_verdict_a_lost_input_leaves_none(recording: Recording) -> None:
    monitor = Monitor(HASTY)
    recording.feed_motion(monitor)
    for block in recording.blocks()[:5]:
        monitor.add_block(block)
    said = monitor.advance()[-1]
    assert said.input.code is InputCode.LOST
    assert (said.verdict.fault_code, said.verdict.level) == (FaultCode.WAITING, Level.OK)
    assert "the input's status says which" in said.verdict.reason


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


def test_blocks_without_numbers_are_all_used(recording: Recording) -> None:
    blocks = [block._replace(sequence=0) for block in recording.blocks()]
    assert latest(run(recording, blocks)).quality == latest(run(recording)).quality


def test_two_publishers_of_one_topic_are_noticed(recording: Recording) -> None:
    blocks = [twin for block in recording.blocks() for twin in (block, block._replace(samples=-block.samples))]
    assessment = latest(run(recording, blocks))
    assert assessment.quality.rejected == len(recording.blocks())
    assert "two publishers" in assessment.quality.last_fault
    assert assessment.verdict.component is Component.FLEXSPLINE


@pytest.mark.parametrize("lag", [20, 50, 70])
def test_blocks_of_another_publisher_are_left_out(recording: Recording, lag: int) -> None:
    others = [
        Block(int(recording.stamps[first]), 1.0 / RATE, 500 + first // BLOCK, recording.values[first : first + BLOCK])
        for first in range(lag, recording.values.size - BLOCK, BLOCK)
    ]
    mixed = [block for pair in zip(recording.blocks(), others, strict=False) for block in pair]
    assessment = latest(run(recording, mixed))
    assert assessment.quality.rejected >= len(others) - 1
    assert "two publishers" in assessment.quality.last_fault
    assert assessment.verdict.component is Component.FLEXSPLINE


def samples_only(recording: Recording, stamps: IntArray, values: FloatArray) -> Monitor:
    """Feed single samples in small groups, as a node does."""
    monitor = Monitor(JointSettings.from_mapping(PAPER | {"input.source": "accel_stamped"}))
    recording.feed_motion(monitor)
    for first in range(0, stamps.size, 50):
        monitor.add(Quantity.VIBRATION, stamps[first : first + 50], values[first : first + 50])
    monitor.finish()
    return monitor


@pytest.mark.parametrize("spacing", [0, 20_000, 100_000, 400_000])
def test_a_fifo_stamped_as_it_is_read_gives_the_verdict(recording: Recording, spacing: int) -> None:
    count = recording.stamps.size // 16 * 16
    place = np.arange(count) % 16
    stamps = recording.stamps[np.arange(count) - place + 15] + spacing * place
    assessment = latest(samples_only(recording, stamps, recording.values[:count]))
    assert assessment.quality.rate == pytest.approx(1000.0, rel=1e-6)
    assert assessment.quality.gaps == 0
    assert "bursts of 16" in assessment.quality.last_fault
    assert assessment.verdict.component is Component.FLEXSPLINE


@pytest.mark.parametrize("lag", [1_000, 20_000, 300_000])
def test_alternating_samples_of_two_publishers_give_no_verdict(recording: Recording, lag: int) -> None:
    stamps = np.column_stack([recording.stamps, recording.stamps + lag]).ravel()
    values = np.column_stack([recording.values, -recording.values]).ravel()
    assessment = latest(samples_only(recording, stamps, values))
    assert assessment.input.code is InputCode.INVALID
    assert "2 publishers alternate" in assessment.input.reason
    assert assessment.verdict.component is Component.UNDETERMINED
    assert assessment.quality.dropped > 0


def test_samples_in_heaps_a_microsecond_apart_cost_no_memory(recording: Recording) -> None:
    heaps = np.sort(np.random.default_rng(0).integers(0, 12 * 10**9, recording.stamps.size // 10 + 1))
    index = np.arange(recording.stamps.size)
    tracemalloc.start()
    try:
        monitor = samples_only(
            recording, np.sort(recording.stamps[0] + heaps[index // 10] + index % 10 * 1000), recording.values
        )
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert latest(monitor).input.code is InputCode.INVALID
    assert "1 µs apart" in latest(monitor).input.reason
    assert peak < 10e6


def test_a_stuck_sensor_gives_no_verdict(recording: Recording) -> None:
    blocks = [block._replace(samples=np.full(BLOCK, 0.25)) for block in recording.blocks()]
    assessment = latest(run(recording, blocks))
    assert assessment.quality.stuck == assessment.quality.samples
    assert assessment.verdict.component is Component.UNDETERMINED
    assert assessment.input.code is InputCode.INVALID
    assert "did not change" in assessment.input.reason
    assert assessment.zoom is None


def test_a_sensor_that_breaks_later_shows_although_the_verdict_stands(recording: Recording) -> None:
    blocks = [
        block._replace(samples=np.full(BLOCK, np.nan)) if block.sequence > 60 else block for block in recording.blocks()
    ]
    assessment = latest(run(recording, blocks, HASTY))
    assert assessment.verdict.component is Component.FLEXSPLINE
    assert assessment.evidence_age > 3.0
    assert assessment.input.level is Level.ERROR
    assert assessment.input.code is InputCode.INVALID
    assert "not finite" in assessment.input.reason


def test_a_clock_set_back_loses_no_evidence(recording: Recording) -> None:
    monitor = run(recording)
    before = latest(monitor).identification
    assert before is not None
    shift = 3600 * 10**9
    monitor.add(
        Quantity.MOTION, recording.joint_stamps - shift, recording.position, recording.velocity, recording.effort
    )
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

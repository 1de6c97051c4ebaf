"""Messages that say nothing are reported and survived: good ones behind them count as ever."""

from array import array
from typing import Any

import numpy as np
import pytest
from tests.benchmarks.live_cost import use_of

from .conftest import ERROR, Bench, Feeder, Shown

pytestmark = pytest.mark.ros


@pytest.fixture
def listening(bench: Bench, feeder: Feeder) -> Bench:
    bench.monitor("input.timeout:=0.5")
    bench.until(feeder.matched, "the monitor's subscriptions")
    return bench


def assert_recovers(bench: Bench, feeder: Feeder) -> None:
    before = bench.statuses[-1].number("samples") if bench.statuses else 0
    bench.forget()
    found: list[Shown] = []

    def recovered() -> bool:
        # While messages keep coming: without them the input would soon count as lost again.
        feeder.send(2)
        pairs = zip(bench.statuses, bench.inputs, strict=True)
        found.extend(s for s, i in pairs if s.number("samples") >= before + 1000 and is_heard(s, i))
        return bool(found)

    bench.until(recovered, "a status with a speed, of good samples counted again")
    assert found[0].number("speed (rpm)") == pytest.approx(Feeder.SPEED, rel=0.01)


def is_heard(status: Shown, inputs: Shown) -> bool:
    """Whether vibration with known motion came in the last period, so that there is a speed to show."""
    return inputs.fault_code == "HD_INPUT_OK" and "speed (rpm)" in status.values


def test_wrong_layout(listening: Bench, feeder: Feeder) -> None:
    def reported() -> bool:
        feeder.send(1, label="vibration")
        return any(s.fault_code == "HD_INPUT_INVALID" for s in listening.inputs)

    listening.until(reported, "a report of the wrong layout")
    status = next(s for s in listening.inputs if s.fault_code == "HD_INPUT_INVALID")
    assert "labelled 'vibration'; the contract requires 'torsional_acceleration'" in status.values["reason"]
    assert status.number("rejected messages") >= 1
    assert_recovers(listening, feeder)


def test_array_without_a_layout(listening: Bench, feeder: Feeder) -> None:
    from std_msgs.msg import Float64MultiArray

    feeder.blocks.publish(Float64MultiArray())
    feeder.blocks.publish(Float64MultiArray(data=[1.0, 2.0]))
    listening.until_input(lambda s: s.number("rejected messages") == 2, "two rejected messages")
    assert_recovers(listening, feeder)


def test_nan_samples(listening: Bench, feeder: Feeder) -> None:
    def reported() -> bool:
        feeder.send(1, samples=np.full(Feeder.SAMPLES, np.nan))
        return any(s.number("not finite") >= 1000 and s.level == ERROR for s in listening.inputs)

    listening.until(reported, "a report of what is not finite")
    status = next(s for s in listening.inputs if s.level == ERROR)
    assert status.fault_code == "HD_INPUT_INVALID"
    assert "not finite" in status.message
    assert "not finite" in status.values["last complaint"]
    assert {s.component for s in listening.statuses} == {"undetermined"}
    assert_recovers(listening, feeder)


def test_joint_states_of_nan_and_of_unequal_lengths(listening: Bench, feeder: Feeder) -> None:
    from sensor_msgs.msg import JointState

    nan = float("nan")
    for _ in range(50):
        feeder.motion.publish(JointState(name=["joint"], position=[nan], velocity=[nan], effort=[nan]))
        feeder.motion.publish(JointState(name=["joint"], position=[1.0, 2.0]))
        feeder.motion.publish(JointState())
    listening.until_input(lambda s: s.number("rejected messages") >= 50, "rejected joint states")
    assert_recovers(listening, feeder)


def test_stamps_that_do_not_advance(listening: Bench, feeder: Feeder) -> None:
    block = feeder.block()

    def reported() -> bool:
        block.data[3] += 1.0
        feeder.blocks.publish(block)
        return any("stamps are stuck" in s.values["reason"] for s in listening.inputs)

    listening.until(reported, "a report of stuck stamps")
    assert_recovers(listening, feeder)


def test_half_a_message_never_ends_the_node(listening: Bench, feeder: Feeder, peer: Any) -> None:
    rng = np.random.default_rng(7)
    for size in (0, 1, 3, 4, 5, 53):
        message = feeder.block()
        message.data = message.data[:size]
        feeder.blocks.publish(message)
    message = feeder.block(rng.normal(size=Feeder.SAMPLES))
    message.data[2] = -1.0  # sample period
    feeder.blocks.publish(message)
    listening.until_input(lambda s: s.number("rejected messages") >= 7, "seven rejected messages")
    assert_recovers(listening, feeder)


def test_messages_that_are_far_too_large_leave_no_memory_behind(bench: Bench, feeder: Feeder, peer: Any) -> None:
    from std_msgs.msg import Float64MultiArray

    node = bench.monitor("input.timeout:=0.5")
    bench.until(feeder.matched, "the monitor's subscriptions")

    def warm() -> bool:
        feeder.send(20)
        return any(s.number("samples") >= 20_000 for s in bench.statuses)

    bench.until(warm, "the memory that identification takes")
    size = 40_000_000  # above what the C library ever keeps for later
    careless = peer.publisher(Float64MultiArray, "torsional_acceleration/block", depth=1)
    message = Float64MultiArray(data=array("d", bytes(size)))
    taken = []
    for number in range(1, 6):
        careless.publish(message)

        def rejected(number: int = number) -> bool:
            feeder.send(1)  # ordinary blocks take up the places in the queue that large messages have left
            return any(s.number("rejected messages") == number for s in bench.inputs)

        bench.until(rejected, f"{number} rejected messages")
        taken.append(use_of(node.popen.pid).memory)
    assert "a message of 40.0 MB; more than 2 MB are not read" in bench.inputs[-1].values["last complaint"]
    assert max(taken) - taken[0] < 20.0, taken
    assert_recovers(bench, feeder)

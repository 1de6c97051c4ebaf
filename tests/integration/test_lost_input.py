"""No input, or one that cannot be heard, is a status that says which topic and why."""

from typing import Any

import pytest

from .conftest import ERROR, Bench, Feeder, Shown

pytestmark = pytest.mark.ros


def lost(status: Shown) -> bool:
    return status.fault_code == "HD_INPUT_LOST"


def test_no_publisher_at_all(bench: Bench) -> None:
    bench.monitor("input.timeout:=0.5")
    status = bench.until_status(lost, "a lost input")
    assert (status.level, status.component) == (ERROR, "undetermined")
    assert "nothing publishes /torsional_acceleration/block (std_msgs/msg/Float64MultiArray)" in status.message
    assert "nothing publishes /joint_states (sensor_msgs/msg/JointState)" in status.message
    assert status.values["reason"] == status.message


def test_statuses_continue_without_input(bench: Bench) -> None:
    bench.monitor("input.timeout:=0.5")
    bench.until(lambda: len(bench.statuses) >= 4, "a status every second")


def test_sensorless_joint_lacks_joint_states_only(bench: Bench) -> None:
    bench.monitor("input.timeout:=0.5", "input.source:=joint_effort")
    status = bench.until_status(lost, "a lost input")
    assert "/joint_states" in status.message
    assert "torsional_acceleration" not in status.message


def test_a_torque_sensor_that_sends_nothing_is_missed_alone(bench: Bench, feeder: Feeder) -> None:
    bench.monitor("input.timeout:=0.5", "load.source:=wrench", "load.topic:=ft_sensor/wrench")
    bench.until(feeder.matched, "the monitor's subscriptions")

    def missed() -> bool:
        feeder.send(1)
        return any(
            lost(status)
            and "nothing publishes /ft_sensor/wrench (geometry_msgs/msg/WrenchStamped)" in status.message
            and "joint states" not in status.message
            for status in bench.statuses
        )

    bench.until(missed, "a status that misses the torque only")


def test_vibration_without_joint_states(bench: Bench, feeder: Feeder) -> None:
    bench.monitor("input.timeout:=0.5")
    bench.until(feeder.matched, "the monitor's subscriptions")
    bench.forget()

    def only_motion_is_lost() -> bool:
        feeder.send(1, motion=False)
        return any(
            lost(status) and "/joint_states but sends nothing" in status.message and "ibration" not in status.message
            for status in bench.statuses
        )

    bench.until(only_motion_is_lost, "a status that misses the joint states only")


def test_input_that_ends_is_missed_and_the_evidence_kept(bench: Bench, feeder: Feeder) -> None:
    bench.monitor("input.timeout:=0.5")
    bench.until(feeder.matched, "the monitor's subscriptions")
    feeder.send(100)
    bench.until_status(lambda s: s.number("samples") >= 2000, "two seconds of samples")
    bench.forget()
    status = bench.until_status(lost, "the loss of the input")
    assert status.number("samples") >= 2000


def test_another_type_on_the_topic(bench: Bench, peer: Any) -> None:
    from sensor_msgs.msg import Imu

    peer.node.create_publisher(Imu, "torsional_acceleration/block", 10)
    bench.monitor("input.timeout:=0.5")
    status = bench.until_status(lambda s: lost(s) and "as sensor_msgs/msg/Imu" in s.message, "the wrong type")
    assert "/test_peer publishes /torsional_acceleration/block as sensor_msgs/msg/Imu" in status.message
    assert "std_msgs/msg/Float64MultiArray is expected" in status.message


def best_effort() -> Any:
    from rclpy.qos import QoSProfile, QoSReliabilityPolicy

    return QoSProfile(depth=1000, reliability=QoSReliabilityPolicy.BEST_EFFORT)


def test_best_effort_publisher_is_named(bench: Bench, peer: Any) -> None:
    Feeder(peer, qos=best_effort())
    bench.monitor("input.timeout:=0.5")
    bench.until_status(
        lambda s: "/joint_states best-effort: set input.reliability to best_effort" in s.message, "the incompatible QoS"
    )


def test_best_effort_publisher_is_heard_by_best_effort(bench: Bench, peer: Any) -> None:
    feeder = Feeder(peer, qos=best_effort())
    bench.monitor("input.reliability:=best_effort")
    bench.until(feeder.matched, "the monitor's subscriptions")

    def samples_counted() -> bool:
        feeder.send(1)
        return bool(bench.statuses) and bench.statuses[-1].number("samples") >= 500

    bench.until(samples_counted, "samples of a best-effort publisher")


def test_topic_in_another_namespace_is_pointed_at(bench: Bench, peer: Any) -> None:
    Feeder(peer, namespace="arm/")
    bench.monitor("input.timeout:=0.5")
    bench.until_status(lambda s: "but /arm/torsional_acceleration/block exists" in s.message, "the topic's namesake")


def test_joint_that_is_not_in_joint_states(bench: Bench, feeder: Feeder) -> None:
    bench.monitor("input.timeout:=0.5", "joints:=[elbow]")
    bench.until(feeder.matched, "the monitor's subscriptions")

    def named() -> bool:
        feeder.send(1)
        return any("'elbow' is not in joint_states, which carries joint" in s.message for s in bench.statuses)

    bench.until(named, "a complaint about the joint's name")


def test_stamps_of_two_clocks(bench: Bench, peer: Any) -> None:
    vibration, motion = Feeder(peer), Feeder(peer)
    motion._start -= 3600 * 1_000_000_000
    bench.monitor("input.timeout:=0.5")
    bench.until(vibration.matched, "the monitor's subscriptions")
    bench.until(motion.matched, "the monitor's subscriptions")

    def named() -> bool:
        vibration.send(1, motion=False)
        for _ in range(5):
            motion._sequence += 1
        motion.blocks, blocks = _Nowhere(), motion.blocks
        motion.send(1)
        motion.blocks = blocks
        return any("stamp both from one clock" in s.message for s in bench.statuses)

    bench.until(named, "a complaint about the clocks")


class _Nowhere:
    def publish(self, message: Any) -> None:
        """Drop it."""

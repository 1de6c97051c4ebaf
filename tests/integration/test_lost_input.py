"""No input, or one that cannot be heard, is a status that says which topic and why."""

from typing import Any

import pytest

from .conftest import ERROR, OK, QUICK, Bench, Feeder, Shown, feed_until
from .test_verdicts import settled

pytestmark = pytest.mark.ros


HASTY = ("input.timeout:=0.5", "input.startup_timeout:=0.5")


def lost(status: Shown) -> bool:
    return status.fault_code == "HD_INPUT_LOST"


def test_no_publisher_at_all(bench: Bench) -> None:
    bench.monitor(*HASTY)
    status = bench.until_input(lost, "a lost input")
    assert status.level == ERROR
    assert status.name == "/hd_monitor_node: joint input"
    assert "nothing publishes /torsional_acceleration/block (std_msgs/msg/Float64MultiArray)" in status.values["reason"]
    assert "nothing publishes /joint_states (sensor_msgs/msg/JointState)" in status.values["reason"]
    assert status.message.startswith("No joint states and no vibration signal: nothing publishes /joint_states")
    assert {(shown.level, shown.fault_code) for shown in bench.statuses} == {(OK, "HD_WAITING")}


def test_at_first_nothing_is_wrong(bench: Bench) -> None:
    process = bench.monitor("input.startup_warning:=1.5", "input.startup_timeout:=3.5")
    bench.until_input(lost, "a lost input")
    levels = [status.level for status in bench.inputs]
    assert levels == sorted(levels)
    assert all(lost(status) == (status.level == ERROR) for status in bench.inputs)

    def logged() -> list[str]:
        return [line.partition("]")[0] for line in process.output.splitlines() if "joint input: No" in line]

    # On a busy machine the bench may find the node late and miss its first statuses, the log has them all; a line may
    # come later than its status.
    bench.until(lambda: "[ERROR" in logged(), "an error in the log")
    assert logged() == ["[INFO", "[WARN", "[ERROR"]


def test_statuses_continue_without_input(bench: Bench) -> None:
    bench.monitor(*HASTY)
    bench.until(lambda: len(bench.statuses) >= 4, "a status every second")


def test_sensorless_joint_lacks_joint_states_only(bench: Bench) -> None:
    bench.monitor(*HASTY, "input.source:=joint_effort")
    status = bench.until_input(lost, "a lost input")
    assert "/joint_states" in status.message
    assert "torsional_acceleration" not in status.message


def test_a_torque_sensor_that_sends_nothing_is_missed_alone(bench: Bench, feeder: Feeder) -> None:
    bench.monitor(*HASTY, "load.source:=wrench", "load.topic:=ft_sensor/wrench")
    bench.until(feeder.matched, "the monitor's subscriptions")

    def missed() -> bool:
        feeder.send(1)
        return any(
            lost(status)
            and "nothing publishes /ft_sensor/wrench (geometry_msgs/msg/WrenchStamped)" in status.message
            and "joint states" not in status.values["reason"]
            for status in bench.inputs
        )

    bench.until(missed, "a status that misses the torque only")


def test_vibration_without_joint_states(bench: Bench, feeder: Feeder) -> None:
    bench.monitor(*HASTY)
    bench.until(feeder.matched, "the monitor's subscriptions")
    bench.forget()

    def only_motion_is_lost() -> bool:
        feeder.send(1, motion=False)
        return any(
            lost(status)
            and "/joint_states but sends nothing" in status.message
            and "ibration" not in status.values["reason"]
            for status in bench.inputs
        )

    bench.until(only_motion_is_lost, "a status that misses the joint states only")


def test_input_that_ends_is_missed_and_the_verdict_stands_with_its_age(bench: Bench, peer: Any) -> None:
    bench.monitor("input.timeout:=10.0")
    rig = bench.rig("defect:=flexspline", *QUICK)
    settled_verdict = bench.until_status(settled, "a settled verdict")
    bench.stop(rig)
    bench.forget()
    status = bench.until_input(lost, "the loss of the input")
    assert "nothing publishes" in status.message
    reducer = bench.until_status(lambda s: "speed (rpm)" not in s.values, "a status without input")
    assert (reducer.level, reducer.fault_code) == (settled_verdict.level, settled_verdict.fault_code)
    assert reducer.number("evidence age (s)") >= 10.0
    assert reducer.number("samples") >= settled_verdict.number("samples")


def test_another_type_on_the_topic(bench: Bench, peer: Any) -> None:
    from sensor_msgs.msg import Imu

    peer.node.create_publisher(Imu, "torsional_acceleration/block", 10)
    bench.monitor(*HASTY)
    named = "/test_peer publishes /torsional_acceleration/block as sensor_msgs/msg/Imu"
    status = bench.until_input(lambda s: lost(s) and named in s.values["reason"], "the wrong type")
    assert "std_msgs/msg/Float64MultiArray is expected" in status.values["reason"]


def best_effort() -> Any:
    from rclpy.qos import QoSProfile, QoSReliabilityPolicy

    return QoSProfile(depth=1000, reliability=QoSReliabilityPolicy.BEST_EFFORT)


def test_best_effort_publisher_is_named(bench: Bench, peer: Any) -> None:
    Feeder(peer, qos=best_effort())
    bench.monitor(*HASTY)
    bench.until_input(
        lambda s: "/joint_states best-effort: set input.reliability to best_effort" in s.values["reason"],
        "the incompatible QoS",
    )


def test_transient_local_publisher_is_heard(bench: Bench, peer: Any) -> None:
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile

    feeder = Feeder(peer, qos=QoSProfile(depth=1000, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL))
    bench.monitor()
    feed_until(bench, feeder, 1000)
    assert bench.inputs[-1].fault_code == "HD_INPUT_OK"


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
    bench.monitor(*HASTY)
    bench.until_input(
        lambda s: "but /arm/torsional_acceleration/block exists" in s.values["reason"], "the topic's namesake"
    )


def test_joint_that_is_not_in_joint_states(bench: Bench, feeder: Feeder) -> None:
    bench.monitor(*HASTY, "joints:=[elbow]")
    bench.until(feeder.matched, "the monitor's subscriptions")

    def named() -> bool:
        feeder.send(1)
        return any("'elbow' is not in joint_states, which carries joint" in s.values["reason"] for s in bench.inputs)

    bench.until(named, "a complaint about the joint's name")


def test_stamps_of_two_clocks(bench: Bench, peer: Any) -> None:
    vibration, motion = Feeder(peer), Feeder(peer)
    motion._start -= 3600 * 1_000_000_000
    bench.monitor(*HASTY)
    bench.until(vibration.matched, "the monitor's subscriptions")
    bench.until(motion.matched, "the monitor's subscriptions")

    def named() -> bool:
        vibration.send(1, motion=False)
        for _ in range(5):
            motion._sequence += 1
        motion.blocks, blocks = _Nowhere(), motion.blocks
        motion.send(1)
        motion.blocks = blocks
        return any("stamp both from one clock" in s.message for s in bench.inputs)

    bench.until(named, "a complaint about the clocks")


class _Nowhere:
    def publish(self, message: Any) -> None:
        """Drop it."""

"""Parameters as ROS shows, checks and changes them."""

from pathlib import Path
from typing import Any

import pytest
from tests.managed import change_state, set_parameter

from hd_monitor.settings import PARAMETERS

from .conftest import MONITOR, Bench, Feeder, arguments_of, feed_until

pytestmark = pytest.mark.ros

IMPOSSIBLE = {
    "reducer.flexspline_teeth:=161": "the tooth difference 162 - 161 = 1 is odd",
    "reducer.mount:=ceiling": "choose one of: circular_spline_fixed, flexspline_fixed",
    "reducer.flexspline_tooth:=200": "reducer.flexspline_tooth",
    "dynamics.natural_frequency:=fast": "dynamics.natural_frequency = 'fast' has the wrong type",
    "dynamics.damping_ratio:=7.0": "dynamics.damping_ratio = 7.0 is outside [0.0001, 0.7]",
    "diagnosis.warn_index:=0.5": "an error must be worse than a warning",
    "input.source:=ultrasound": "choose one of: block, accel_stamped",
    "joints:=[a, a]": "must be a list of different names",
    "joints:=[left-arm, right]": "call it 'left_arm' there",
    "joints:=[input]": "call it 'input_joint' there",
    "jiont.input.axis:=x": "there is no joint 'jiont', only joint; did you mean joint?",
}


@pytest.mark.parametrize("parameter", IMPOSSIBLE)
def test_an_impossible_parameter_is_one_clear_line_and_status_2(start_module: Any, parameter: str) -> None:
    process = start_module(MONITOR, *arguments_of((parameter,)))
    assert process.wait() == 2
    lines = [line for line in process.output.splitlines() if line.strip()]
    assert len(lines) == 1, process.output
    assert IMPOSSIBLE[parameter] in lines[0]


def test_an_imu_without_a_radius_is_refused_at_the_start(start_module: Any) -> None:
    process = start_module(MONITOR, *arguments_of(("input.source:=imu", "input.sensor_radius:=0.0")))
    assert process.wait() == 2
    assert "give the distance of the IMU from the joint's axis" in process.output
    assert "Traceback" not in process.output


@pytest.mark.parametrize("content", [None, "a: [", "/**:\n  ros__parameters:\n    reducer: {flexspline_teeth: many}\n"])
def test_an_unusable_file_is_refused(start_module: Any, tmp_path: Path, content: str | None) -> None:
    file = tmp_path / "monitor.yaml"
    if content is not None:
        file.write_text(content)
    process = start_module(MONITOR, "--ros-args", "--params-file", str(file))
    assert process.wait() == 2
    assert "Traceback" not in process.output
    assert process.output.strip()


def test_a_shared_file_may_hold_what_belongs_to_other_nodes(bench: Bench, start_module: Any, tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n    defect: flexspline\n    sensor: {rate: 2000.0}\n"
        "    dynamics: {natural_frequency: 60}\n    reducer: {serial: A7}\n"
    )
    process = start_module(MONITOR, "--ros-args", "--params-file", str(file))
    status = bench.until_status(lambda s: True, "a status")
    assert status.hardware_id == "A7"
    assert "ignoring defect, sensor.rate" in process.output


def test_limits_change_at_run_time(bench: Bench, peer: Any, feeder: Feeder) -> None:
    bench.monitor("diagnosis.error_index:=0.2")
    bench.until(feeder.matched, "the monitor's subscriptions")
    result = set_parameter(peer, "hd_monitor_node", "diagnosis.warn_index", 0.12)
    assert result.successful, result.reason

    def in_force() -> bool:
        feeder.send(2)
        return any(status.values["warn limit (%)"] == "12.000" for status in bench.statuses)

    bench.until(in_force, "the new limit in a status")


def test_what_cannot_be_is_rejected_with_the_reason(bench: Bench, peer: Any) -> None:
    bench.monitor()
    for name, value, reason in (
        ("diagnosis.warn_index", 0.5, "an error must be worse than a warning"),
        ("diagnosis.warn_index", 5.0, "range"),
        ("diagnosis.confirm_count", 50, "can never be reached"),
        ("reducer.mount", "flexspline_fixed", "deactivate the node, set reducer.mount"),
        ("load.torque", 0, "deactivate the node"),
        ("joints", ["elbow"], "read-only"),
        ("diagnosis.latch", "yes", "type"),
    ):
        result = set_parameter(peer, "hd_monitor_node", name, value)
        assert not result.successful, (name, value)
        assert reason in result.reason.lower()
    bench.forget()
    bench.until(lambda: bench.statuses, "a status: the node lives on")


def test_every_parameter_is_described_with_unit_and_range(bench: Bench, peer: Any) -> None:
    from rcl_interfaces.srv import DescribeParameters

    bench.monitor()
    names = [parameter.name for parameter in PARAMETERS]
    response = peer.call(
        DescribeParameters, "hd_monitor_node/describe_parameters", DescribeParameters.Request(names=names)
    )
    for parameter, descriptor in zip(PARAMETERS, response.descriptors, strict=True):
        assert parameter.description in descriptor.description
        assert parameter.unit in descriptor.description
        assert not descriptor.read_only
        if isinstance(parameter.default, float):
            bounds = descriptor.floating_point_range[0]
            assert (bounds.from_value, bounds.to_value) == (parameter.low, parameter.high)
        elif isinstance(parameter.default, int) and not isinstance(parameter.default, bool):
            bounds = descriptor.integer_range[0]
            assert (bounds.from_value, bounds.to_value) == (parameter.low, parameter.high)
        for word in parameter.choices:
            assert word in descriptor.additional_constraints


def test_with_several_joints_each_has_its_own(bench: Bench, peer: Any) -> None:
    from rcl_interfaces.srv import GetParameters

    bench.monitor("joints:=[a, b]", "load.torque:=7.0", "b.load.torque:=3.0")
    names = ["load.torque", "a.load.torque", "b.load.torque"]
    response = peer.call(GetParameters, "hd_monitor_node/get_parameters", GetParameters.Request(names=names))
    assert [value.double_value for value in response.values] == [7.0, 7.0, 3.0]

    def warn_limits() -> list[float]:
        names = ["diagnosis.warn_index", "a.diagnosis.warn_index", "b.diagnosis.warn_index"]
        response = peer.call(GetParameters, "hd_monitor_node/get_parameters", GetParameters.Request(names=names))
        return [value.double_value for value in response.values]

    assert set_parameter(peer, "hd_monitor_node", "b.diagnosis.warn_index", 0.03).successful
    assert warn_limits() == [0.05, 0.05, 0.03]
    assert set_parameter(peer, "hd_monitor_node", "diagnosis.warn_index", 0.04).successful
    assert warn_limits() == [0.04, 0.04, 0.03]
    bench.forget()
    a = bench.until_status(lambda s: s.values["joint"] == "a", "a status of a")
    b = bench.until_status(lambda s: s.values["joint"] == "b", "a status of b")
    assert [shown.values["warn limit (%)"] for shown in (a, b)] == ["4.000", "3.000"]
    refused = set_parameter(peer, "hd_monitor_node", "diagnosis.warn_index", 0.5)
    assert "an error must be worse" in refused.reason
    assert warn_limits() == [0.04, 0.04, 0.03]


def test_a_whole_number_will_do_for_a_real_one(bench: Bench) -> None:
    bench.monitor("dynamics.natural_frequency:=60", "input.timeout:=1")
    bench.until(lambda: bench.statuses, "a status")


def test_a_whole_number_will_do_for_a_real_one_at_run_time(bench: Bench, peer: Any) -> None:
    bench.monitor()
    for name, value in (("input.timeout", 7), ("diagnosis.error_index", 1), ("load.torque", -3)):
        result = set_parameter(peer, "hd_monitor_node", name, value)
        assert result.successful, result.reason
    assert not set_parameter(peer, "hd_monitor_node", "diagnosis.confirm_count", 1.0).successful


def test_an_inactive_node_takes_any_parameter_and_starts_that_joint_anew(
    bench: Bench, peer: Any, feeder: Feeder
) -> None:
    bench.monitor()
    feed_until(bench, feeder, 1000)
    assert change_state(peer, "hd_monitor_node", "deactivate")
    for name, value in (("reducer.serial", "B8"), ("dynamics.inertia", 1), ("input.startup_timeout", 60.0)):
        result = set_parameter(peer, "hd_monitor_node", name, value)
        assert result.successful, result.reason
    assert not set_parameter(peer, "hd_monitor_node", "reducer.flexspline_teeth", 161).successful
    bench.forget()
    assert change_state(peer, "hd_monitor_node", "activate")
    status = bench.until_status(lambda s: True, "a status")
    assert (status.hardware_id, status.number("samples")) == ("B8", 0)


def test_limits_set_while_inactive_keep_the_evidence(bench: Bench, peer: Any, feeder: Feeder) -> None:
    bench.monitor()
    feed_until(bench, feeder, 1000)
    assert change_state(peer, "hd_monitor_node", "deactivate")
    assert set_parameter(peer, "hd_monitor_node", "diagnosis.warn_index", 0.06).successful
    bench.forget()
    assert change_state(peer, "hd_monitor_node", "activate")
    status = bench.until_status(lambda s: True, "a status")
    assert status.values["warn limit (%)"] == "6.000"
    assert status.number("samples") >= 1000


@pytest.mark.parametrize("topic", ["accelerometer/block", "/cell/accelerometer"])
def test_the_vibration_may_have_any_topic_and_another_at_run_time(bench: Bench, peer: Any, topic: str) -> None:
    bench.monitor(f"input.topic:={topic}", "reducer.serial:=A7")
    one = Feeder(peer, block_topic=topic)
    feed_until(bench, one, 1000)
    assert set_parameter(peer, "hd_monitor_node", "input.topic", "elsewhere").successful
    bench.until_input(lambda s: "elsewhere" in s.message, "what is awaited now")
    other = Feeder(peer, block_topic="elsewhere")
    feed_until(bench, other, int(bench.statuses[-1].number("samples")) + 1000)

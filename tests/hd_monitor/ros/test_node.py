"""The node in this process, where its parts can be made to fail."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

pytestmark = pytest.mark.ros


@pytest.fixture
def make_node(ros_context: Any, peer: Any) -> Iterator[Callable[..., Any]]:
    nodes: list[Any] = []

    def make(**parameters: Any) -> Any:
        from rclpy.parameter import Parameter

        from hd_monitor.ros.node import HdMonitorNode

        overrides = [Parameter(name.replace("__", "."), value=value) for name, value in parameters.items()]
        node = HdMonitorNode(context=ros_context, parameter_overrides=overrides)
        peer.executor.add_node(node)
        nodes.append(node)
        return node

    yield make
    for node in nodes:
        peer.executor.remove_node(node)
        node.destroy_node()


def statuses_of(arrays: list[Any], joint: str) -> list[dict[str, str]]:
    found = [{pair.key: pair.value for pair in status.values} for array in arrays for status in array.status]
    return [values for values in found if values["joint"] == joint]


def test_an_error_in_one_joint_leaves_node_and_other_joint_alive(make_node: Callable[..., Any], peer: Any) -> None:
    from diagnostic_msgs.msg import DiagnosticArray

    def fail() -> Any:
        raise RuntimeError("made for the test")

    arrays = peer.collect(DiagnosticArray, "/diagnostics", match=False)
    node = make_node(joints=["bad", "good"])
    broken = node._channels["bad"]
    broken.watch._monitor.advance = fail
    peer.until(
        lambda: any(values["fault_code"] == "HD_INTERNAL_ERROR" for values in statuses_of(arrays, "bad")),
        "the error in a status",
    )
    count = len(statuses_of(arrays, "good"))
    peer.until(lambda: len(statuses_of(arrays, "good")) > count + 1, "statuses of the other joint")
    assert all(values["fault_code"] != "HD_INTERNAL_ERROR" for values in statuses_of(arrays, "good"))


def test_a_failing_request_is_answered(make_node: Callable[..., Any], peer: Any) -> None:
    from std_srvs.srv import Trigger

    def fail() -> None:
        raise RuntimeError("made for the test")

    node = make_node()
    node._channels["joint"].watch.reset = fail
    response = peer.call(Trigger, "hd_monitor_node/reset", Trigger.Request())
    assert not response.success
    assert response.message == "RuntimeError: made for the test"


def test_requests_for_one_joint_of_several(make_node: Callable[..., Any], peer: Any) -> None:
    from std_srvs.srv import Trigger

    make_node(joints=["left", "right"])
    assert peer.call(Trigger, "hd_monitor_node/reset", Trigger.Request()).message == "done for left, right"
    assert peer.call(Trigger, "hd_monitor_node/left/reset_latch", Trigger.Request()).message == "done for left"


def test_parameters_are_refused_by_the_cores_own_error(make_node: Callable[..., Any]) -> None:
    from hd_monitor.errors import GeometryError, ParameterError

    with pytest.raises(GeometryError, match="is odd"):
        make_node(reducer__flexspline_teeth=161)
    with pytest.raises(ParameterError, match="IMU"):
        make_node(input__source="imu", input__sensor_radius=0.0)

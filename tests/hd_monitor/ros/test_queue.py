"""Queues have the depth requested, as far as the middleware allows."""

import os
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.ros


def test_a_queue_holds_the_requested_seconds_and_at_least_a_few_messages() -> None:
    from hd_monitor.ros.queue import queue_depth

    assert queue_depth(200.0, 2.5) == 500
    assert queue_depth(1.0, 0.1) == 10


def test_without_a_known_limit_a_queue_is_as_deep_as_requested(monkeypatch: pytest.MonkeyPatch) -> None:
    import rclpy

    from hd_monitor.ros.queue import queue_depth

    monkeypatch.setattr(rclpy, "get_rmw_implementation_identifier", lambda: "rmw_cyclonedds_cpp")
    assert queue_depth(1000.0, 20.0) == 20_000


@pytest.mark.parametrize("own", [{}, {"FASTDDS_DEFAULT_PROFILES_FILE": "mine.xml"}], ids=["none", "of the user"])
def test_the_profile_that_returns_memory_gives_way_to_the_users_own(
    own: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from hd_monitor.ros.queue import return_memory

    monkeypatch.setattr(os, "environ", dict(own))
    return_memory()
    if own:
        assert os.environ == own
    else:
        assert os.environ["RMW_FASTRTPS_USE_QOS_FROM_XML"] == "1"
        content = Path(os.environ["FASTRTPS_DEFAULT_PROFILES_FILE"]).read_text(encoding="utf-8")
        assert "<historyMemoryPolicy>DYNAMIC<" in content


def test_the_deepest_queue_still_drops_the_oldest_message_and_not_the_newest(peer: Any) -> None:
    from std_msgs.msg import Float64MultiArray

    from hd_monitor.cdr import decode_multi_arrays
    from hd_monitor.ros.queue import most_messages, queue_depth
    from hd_monitor.ros.subscriptions import DrainedSubscription

    depth = queue_depth(1000.0, 60.0)
    if depth != most_messages():
        pytest.skip("this middleware knows no limit")
    subscription = DrainedSubscription(
        peer.node, "numbers", "std_msgs/Float64MultiArray", depth=depth, reliability="reliable"
    )
    publisher = peer.publisher(Float64MultiArray, "numbers")
    sent = depth + 500
    for number in range(sent):
        publisher.publish(Float64MultiArray(data=[float(number)]))
    received: list[bytes] = []

    def newest() -> float:
        received.extend(subscription.drain())
        groups, _ = decode_multi_arrays(received[-1:])
        return float(groups[0].data[0, 0]) if groups else -1.0

    peer.until(lambda: newest() == sent - 1, "the newest message")


def test_the_node_warns_of_a_queue_that_cannot_be_so_deep(start_module: Any, peer: Any) -> None:
    from hd_monitor.ros.queue import most_messages

    node = start_module("hd_monitor.ros", "--ros-args", "-p", "input.queue_seconds:=60.0")
    peer.until(lambda: "watching joint" in node.output, "the node")
    warned = "the queues hold 5 s; reduce it" in node.output
    assert warned == (most_messages() < 60_000)
    assert node.interrupt() == 0

"""The polled subscription: nothing reaches an executor, nothing is lost, nothing comes out of order."""

from types import SimpleNamespace
from typing import Any

import pytest

from hd_monitor.cdr import decode_vectors

pytestmark = pytest.mark.ros

TOPIC, KIND = "torsional_acceleration", "geometry_msgs/AccelStamped"


def drained(peer: Any, depth: int) -> Any:
    from hd_monitor.ros.subscriptions import DrainedSubscription

    return DrainedSubscription(peer.node, TOPIC, KIND, depth=depth, reliability="reliable")


def publish(publisher: Any, first: int, count: int) -> None:
    from geometry_msgs.msg import AccelStamped

    message = AccelStamped()
    for number in range(first, first + count):
        message.header.stamp.nanosec = number
        message.accel.angular.z = float(number)
        publisher.publish(message)


def test_messages_are_taken_in_their_order(peer: Any) -> None:
    from geometry_msgs.msg import AccelStamped

    subscription = drained(peer, 1000)
    publisher = peer.publisher(AccelStamped, "torsional_acceleration")
    publish(publisher, 0, 700)
    received: list[bytes] = []

    def complete() -> bool:
        received.extend(subscription.drain())
        return len(received) >= 700

    peer.until(complete, "700 messages")
    samples = decode_vectors(received)
    assert samples.stamps.tolist() == list(range(700))
    assert samples.angular[:, 2].tolist() == [float(number) for number in range(700)]
    assert subscription.drain() == []


def test_a_queue_that_runs_over_keeps_the_newest(peer: Any) -> None:
    from geometry_msgs.msg import AccelStamped

    subscription = drained(peer, 20)
    publisher = peer.publisher(AccelStamped, "torsional_acceleration")
    publish(publisher, 0, 100)
    received: list[bytes] = []

    def complete() -> bool:
        received.extend(subscription.drain())
        return bool(received) and decode_vectors(received[-1:]).stamps[0] == 99

    peer.until(complete, "the newest message")
    stamps = decode_vectors(received).stamps.tolist()
    assert stamps == sorted(set(stamps))


def test_large_messages_are_taken_one_after_the_other(peer: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from geometry_msgs.msg import AccelStamped

    from hd_monitor.ros import subscriptions

    monkeypatch.setattr(subscriptions, "MOST_AT_ONCE", 1)
    subscription = drained(peer, 20)
    publish(peer.publisher(AccelStamped, "torsional_acceleration"), 0, 3)
    taken: list[int] = []

    def complete() -> bool:
        taken.append(len(subscription.drain()))
        return sum(taken) == 3

    peer.until(complete, "3 messages")
    assert max(taken) == 1


def test_the_executor_never_sees_it(peer: Any) -> None:
    from hd_monitor.ros.subscriptions import PolledGroup

    subscription = drained(peer, 10)
    entity = next(s for s in peer.node.subscriptions if s.topic_name == subscription.topic)
    assert isinstance(entity.callback_group, PolledGroup)
    assert not peer.executor.can_execute(entity)


def test_it_leaves_the_topic(peer: Any) -> None:
    from geometry_msgs.msg import AccelStamped

    subscription = drained(peer, 10)
    publisher = peer.publisher(AccelStamped, "torsional_acceleration")
    subscription.close()
    peer.until(lambda: not publisher.get_subscription_count(), "the end of the subscription")


def test_a_silent_publisher_is_named(peer: Any) -> None:
    from geometry_msgs.msg import AccelStamped

    subscription = drained(peer, 10)
    assert subscription.explain_silence() == (
        "nothing publishes /torsional_acceleration (geometry_msgs/msg/AccelStamped)"
    )
    peer.publisher(AccelStamped, "torsional_acceleration")
    peer.until(
        lambda: subscription.explain_silence() == "/test_peer publishes /torsional_acceleration but sends nothing",
        "the publisher in the graph",
    )


def test_several_publishers_are_named(peer: Any) -> None:
    from geometry_msgs.msg import AccelStamped

    subscription = drained(peer, 10)
    peer.publisher(AccelStamped, "torsional_acceleration")
    assert subscription.explain_crowd() == ""
    peer.publisher(AccelStamped, "torsional_acceleration")
    expected = "two publishers on /torsional_acceleration: /test_peer, /test_peer"
    peer.until(lambda: subscription.explain_crowd() == expected, "both publishers in the graph")


def test_a_publisher_whose_node_is_not_known_yet_gets_no_made_up_name(peer: Any, monkeypatch: Any) -> None:
    """The middleware learns of a publisher a little before it learns its node's name."""
    unknown = SimpleNamespace(
        node_name="_NODE_NAME_UNKNOWN_", node_namespace="_NODE_NAMESPACE_UNKNOWN_", topic_type="sensor_msgs/msg/Imu"
    )
    subscription = drained(peer, 20)
    monkeypatch.setattr(peer.node, "get_publishers_info_by_topic", lambda _: [unknown])
    assert subscription.explain_silence().startswith(
        "a node not known by name yet publishes /torsional_acceleration as"
    )

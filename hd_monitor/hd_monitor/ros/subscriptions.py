"""Subscriptions that are polled, since an executor's wait set costs far more than a small message.

An executor spends more than half a millisecond of CPU on waking up for one message, so a topic of a thousand a second
takes most of a core. Here the subscription never enters the wait set; its queue, seconds deep, is emptied from a timer
for a few microseconds a message, and the messages stay serialised until numpy decodes them all at once.
"""

from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSCompatibility, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy, qos_check_compatible

from .definitions import class_of


class PolledGroup(CallbackGroup):
    """A callback group whose members no executor waits for."""

    def can_execute(self, entity: Any) -> bool:
        """Keep the entity out of every wait set."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Refuse: nothing of this group is executed."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Nothing to do: nothing of this group is executed."""


MOST_AT_ONCE = 20_000_000
"""Bytes taken from a queue before other work has its turn."""

_UNNAMED = "_NODE_NAME_UNKNOWN_"
"""What the middleware calls the node of a publisher whose name has not reached it yet."""


class DrainedSubscription:
    """A subscription whose queue of serialised messages is taken on request.

    Parameters
    ----------
    node : Node
    topic : str
        Relative to the node's namespace.
    kind : str
        Message type, as ``package/Type``.
    depth : int
        Messages that may wait in the queue.
    reliability : str
        ``'reliable'`` or ``'best_effort'``.
    """

    def __init__(self, node: Node, topic: str, kind: str, *, depth: int, reliability: str) -> None:
        self._node = node
        self._request = (topic, kind, depth, reliability)
        self.kind = kind
        self._type = class_of(kind)
        self._depth = depth
        self._qos = QoSProfile(
            history=QoSHistoryPolicy.KEEP_LAST,
            depth=depth,
            reliability=QoSReliabilityPolicy.get_from_short_key(reliability),
        )
        self._subscription = node.create_subscription(
            self._type, topic, lambda _: None, self._qos, callback_group=PolledGroup(), raw=True
        )  # rclpy requires a callback; the group keeps it from being called
        self._type_name = kind.replace("/", "/msg/")
        self.topic: str = self._subscription.topic_name

    def drain(self) -> list[bytes]:
        """Take the queue's messages, at most one queue's depth at a time, and not much more than `MOST_AT_ONCE`."""
        messages: list[bytes] = []
        size = 0
        handle = self._subscription.handle
        with handle:
            take, kind = handle.take_message, self._type
            while len(messages) < self._depth and size < MOST_AT_ONCE and (taken := take(kind, True)) is not None:
                messages.append(taken[0])
                size += len(taken[0])
        return messages

    def matches(self, topic: str, kind: str, *, depth: int, reliability: str) -> bool:
        """Whether it is what these arguments would create."""
        return self._request == (topic, kind, depth, reliability)

    def close(self) -> None:
        """Leave the topic."""
        self._node.destroy_subscription(self._subscription)

    def explain_silence(self) -> str:
        """Say, from the ROS graph, why nothing comes."""
        publishers = self._node.get_publishers_info_by_topic(self.topic)
        if not publishers:
            return f"nothing publishes {self.topic} ({self._type_name}){self._namesakes()}"
        of_type = [publisher for publisher in publishers if publisher.topic_type == self._type_name]
        if not of_type:
            return (
                f"{_name(publishers[0])} publishes {self.topic} as {publishers[0].topic_type}, "
                f"but {self._type_name} is expected"
            )
        for publisher in of_type:
            compatibility, _ = qos_check_compatible(publisher.qos_profile, self._qos)
            if compatibility != QoSCompatibility.ERROR:
                return f"{_name(publisher)} publishes {self.topic} but sends nothing"
        if of_type[0].qos_profile.reliability == QoSReliabilityPolicy.BEST_EFFORT:
            return f"{_name(of_type[0])} publishes {self.topic} best-effort: set input.reliability to best_effort"
        return f"{_name(of_type[0])} publishes {self.topic} with an incompatible QoS"

    def explain_crowd(self) -> str:
        """Name the publishers where there are several, whose messages nobody can tell from each other; else empty."""
        if self._node.count_publishers(self.topic) < 2:
            return ""
        names = sorted(map(_name, self._node.get_publishers_info_by_topic(self.topic)))
        count = "two" if len(names) == 2 else len(names)
        return f"{count} publishers on {self.topic}: {', '.join(names)}"

    def _namesakes(self) -> str:
        """Name a topic of the same type and last name that does have a publisher: a namespace may be wrong."""
        last = self.topic.rpartition("/")[2]
        for topic, types in self._node.get_topic_names_and_types():
            alike = topic != self.topic and topic.rpartition("/")[2] == last and self._type_name in types
            if alike and self._node.count_publishers(topic):
                return f", but {topic} exists: is the namespace or a remapping wrong?"
        return ""


def subscribed(
    before: DrainedSubscription | None, node: Node, topic: str, kind: str, *, depth: int, reliability: str
) -> DrainedSubscription:
    """Return a subscription of this kind: the one there is `before`, if it is one, else a new one in its place."""
    if before is not None:
        if before.matches(topic, kind, depth=depth, reliability=reliability):
            return before
        before.close()
    return DrainedSubscription(node, topic, kind, depth=depth, reliability=reliability)


def _name(endpoint: Any) -> str:
    if endpoint.node_name == _UNNAMED:
        return "a node not known by name yet"
    return f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}"

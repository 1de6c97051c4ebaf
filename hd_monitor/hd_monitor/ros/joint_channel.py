"""One joint's topics: its vibration subscription, its publishers, and the watch between them."""

from collections.abc import Sequence

from rclpy.lifecycle import LifecycleNode, LifecyclePublisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64MultiArray

from .. import contract
from ..adapters import VIBRATION_SOURCES, Source
from ..settings import JointSettings
from .joint_watch import VIBRATION, Explain, JointWatch
from .messages import rms_message, zoom_message
from .queue import most_messages, queue_depth
from .subscriptions import DrainedSubscription


def queue_depth_of(settings: JointSettings) -> int:
    """Messages that the queues of a joint's inputs hold."""
    return queue_depth(settings.input.expected_rate, settings.input.queue_seconds)


class JointChannel:
    """Connects a joint's watch with its topics.

    Parameters
    ----------
    node : LifecycleNode
    joint : str
    settings : JointSettings
    several : bool
        Whether the node watches several joints, so that the topics stand below the joint's name.
    now : int
        The node's time [ns].

    Attributes
    ----------
    watch : JointWatch
    """

    def __init__(self, node: LifecycleNode, joint: str, settings: JointSettings, several: bool, now: int) -> None:
        self._node = node
        self._prefix = f"{joint}/" if several else ""
        self._vibration: DrainedSubscription | None = None
        self._zoom = self._advertise(contract.ZOOM_SPECTRUM)
        self._rms = self._advertise(contract.RMS_CURVE)
        self.joint = joint
        self.watch = JointWatch(joint, settings, now)

    def _advertise(self, topic: str) -> LifecyclePublisher:
        qos = QoSProfile(depth=10)
        publisher: LifecyclePublisher = self._node.create_lifecycle_publisher(
            Float64MultiArray, f"{self._prefix}{topic}", qos
        )
        return publisher

    @property
    def settings(self) -> JointSettings:
        """The joint's settings in force."""
        return self.watch.settings

    @property
    def _source(self) -> Source | None:
        source = VIBRATION_SOURCES.get(self.settings.input.source)
        return None if source is None else Source(f"{self._prefix}{source.topic}", source.type)

    @property
    def topics(self) -> list[str]:
        """Topic that the joint alone listens to; none while closed or without a sensor."""
        return [] if self._vibration is None else [self._vibration.topic]

    def open(self, now: int) -> None:
        """Subscribe; silence counts from `now` [ns]."""
        self._warn_of_short_queue()
        source = self._source
        if source is not None:
            self._vibration = DrainedSubscription(
                self._node,
                source,
                depth=queue_depth_of(self.settings),
                reliability=self.settings.input.reliability,
            )
        self.watch.wake(now)

    def _warn_of_short_queue(self) -> None:
        rate, seconds = self.settings.input.expected_rate, self.settings.input.queue_seconds
        most = most_messages()
        if rate * seconds > most:
            self._node.get_logger().warning(
                f"{self.joint}: input.queue_seconds = {seconds:g} s at input.expected_rate = {rate:g} Hz are more than "
                f"the {most:g} messages that Fast DDS keeps: the queues hold {most / rate:.3g} s; ask for less, or "
                "send blocks instead of single samples"
            )

    def close(self) -> None:
        """Leave the topics."""
        if self._vibration is not None:
            self._vibration.close()
            self._vibration = None

    def destroy(self) -> None:
        """Take back what is advertised."""
        self._node.destroy_lifecycle_publisher(self._zoom)
        self._node.destroy_lifecycle_publisher(self._rms)

    def feed(self, motion: Sequence[bytes], now: int, explain_motion: Explain) -> None:
        """Hand the joint's new messages to its watch; publish the curves where that led to a new assessment."""
        vibration = self._vibration.drain() if self._vibration is not None else []
        if self.watch.feed(vibration, motion, now, self._explain(explain_motion)):
            self._publish_curves()

    def check(self, now: int, explain_motion: Explain) -> None:
        """Look for lost inputs."""
        self.watch.check(now, self._explain(explain_motion))

    def change_limits(self, settings: JointSettings) -> None:
        """Put other ``diagnosis.*`` parameters in force."""
        self.watch.change_limits(settings)

    def _explain(self, explain_motion: Explain) -> Explain:
        def explain(name: str) -> str:
            if name == VIBRATION and self._vibration is not None:
                return self._vibration.explain_silence()
            return explain_motion(name)

        return explain

    def _publish_curves(self) -> None:
        if (zoom := self.watch.zoom()) is not None:
            self._zoom.publish(zoom_message(zoom))
        if (curve := self.watch.present.rms_curve).bins:
            self._rms.publish(rms_message(curve))

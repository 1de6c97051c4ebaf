"""One joint's topics: its own subscriptions, its publishers, and the watch between them."""

from collections.abc import Sequence

from rclpy.lifecycle import LifecycleNode, LifecyclePublisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64, Float64MultiArray

from .. import contract
from ..errors import OutputError, ParameterError
from ..history.mcap import Channel
from ..history.snapshot import Snapshots
from ..reducer import LinePair
from ..settings import JointSettings, check_change
from ..sources import Quantity
from .definitions import definition_of
from .joint_watch import JointWatch
from .memory import Memory
from .messages import readings_of, rms_message, zoom_message
from .queue import most_messages, queue_depth
from .subscriptions import DrainedSubscription, subscribed


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
        Whether the node watches several joints, so that the topics are below the joint's name.
    now : int
        The node's time [ns].

    Attributes
    ----------
    watch : JointWatch
    """

    def __init__(self, node: LifecycleNode, joint: str, settings: JointSettings, several: bool, now: int) -> None:
        self._node = node
        self._below = joint if several else None
        self._subscriptions: dict[Quantity, DrainedSubscription] = {}
        self._motion: DrainedSubscription | None = None
        self._zoom = self._advertise(contract.ZOOM_SPECTRUM)
        self._rms = self._advertise(contract.RMS_CURVE)
        self._baseline = self._advertise(contract.RMS_BASELINE)
        self._readings = {
            (topic := f"{part}/{name}"): self._advertise(topic, Float64)
            for part in LinePair._fields
            for name in contract.READINGS
        }
        self.joint = joint
        memory = Memory(joint, settings, node.get_logger().error) if settings.history.path else None
        self.watch = JointWatch(joint, settings, now, self._explain, self._explain_crowd, memory, self._date)
        remembers = bool(settings.history.path)
        self._snapshots = Snapshots(joint, settings, self.watch.present.verdict.level) if remembers else None

    def _advertise(self, topic: str, kind: type = Float64MultiArray) -> LifecyclePublisher:
        publisher: LifecyclePublisher = self._node.create_lifecycle_publisher(
            kind, topic if self._below is None else f"{self._below}/{topic}", QoSProfile(depth=10)
        )
        return publisher

    @property
    def topics(self) -> list[str]:
        """Topics that the joint alone listens to; none while closed or without a sensor."""
        return [subscription.topic for subscription in self._subscriptions.values()]

    def open(self, motion: DrainedSubscription, now: int) -> None:
        """Subscribe to what is the joint's own, `motion` being all joints'; silence counts from `now` [ns]."""
        self.watch.wake(now)
        self.listen(motion, now)

    def change(self, settings: JointSettings) -> bool:
        """Put other settings in force; return False if that takes a new channel, which has to learn all anew."""
        try:
            check_change(self.watch.settings, settings)
        except ParameterError:
            return False
        self.watch.change(settings)
        return True

    def listen(self, motion: DrainedSubscription, now: int) -> None:
        """Subscribe as the settings say; what is subscribed in that way already stays."""
        self._motion = motion
        self._warn_of_short_queue()
        settings = self.watch.settings
        wanted = dict(settings.all_sources)
        del wanted[Quantity.MOTION]
        for quantity in self._subscriptions.keys() - wanted.keys():
            self._subscriptions.pop(quantity).close()
        for quantity, source in wanted.items():
            before = self._subscriptions.get(quantity)
            self._subscriptions[quantity] = subscribed(
                before,
                self._node,
                source.name_below(self._below),
                source.type,
                depth=queue_depth_of(settings),
                reliability=settings.input.reliability,
            )
            if self._subscriptions[quantity] is not before:
                self.watch.await_anew(quantity, now)

    def _warn_of_short_queue(self) -> None:
        rate, seconds = self.watch.settings.input.expected_rate, self.watch.settings.input.queue_seconds
        most = most_messages()
        if rate * seconds > most:
            self._node.get_logger().warning(
                f"{self.joint}: input.queue_seconds = {seconds:g} s at input.expected_rate = {rate:g} Hz are more than "
                f"the {most:g} messages that Fast DDS keeps: the queues hold {most / rate:.3g} s; reduce it, or "
                "send blocks instead of single samples"
            )

    def close(self) -> None:
        """Leave the topics."""
        for subscription in self._subscriptions.values():
            subscription.close()
        self._subscriptions = {}
        self._motion = None

    def destroy(self) -> None:
        """Destroy the publishers, and close the ledger."""
        self.watch.close()
        for publisher in (self._zoom, self._rms, self._baseline, *self._readings.values()):
            self._node.destroy_lifecycle_publisher(publisher)

    def feed(self, motion: Sequence[bytes], now: int) -> None:
        """Hand the joint's new messages to its watch; publish numbers and curves where that led to a new assessment."""
        messages = {Quantity.MOTION: motion}
        messages |= {quantity: subscription.drain() for quantity, subscription in self._subscriptions.items()}
        if self._snapshots is not None:
            self._snapshots.recent.add(round(self._date() * contract.NANOSECONDS), messages)
        if self.watch.feed(messages, now):
            self._publish_numbers()
            self._take_snapshot()

    def _take_snapshot(self) -> None:
        """Write what led to a warning or an error, where that is news and there is a ledger."""
        present = self.watch.present
        if self._snapshots is None or not self._snapshots.is_due(present.verdict.level):
            return
        heard = dict(self._subscriptions)
        if self._motion is not None:
            heard[Quantity.MOTION] = self._motion
        channels = {
            quantity: Channel(one.topic, one.kind.replace("/", "/msg/"), definition_of(one.kind))
            for quantity, one in heard.items()
        }
        logger = self._node.get_logger()
        try:
            logger.info(f"{self.joint}: snapshot written to {self._snapshots.write(present, channels)}")
        except OutputError as error:  # costs the snapshot, never the verdict
            logger.error(f"{self.joint}: {error}")

    def _date(self) -> float:
        return float(self._node.get_clock().now().nanoseconds) / contract.NANOSECONDS

    def _explain(self, quantity: Quantity) -> str:
        subscription = self._subscriptions.get(quantity, self._motion)
        return subscription.explain_silence() if subscription is not None else ""

    def _explain_crowd(self) -> str:
        crowds = (subscription.explain_crowd() for subscription in self._subscriptions.values())
        return "; ".join(filter(None, crowds))

    def _publish_numbers(self) -> None:
        if (found := self.watch.present.identification) is not None:
            for topic, value in readings_of(found).items():
                self._readings[topic].publish(Float64(data=value))
        if (zoom := self.watch.zoom()) is not None:
            self._zoom.publish(zoom_message(zoom))
        if curve := self.watch.present.rms_curve:
            self._rms.publish(rms_message(curve))
        if curve := self.watch.baseline_curve:
            self._baseline.publish(rms_message(curve))

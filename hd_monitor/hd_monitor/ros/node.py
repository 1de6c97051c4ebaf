"""The node ``hd_monitor_node``: any number of joints, from their topics to /diagnostics."""

from collections.abc import Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from diagnostic_msgs.srv import SelfTest
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger

from .. import contract
from ..diagnosis.status import Status
from ..diagnosis.verdict import Level
from ..errors import HdMonitorError
from ..process import trim_memory
from ..sources import JOINT_STATES, Quantity
from .joint_channel import JointChannel, queue_depth_of
from .managed_node import ManagedNode, logged, run
from .messages import diagnostic_status
from .parameters import JointParameters
from .queue import return_memory
from .status_log import StatusLog
from .subscriptions import DrainedSubscription, subscribed

NAME = "hd_monitor_node"
DRAIN_PERIOD = 0.2
"""Seconds between two looks into the queues: the largest delay of a verdict. Each costs an executor half a millisecond,
and more with the services of many joints, whether anything has come or not."""
STATUS_PERIOD = 1.0
"""Seconds between two statuses (REP-107)."""
TRIM_PERIOD = 10.0
"""Seconds after which memory that nothing needs any more goes back to the system; it takes a millisecond."""


class HdMonitorNode(ManagedNode):
    """Watches the reducers of the joints that its parameters name.

    Configured, it has a monitor for every joint; active, it listens and publishes. Being deactivated keeps the
    evidence, being cleaned up drops it.

    Parameters
    ----------
    **options
        Passed on to the base class: ``context``, ``namespace``, ``parameter_overrides`` …

    Raises
    ------
    ParameterError, GeometryError
        If a parameter is impossible; the message says which, why and what to do.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(NAME, **options)
        self._channels: dict[str, JointChannel] = {}
        self._motion: DrainedSubscription | None = None
        self._watched = ""
        self._own_timers: list[Any] = []
        self._own_services: list[Any] = []
        self._log = StatusLog(self.get_logger())
        self._parameters_of_joints = JointParameters(self, self._is_active, self._change)
        self._diagnostics = self.create_lifecycle_publisher(DiagnosticArray, contract.DIAGNOSTICS, QoSProfile(depth=10))
        if self.get_parameter("autostart").value:
            self.bring_up()

    # Lifecycle ------------------------------------------------------------------------------------------------------

    @logged
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make a monitor for every joint, with its publishers and services."""
        try:
            self._follow_parameters()
        except HdMonitorError as error:
            self.dismantle()
            return self.refuse(error)
        self._own_services.append(self.create_service(SelfTest, "~/self_test", self._report))
        joints = list(self._channels)
        for action in ("reset_latch", "reset", "set_baseline"):
            self._offer(f"~/{action}", action, joints)
            if len(joints) > 1:
                for joint in joints:
                    self._offer(f"~/{joint}/{action}", action, [joint])
        return super().on_configure(state)

    @logged
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Subscribe, and start looking into the queues."""
        try:
            self._follow_parameters()
        except HdMonitorError as error:
            return self.refuse(error)
        self._motion = self._subscribed_motion()
        for channel in self._channels.values():
            channel.open(self._motion, self._now())
        self._own_timers = [
            self.create_timer(DRAIN_PERIOD, self._drain, clock=self._steady),
            self.create_timer(STATUS_PERIOD, self._publish_all, clock=self._steady),
            self.create_timer(TRIM_PERIOD, trim_memory, clock=self._steady),
        ]
        self._tell_topics(self._motion)
        return super().on_activate(state)

    def stop_work(self) -> None:
        """Leave the topics; the evidence stays."""
        for timer in self._own_timers:
            self.destroy_timer(timer)
        self._own_timers = []
        for channel in self._channels.values():
            channel.close()
        if self._motion is not None:
            self._motion.close()
            self._motion = None

    def dismantle(self) -> None:
        """Drop the monitors."""
        for service in self._own_services:
            self.destroy_service(service)
        self._own_services = []
        for channel in self._channels.values():
            channel.destroy()
        self._channels = {}

    def destroy_node(self) -> None:
        """Leave; what the ledger does not have yet is written first."""
        for channel in self._channels.values():
            channel.watch.close()
        super().destroy_node()

    # Settings -------------------------------------------------------------------------------------------------------

    def _follow_parameters(self) -> None:
        """Have every joint watched as its parameters say; a joint for which they leave nothing valid starts anew."""
        settings = self._parameters_of_joints.settings
        for joint, own in settings.items():
            channel = self._channels.get(joint)
            if channel is None or not channel.change(own):
                if channel is not None:
                    self._channels.pop(joint).destroy()
                    self.get_logger().info(f"{joint}: starts anew with other parameters")
                self._channels[joint] = JointChannel(self, joint, own, len(settings) > 1, self._now())

    def _is_active(self) -> bool:
        return self._motion is not None

    def _change(self) -> None:
        """Put changed parameters in force at once; while inactive they wait for the activation."""
        if self._motion is None:
            return
        self._drain()
        self._follow_parameters()
        before, self._motion = self._motion, self._subscribed_motion()
        for channel in self._channels.values():
            if self._motion is not before:
                channel.watch.await_anew(Quantity.MOTION, self._now())
            channel.listen(self._motion, self._now())
        self._tell_topics(self._motion)

    def _subscribed_motion(self) -> DrainedSubscription:
        settings = [channel.watch.settings for channel in self._channels.values()]
        reliable = all(own.input.reliability == "reliable" for own in settings)
        return subscribed(
            self._motion,
            self,
            JOINT_STATES.topic,
            JOINT_STATES.type,
            depth=max(map(queue_depth_of, settings)),
            reliability="reliable" if reliable else "best_effort",
        )

    def _tell_topics(self, motion: DrainedSubscription) -> None:
        """Log what is listened to, where that is news."""
        channels = self._channels.values()
        watched = ", ".join(f"{c.joint} ({' and '.join([*c.topics, motion.topic])})" for c in channels)
        if watched != self._watched:
            self._watched = watched
            self.get_logger().info(f"watching {watched}")

    # Work -----------------------------------------------------------------------------------------------------------

    def _drain(self) -> None:
        if self._motion is None:
            return
        motion = self._motion.drain()
        now = self._now()
        for channel in self._channels.values():
            channel.feed(motion, now)
            self._tell_news(channel)

    def _publish_all(self) -> None:
        now = self._now()
        for channel in self._channels.values():
            channel.watch.check(now)
            self._tell_news(channel)
        statuses = [status for channel in self._channels.values() for status in channel.watch.statuses()]
        self._publish(statuses)
        self._log.note(statuses, self._steady.now().nanoseconds)

    def _publish(self, statuses: Sequence[Status]) -> None:
        node = self.get_fully_qualified_name()
        message = DiagnosticArray(status=[diagnostic_status(status, node) for status in statuses])
        message.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(message)

    def _now(self) -> int:
        """Time by which silence counts [ns]: simulated with ``use_sim_time``, else a clock that cannot be set back."""
        simulated = self.get_parameter("use_sim_time").value
        return int((self.get_clock() if simulated else self._steady).now().nanoseconds)

    def _tell_news(self, channel: JointChannel) -> None:
        """Publish and log a joint's transitions at once, and log a traceback the first time it appears."""
        for statuses in channel.watch.take_transitions():
            self._publish(statuses)
            self._log.note(statuses, self._steady.now().nanoseconds)
        self._log.note_error(channel.joint, channel.watch.last_error)

    # Requests -------------------------------------------------------------------------------------------------------

    def _report(self, request: SelfTest.Request, response: SelfTest.Response) -> SelfTest.Response:
        """Publish all statuses now, and answer with them."""
        self._publish_all()
        watches = [channel.watch for channel in self._channels.values()]
        statuses = [status for watch in watches for status in watch.statuses()]
        response.id = ", ".join(watch.settings.serial or watch.joint for watch in watches)
        response.passed = bytes([all(status.level == Level.OK for status in statuses)])
        response.status = [diagnostic_status(status, self.get_fully_qualified_name()) for status in statuses]
        return response

    def _offer(self, name: str, action: str, of: list[str]) -> None:
        joints = ", ".join(of)

        def act(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            try:
                for joint in of:
                    getattr(self._channels[joint].watch, action)()
            except Exception as error:  # a request must not end the node
                self.get_logger().error(f"{name} failed: {error!r}")
                response.success, response.message = False, f"{type(error).__name__}: {error}"
                return response
            self.get_logger().info(f"{name} called: done for {joints}")
            response.success, response.message = True, f"done for {joints}"
            return response

        self._own_services.append(self.create_service(Trigger, name, act))


def main(args: list[str] | None = None) -> int:
    """Run the node until it is interrupted; return 0, or 2 for parameters with which nothing can be watched."""
    return_memory()
    return run(NAME, HdMonitorNode, args)

"""The node ``hd_monitor_node``: any number of joints, from their topics to /diagnostics."""

from collections.abc import Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger

from .. import contract
from ..diagnosis.status import Status
from ..errors import HdMonitorError
from ..settings import JointSettings
from ..sources import JOINT_STATES
from .joint_channel import JointChannel, queue_depth_of
from .managed_node import ManagedNode, logged, run
from .messages import diagnostic_status
from .parameters import JointParameters
from .queue import return_memory
from .status_log import StatusLog
from .subscriptions import DrainedSubscription

NAME = "hd_monitor_node"
DRAIN_PERIOD = 0.05
"""Seconds between two looks into the queues: the largest delay of a verdict."""
STATUS_PERIOD = 1.0
"""Seconds between two statuses (REP-107)."""


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
        self._channels: list[JointChannel] = []
        self._motion: DrainedSubscription | None = None
        self._own_timers: list[Any] = []
        self._own_services: list[Any] = []
        self._log = StatusLog(self.get_logger())
        self._parameters_of_joints = JointParameters(self, self._change_limits)
        self._diagnostics = self.create_lifecycle_publisher(DiagnosticArray, contract.DIAGNOSTICS, QoSProfile(depth=10))
        if self.get_parameter("autostart").value:
            self.bring_up()

    # Lifecycle ------------------------------------------------------------------------------------------------------

    @logged
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make a monitor for every joint, with its publishers and services."""
        settings = self._parameters_of_joints.settings
        several = len(settings) > 1
        try:
            for joint, own in settings.items():
                self._channels.append(JointChannel(self, joint, own, several, self._now()))
        except HdMonitorError as error:
            self.dismantle()
            return self.refuse(error)
        self._offer("~/reset_latch", "reset_latch", self._channels)
        self._offer("~/reset", "reset", self._channels)
        self._offer("~/set_baseline", "set_baseline", self._channels)
        if several:
            for channel in self._channels:
                self._offer(f"~/{channel.joint}/reset_latch", "reset_latch", [channel])
                self._offer(f"~/{channel.joint}/reset", "reset", [channel])
                self._offer(f"~/{channel.joint}/set_baseline", "set_baseline", [channel])
        return super().on_configure(state)

    @logged
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Subscribe, and start looking into the queues."""
        settings = [channel.watch.settings for channel in self._channels]
        reliable = all(own.input.reliability == "reliable" for own in settings)
        self._motion = DrainedSubscription(
            self,
            JOINT_STATES.topic,
            JOINT_STATES.type,
            depth=max(map(queue_depth_of, settings)),
            reliability="reliable" if reliable else "best_effort",
        )
        for channel in self._channels:
            channel.open(self._motion, self._now())
        self._own_timers = [
            self.create_timer(DRAIN_PERIOD, self._drain, clock=self._steady),
            self.create_timer(STATUS_PERIOD, self._publish_all, clock=self._steady),
        ]
        watched = ", ".join(f"{c.joint} ({' and '.join([*c.topics, self._motion.topic])})" for c in self._channels)
        self.get_logger().info(f"watching {watched}")
        return super().on_activate(state)

    def stop_work(self) -> None:
        """Leave the topics; the evidence stays."""
        for timer in self._own_timers:
            self.destroy_timer(timer)
        self._own_timers = []
        for channel in self._channels:
            channel.close()
        if self._motion is not None:
            self._motion.close()
            self._motion = None

    def dismantle(self) -> None:
        """Drop the monitors."""
        for service in self._own_services:
            self.destroy_service(service)
        self._own_services = []
        for channel in self._channels:
            channel.destroy()
        self._channels = []

    def destroy_node(self) -> None:
        """Leave; what the ledger does not have yet is written first."""
        for channel in self._channels:
            channel.watch.close()
        super().destroy_node()

    # Work -----------------------------------------------------------------------------------------------------------

    def _drain(self) -> None:
        if self._motion is None:
            return
        motion = self._motion.drain()
        now = self._now()
        for channel in self._channels:
            channel.feed(motion, now)
            self._tell_news(channel)

    def _publish_all(self) -> None:
        now = self._now()
        for channel in self._channels:
            channel.watch.check(now)
            self._tell_news(channel)
        statuses = [status for channel in self._channels for status in channel.watch.statuses()]
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

    def _change_limits(self, settings: dict[str, JointSettings]) -> None:
        for channel in self._channels:
            channel.watch.change_limits(settings[channel.joint])

    def _offer(self, name: str, action: str, channels: list[JointChannel]) -> None:
        joints = ", ".join(channel.joint for channel in channels)

        def act(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            try:
                for channel in channels:
                    getattr(channel.watch, action)()
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

"""The node ``hd_sim_node``: a simulated rig that publishes what hd_monitor listens to."""

import time
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from importlib import import_module
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter as RosParameter
from rclpy.qos import QoSProfile

from hd_monitor.errors import HdMonitorError
from hd_monitor.ros.declaration import answer, declare, with_real_numbers
from hd_monitor.ros.managed_node import ManagedNode, logged, run
from hd_monitor.ros.queue import queue_depth

from .drive.stability import check_stability
from .messages.encoding import MESSAGE_TYPES, encode
from .messages.stream import Stream
from .parameters import CHANGEABLE, NODE_PARAMETERS, PARAMETERS
from .settings import RigSettings, pick
from .simulation import Simulation, Stretch

NAME = "hd_sim_node"
PUBLISH_PERIOD = 0.01
"""Seconds between two looks at the clock, and so the most by which a message is late."""
LONGEST_TURN = 0.05
"""Seconds of publishing after which services and parameters get their turn."""
FLUSH_TIME = 5.0
"""Seconds in which subscribers must have taken the last messages before the process ends."""


class HdSimNode(ManagedNode):
    """Publishes a simulated rig: set up by configure, running while active, paused by deactivate.

    The options are the base class's: ``context``, ``namespace``, ``parameter_overrides`` …

    Raises
    ------
    ParameterError, GeometryError
        If a parameter is impossible; the message says which, why and what to do.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(NAME, **options)
        self._simulation: Simulation | None = None
        self._stream: Stream | None = None
        self._encode: Callable[[Stretch, int], dict[str, list[bytes]]] | None = None
        self._outlets: dict[str, Any] = {}
        self._timer: Any = None
        self._declare_all()
        self.add_pre_set_parameters_callback(partial(with_real_numbers, self))
        self.add_on_set_parameters_callback(self._check)
        self.add_post_set_parameters_callback(self._apply)
        if self.get_parameter("autostart").value:
            self.bring_up()

    def _declare_all(self) -> None:
        given = {p.name: p.value for p in self.get_parameters(self.list_parameters([], 0).names)}
        settings = RigSettings.from_mapping(pick(given, NODE_PARAMETERS))
        values = {**settings.values, **{p.name: p.check(given.get(p.name, p.default)) for p in NODE_PARAMETERS}}
        for parameter in (*PARAMETERS, *NODE_PARAMETERS):
            fixed = not parameter.name.startswith((*CHANGEABLE, "time_scale"))
            declare(self, parameter, values[parameter.name], read_only=fixed)

    def _settings(self, changes: Sequence[RosParameter] = ()) -> RigSettings:
        values = {p.name: self.get_parameter(p.name).value for p in PARAMETERS}
        values |= {p.name: p.value for p in changes if p.name in values}
        return RigSettings.from_mapping(values)

    def _check(self, parameters: Sequence[RosParameter]) -> SetParametersResult:
        def check() -> None:
            settings = self._settings(parameters)
            if self._simulation is not None and settings != self._simulation.settings:
                check_stability(settings.largest_model, settings.programme, settings.general.unstable)

        return answer(check)

    def _apply(self, parameters: Sequence[RosParameter]) -> None:
        settings = self._settings()
        if self._simulation is not None and settings != self._simulation.settings:
            self._simulation.change(settings)
            self._remark(self._simulation)
        if self._stream is not None:
            self._stream.set_scale(self.get_parameter("time_scale").value, self._steady_time())

    def _remark(self, simulation: Simulation) -> None:
        """Log what is being simulated, and what the user may not have intended."""
        settings, model = simulation.settings, simulation.settings.model
        self.get_logger().info(
            f"rig {settings.reducer.flexspline_teeth}/{settings.reducer.circular_spline_teeth}, programme "
            f"{settings.general.programme}, defect {settings.general.defect}: index of the flexspline "
            f"{100 * model.flexspline.index:.2f} %, of the circular spline {100 * model.circular_spline.index:.2f} %"
        )
        for remark in (*settings.remarks, simulation.warning):
            if remark:
                self.get_logger().warning(remark)

    @logged
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Set up the rig and its publishers."""
        try:
            settings = self._settings()
            self._simulation = Simulation(settings)
        except HdMonitorError as error:
            return self.refuse(error)
        self._remark(self._simulation)
        scale = self.get_parameter("time_scale").value
        self._stream = Stream(self._simulation, scale)
        seconds = self.get_parameter("queue_seconds").value
        self._encode = lru_cache(maxsize=1)(lambda stretch, epoch: encode(stretch, settings, epoch))
        for topic in self._simulation.topics:
            package, _, name = MESSAGE_TYPES[topic].split("/")
            kind = getattr(import_module(f"{package}.msg"), name)
            depth = queue_depth(scale * self._simulation.message_rate(topic), seconds)
            self._outlets[topic] = self.create_lifecycle_publisher(kind, topic, QoSProfile(depth=depth))
        return super().on_configure(state)

    @logged
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Run, as soon as there are enough subscribers."""
        self._timer = self.create_timer(PUBLISH_PERIOD, self._turn, clock=self._steady)
        wanted = self.get_parameter("wait_for_subscribers").value
        if wanted:
            self.get_logger().info(f"waiting for {wanted} subscriber(s) of {', '.join(self._outlets)}")
        return super().on_activate(state)

    def stop_work(self) -> None:
        """Pause; once activated again, the rig continues where it was, stamped with the new time."""
        if self._timer is not None:
            self.destroy_timer(self._timer)
            self._timer = None
        if self._stream is not None:
            self._stream.pause()

    def dismantle(self) -> None:
        """Take the rig down."""
        for outlet in self._outlets.values():
            self.destroy_lifecycle_publisher(outlet)
        self._outlets = {}
        self._simulation = self._stream = self._encode = None

    def _turn(self) -> None:
        """Publish what is due."""
        stream, encode = self._stream, self._encode
        if stream is None or encode is None:
            return
        if not stream.running:
            wanted = self.get_parameter("wait_for_subscribers").value
            if any(outlet.get_subscription_count() < wanted for outlet in self._outlets.values()):
                return
            stream.start(self._steady_time(), self.get_clock().now().nanoseconds)
        give_up = time.monotonic() + LONGEST_TURN
        for stretch, topic, row in stream.due(self._steady_time()):
            self._outlets[topic].publish(encode(stretch, stream.epoch)[topic][row])
            if time.monotonic() > give_up:
                break
        if stream.lag(self._steady_time()) > 1.0:
            self.get_logger().warning(
                "cannot keep up with the clock; lower time_scale or sensor.rate, or publish blocks instead of samples",
                throttle_duration_sec=10.0,
            )
        if stream.ended and self._timer is not None:
            self.get_logger().info(f"the programme has ended after {stream.position:.6g} s; nothing more is published")
            self.stop_work()
            if self.get_parameter("exit_at_end").value:
                for outlet in self._outlets.values():
                    outlet.wait_for_all_acked(Duration(seconds=FLUSH_TIME))
                self.finished = True

    def _steady_time(self) -> float:
        return float(self._steady.now().nanoseconds) * 1e-9


def main(args: list[str] | None = None) -> int:
    """Run the node until it is interrupted or has ended; return 0, or 2 for parameters with which no rig can run."""
    return run(NAME, HdSimNode, args)

"""The demo's ear: a node of its own that subscribes to the monitor's statuses."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

from hd_monitor import contract
from hd_monitor.diagnosis.verdict import Level

from .screen import View

Listen = Callable[[float], View | None]
"""Returns the next status; None if there is none within so many seconds."""


@contextmanager
def listening(domain: int) -> Iterator[Listen]:
    """Receive the reducer's status in the ROS domain with this ROS_DOMAIN_ID, within a ``with`` block."""
    context = Context()
    # No arguments: rclpy would take NAME:=VALUE from the command line for remappings.
    rclpy.init(args=[], context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
    node = Node("hd_demo", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    views: list[View] = []

    def receive(message: DiagnosticArray) -> None:
        # The reducer's keys over those of its input, which has the counters
        values = {pair.key: pair.value for status in reversed(message.status) for pair in status.values}
        for status in message.status:
            if status.name.endswith(" reducer"):
                level = Level(int.from_bytes(status.level, "little"))
                views.append(View(name=status.name, level=level, message=status.message, values=values))

    def listen(seconds: float) -> View | None:
        views.clear()
        executor.spin_once(timeout_sec=seconds)
        return views[-1] if views else None

    node.create_subscription(DiagnosticArray, contract.DIAGNOSTICS, receive, QoSProfile(depth=100))
    try:
        yield listen
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()

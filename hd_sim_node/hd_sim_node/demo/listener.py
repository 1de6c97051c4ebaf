"""The demo's ear: a node of its own that subscribes to the monitor's statuses."""

from typing import Self

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


class Listener:
    """Receives the reducer's status in a ROS domain, within a ``with`` block.

    Parameters
    ----------
    domain : int
        ROS_DOMAIN_ID.
    """

    def __init__(self, domain: int) -> None:
        self._context = Context()
        # No arguments: rclpy would take NAME:=VALUE from the command line for remappings.
        rclpy.init(args=[], context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        self._node = Node("hd_demo", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._node.create_subscription(DiagnosticArray, contract.DIAGNOSTICS, self._receive, QoSProfile(depth=100))
        self._view: View | None = None

    def __enter__(self) -> Self:
        """Listen from now on."""
        return self

    def __exit__(self, *error: object) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def listen(self, seconds: float) -> View | None:
        """Return the next status; None if there is none within `seconds`."""
        self._view = None
        self._executor.spin_once(timeout_sec=seconds)
        return self._view

    def _receive(self, message: DiagnosticArray) -> None:
        for status in message.status:
            if status.name.endswith(" reducer"):
                self._view = View(
                    name=status.name,
                    level=Level(int.from_bytes(status.level, "little")),
                    message=status.message,
                    values={pair.key: pair.value for pair in status.values},
                )

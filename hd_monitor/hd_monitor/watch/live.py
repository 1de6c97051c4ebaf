"""The live source: a node of its own that listens to /diagnostics and to the curves of every joint in it."""

import os
from contextlib import suppress
from dataclasses import replace

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from .. import contract
from ..cdr import decode_diagnostics
from ..errors import LayoutError
from ..ros.subscriptions import DrainedSubscription
from .curves import NAMES, Curve, curve_from, topic_of
from .state import Key, View

_STATUSES = 200
"""Arrays that may wait: a second's of as many nodes."""
_CURVES = 2


class LiveSource:
    """Listens on DDS. Nothing is spun: the queues are emptied whenever the screen asks.

    Parameters
    ----------
    domain : int, optional
        ROS_DOMAIN_ID; the environment's if None.
    """

    pause = 0.5

    def __init__(self, domain: int | None = None) -> None:
        self._context = Context()
        # No arguments: rclpy would read this command's own. No signal handlers: the terminal's library has its own.
        rclpy.init(args=[], context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        self._domain = self._context.get_domain_id()
        self._node = Node(
            "hd_watch",
            context=self._context,
            enable_rosout=False,
            start_parameter_services=False,
            use_global_arguments=False,
        )
        self._diagnostics = DrainedSubscription(
            self._node, contract.DIAGNOSTICS, "diagnostic_msgs/DiagnosticArray", depth=_STATUSES, reliability="reliable"
        )
        self._curves: dict[tuple[Key, str], DrainedSubscription] = {}

    def begin(self) -> View:
        """Return the view of nothing yet."""
        range_ = os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
        return View(
            source=f"live, ROS_DOMAIN_ID {self._domain}",
            awaiting=(
                f"Check that hd_monitor_node runs and is active, and that it has this ROS_DOMAIN_ID, {self._domain} "
                f"(discovery range {range_}): ros2 topic echo {contract.DIAGNOSTICS}"
            ),
            live=True,
        )

    def update(self, view: View, now: float) -> View:
        """Take what has come; messages that cannot be read are noted and left out."""
        view = replace(view, now=now)
        for message in self._diagnostics.drain():
            try:
                view = view.with_diagnostics(decode_diagnostics(message))
            except LayoutError as error:
                view = replace(view, notes=(f"{contract.DIAGNOSTICS}: {error}",))
        self._listen(view)
        return view.with_curves(self._newest())

    def _listen(self, view: View) -> None:
        """Subscribe to the curves that have come up."""
        wanted = [(key, name) for key in view.joints for name in NAMES if (key, name) not in self._curves]
        if not wanted:
            return
        topics = {topic for topic, _ in self._node.get_topic_names_and_types()}
        for key, name in wanted:
            if topic := topic_of(topics, key.node, key.joint, name):
                self._curves[key, name] = DrainedSubscription(
                    self._node, topic, "std_msgs/Float64MultiArray", depth=_CURVES, reliability="reliable"
                )

    def _newest(self) -> list[tuple[Key, str, Curve]]:
        found = []
        for (key, name), subscription in self._curves.items():
            for message in subscription.drain()[-1:]:
                with suppress(LayoutError):  # another program's topic has the same name
                    found.append((key, name, curve_from(message, name)))
        return found

    def close(self) -> None:
        """Leave the graph."""
        self._node.destroy_node()
        self._context.try_shutdown()

"""``hd-monitor demo``: a simulated rig and the monitor as two real nodes over DDS, and the verdict on /diagnostics."""

import argparse
import math
import os
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

from hd_sim_node.node_parameters import NODE_PARAMETERS as RIG_NODE_PARAMETERS
from hd_sim_node.settings import RigSettings, pick

from .. import contract
from ..diagnosis.probability import name_component
from ..diagnosis.verdict import FaultCode
from ..errors import HdMonitorError, ParameterError
from ..offline.parameters import parse_override
from ..reducer import LinePair
from ..settings import split_joints
from .children import ChildError, Children
from .demo_screen import Screen, View
from .domain import LAST_DOMAIN, free_domain

DEFECTS = ("flexspline", "circular_spline", "both", "none")
TIME_SCALE = 8.0
SIMULATOR = ("hd_sim_node", "hd_sim_node")
MONITOR = ("hd_monitor_node", "hd_monitor.ros")
PATIENCE = 60.0
"""Seconds without anything new on /diagnostics after which the demo gives up."""
INPUT_TIMEOUT = 3.0
"""Seconds of real time after which the monitor counts an input as lost."""
FAILED = 1


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.description = (
        "Starts hd_sim_node (a rig with the defect of your choice) and hd_monitor_node as processes of their own,\n"
        "which talk over DDS on this machine only, and shows what the monitor says on /diagnostics while the rig\n"
        "dwells at 200, 300 … 3000 rpm. Ends with status 0 if the monitor names what was simulated, 1 if not."
    )
    parser.add_argument("--defect", choices=DEFECTS, default="flexspline", help="the bad spline (default: %(default)s)")
    parser.add_argument(
        "--time-scale",
        type=float,
        default=TIME_SCALE,
        metavar="X",
        help="simulated seconds in a second (default: %(default)g)",
    )
    parser.add_argument(
        "--seconds", type=float, metavar="S", help="simulated time to watch (default: the programme once)"
    )
    parser.add_argument(
        "--domain", type=int, metavar="N", help="ROS_DOMAIN_ID to use (default: one that nobody on this machine uses)"
    )
    parser.add_argument(
        "--sim", action="append", default=[], metavar="NAME:=VALUE", help="a parameter of hd_sim_node, repeatable"
    )
    parser.add_argument(
        "--monitor",
        action="append",
        default=[],
        metavar="NAME:=VALUE",
        help="a parameter of hd_monitor_node, repeatable",
    )
    parser.add_argument("--stay", action="store_true", help="keep both nodes running afterwards, until Ctrl+C")
    parser.add_argument("--plain", action="store_true", help="print lines even on a terminal")


def run(arguments: argparse.Namespace) -> int:
    """Run the demo; return 0 if the monitor names what was simulated, 1 if not or if a node fails."""
    screen = Screen(sys.stdout, plain=arguments.plain)
    plan = _Plan(arguments)
    # A message's class brings its own library, and the middleware reads its range of discovery when it starts.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        with Children(os.environ | {"ROS_DOMAIN_ID": str(plan.domain)}) as children:
            return _watch(plan, children, screen)
    except (ChildError, _SilenceError) as error:
        print(f"hd-monitor demo: {error}", file=sys.stderr)
        return FAILED
    finally:
        signal.signal(signal.SIGTERM, before)


class _SilenceError(HdMonitorError):
    """The monitor says nothing, or nothing new."""


class _Plan:
    """What is simulated, for how long and where."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        given = dict(parse_override(text) for text in arguments.sim)
        self.rig = RigSettings.from_mapping(pick({"defect": arguments.defect} | given, RIG_NODE_PARAMETERS))
        self._joint, self._settings = next(
            iter(split_joints(dict(parse_override(text) for text in arguments.monitor)).items())
        )
        if not 0.0 < arguments.time_scale < math.inf:
            raise ParameterError(f"--time-scale = {arguments.time_scale:g} stops the time; give a positive number")
        if arguments.domain is not None and not 0 <= arguments.domain <= LAST_DOMAIN:
            raise ParameterError(f"--domain = {arguments.domain} is no ROS_DOMAIN_ID; give 0 to {LAST_DOMAIN}")
        if arguments.seconds is not None and not 0.0 < arguments.seconds < math.inf:
            raise ParameterError(f"--seconds = {arguments.seconds:g} is no time to watch; give a positive number")
        self.seconds: float = arguments.seconds or self.rig.programme.cycle_duration
        self.domain: int = free_domain() if arguments.domain is None else arguments.domain
        self.simulator = ("--ros-args", *_pairs([f"defect:={arguments.defect}", *arguments.sim]))
        self.simulator += ("-p", f"time_scale:={arguments.time_scale}", "-p", "wait_for_subscribers:=1")
        if self._settings.sensorless:  # nobody would subscribe to the vibration that the rig waits to publish
            self.simulator += ("-p", "publish:=none")
        # Loss counts by the stamps: where they run fast, a delay of the machine looks as many times as long.
        timeout = max(1.0, arguments.time_scale) * INPUT_TIMEOUT
        self.monitor = ("--ros-args", "-p", f"input.timeout:={timeout}", *_pairs(arguments.monitor))
        self.time_scale: float = arguments.time_scale
        self.stay: bool = arguments.stay

    @property
    def description(self) -> str:
        """What is simulated, in words."""
        speeds = abs(self.rig.programme.speeds)
        return (
            f"a rig with defect {self.rig['defect']}: {self.rig['programme']}, {min(speeds):.0f} to "
            f"{max(speeds):.0f} rpm, {self.time_scale:g} × real time"
        )

    @property
    def expected(self) -> str:
        """The component that a right verdict names."""
        model = self.rig.model
        return name_component(
            LinePair(model.circular_spline.index, model.flexspline.index),
            self._settings.diagnosis.warn_index,
            self._settings.diagnosis.both_ratio,
        ).value

    def progress(self, view: View) -> float:
        """Part of the simulated time that the monitor has seen, from 0 to 1."""
        messages = view.number("joint states") or 0.0
        rate: float = self.rig["joint_states.rate"]
        return messages / rate / self.seconds


def _pairs(parameters: Sequence[str]) -> tuple[str, ...]:
    return tuple(word for parameter in parameters for word in ("-p", parameter))


def _interrupt(number: int, frame: Any) -> None:
    raise KeyboardInterrupt


class _Listener:
    """Hears what the monitor publishes.

    Attributes
    ----------
    view : View or None
        The newest status.
    heard : int
        Statuses so far.
    """

    def __init__(self, context: Context) -> None:
        self.view: View | None = None
        self.heard = 0
        self._node = Node("hd_demo", context=context)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self._node)
        self._node.create_subscription(DiagnosticArray, contract.DIAGNOSTICS, self._hear, QoSProfile(depth=100))

    def _hear(self, message: DiagnosticArray) -> None:
        for status in message.status:
            if status.name.endswith(" reducer"):
                self.heard += 1
                self.view = View(
                    name=status.name,
                    level=int.from_bytes(status.level, "little"),
                    message=status.message,
                    hardware_id=status.hardware_id,
                    values={pair.key: pair.value for pair in status.values},
                )

    def listen(self, seconds: float) -> None:
        """Handle what comes in this time, or the first of it."""
        self._executor.spin_once(timeout_sec=seconds)

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self._node.destroy_node()


@contextmanager
def _listening(domain: int) -> Iterator[_Listener]:
    context = Context()
    # Without words of its own: it would take NAME:=VALUE from the command line for remappings.
    rclpy.init(args=[], context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
    listener = _Listener(context)
    try:
        yield listener
    finally:
        listener.close()
        context.try_shutdown()


def _watch(plan: _Plan, children: Children, screen: Screen) -> int:
    rig, monitor = children.start(*SIMULATOR, *plan.simulator), children.start(*MONITOR, *plan.monitor)
    screen.line(f"hd_sim_node      {plan.description}  (process {rig})")
    screen.line(f"hd_monitor_node  watches it over DDS, ROS_DOMAIN_ID={plan.domain}  (process {monitor})")
    screen.line()
    with _listening(plan.domain) as listener:
        view = _follow(plan, children, screen, listener)
        right = _conclude(plan, screen, view)
        if plan.stay:
            screen.line(f"Both nodes go on in ROS_DOMAIN_ID={plan.domain}; Ctrl+C ends them.")
            _stay(children, screen, listener)
    return 0 if right else FAILED


def _follow(plan: _Plan, children: Children, screen: Screen, listener: _Listener) -> View:
    """Show what the monitor says until the programme is through; return its last word."""
    seen, best, moved = 0, 0.0, time.monotonic()
    while True:
        listener.listen(0.2)
        children.check()
        view = listener.view
        if view is not None and listener.heard > seen:
            seen = listener.heard
            if view.values.get("fault_code") == FaultCode.INTERNAL_ERROR:
                raise ChildError(f"the monitor had an {view.message[:1].lower()}{view.message[1:]}")
            progress = plan.progress(view)
            screen.update(view, progress)
            if progress >= 1.0:
                return view
            if progress > best:
                best, moved = progress, time.monotonic()
        if time.monotonic() - moved > PATIENCE:
            what = "no status" if view is None else f"nothing new: {view.message}"
            raise _SilenceError(f"{what} on {contract.DIAGNOSTICS} within {PATIENCE:.0f} s")


def _stay(children: Children, screen: Screen, listener: _Listener) -> None:
    seen = listener.heard
    while True:
        listener.listen(0.2)
        children.check()
        if listener.view is not None and listener.heard > seen:
            seen = listener.heard
            screen.update(listener.view, 1.0)


def _conclude(plan: _Plan, screen: Screen, view: View) -> bool:
    """Print the final status, where it came from, and whether it names what was simulated."""
    component, model = view.values.get("component", ""), plan.rig.model
    relative = "relative only, " if view.values.get("index kind") == "relative" else ""
    simulated = LinePair(100 * model.circular_spline.index, 100 * model.flexspline.index)
    rows = (
        ("component", component),
        ("fault_code", view.values.get("fault_code", "")),
        ("level", screen.colour(view.word)),
        ("flexspline", f"{view.percent('flexspline index')}   ({relative}simulated {simulated.flexspline:.2f} %)"),
        (
            "circular spline",
            f"{view.percent('circular spline index')}   ({relative}simulated {simulated.circular_spline:.2f} %)",
        ),
        ("limits", f"warn {view.values.get('warn limit (%)')} %, error {view.values.get('error limit (%)')} %"),
    )
    screen.line()
    screen.line("Final status")
    for name, value in rows:
        screen.line(f"  {name:18}{value}")
    screen.paragraph("message", view.message)
    node, _, _ = view.name.partition(":")
    screen.line("It came from")
    screen.line(f"  topic             {contract.DIAGNOSTICS} (diagnostic_msgs/DiagnosticArray)")
    screen.line(f"  node              {node}")
    screen.line(f"  status            {view.name}")
    screen.line()
    right = component == plan.expected
    if right:
        screen.line(f"The monitor names what was simulated: {plan.expected}.")
    else:
        screen.line(f"The monitor says {component}, but {plan.expected} was simulated.")
    return right

"""The command itself: start both nodes over DDS, show what comes on /diagnostics, compare it with the simulation."""

import argparse
import os
import signal
import sys
import time

from hd_monitor import contract
from hd_monitor.diagnosis.verdict import FaultCode

from ..drive.defects import DEFECTS
from .children import Children, DemoError
from .listener import Listen, listening
from .plan import Plan
from .screen import Screen, View

PATIENCE = 60.0
"""Seconds without progress on /diagnostics after which the demo gives up."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.description = (
        "Starts hd_sim_node (a rig with the defect of your choice) and hd_monitor_node as separate processes,\n"
        "which talk over DDS on this machine only, and shows what the monitor says on /diagnostics while the rig\n"
        "dwells at 200, 300 … 3000 rpm. Ends with status 0 if the monitor names what was simulated, 1 if not."
    )
    parser.add_argument(
        "--defect", choices=tuple(DEFECTS), default="flexspline", help="the bad spline (default: %(default)s)"
    )
    parser.add_argument(
        "--time-scale",
        type=float,
        default=8.0,
        metavar="X",
        help="simulated seconds in a second (default: %(default)g)",
    )
    parser.add_argument(
        "--seconds", type=float, metavar="S", help="simulated time to watch (default: the programme once)"
    )
    parser.add_argument(
        "--domain", type=int, metavar="N", help="ROS_DOMAIN_ID (default: one that is free on this machine)"
    )
    for node, name in (("sim", "hd_sim_node"), ("monitor", "hd_monitor_node")):
        parser.add_argument(
            f"--{node}", action="append", default=[], metavar="NAME:=VALUE", help=f"a parameter of {name}, repeatable"
        )
    parser.add_argument("--stay", action="store_true", help="keep both nodes running afterwards, until Ctrl+C")
    parser.add_argument("--plain", action="store_true", help="print lines even on a terminal")


def run(arguments: argparse.Namespace) -> int:
    """Run the demo; return 0 if the monitor names what was simulated, 1 if not."""
    screen = Screen(sys.stdout, plain=arguments.plain)
    plan = Plan(arguments)
    # The middleware reads its range of discovery when it starts.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with Children(os.environ | {"ROS_DOMAIN_ID": str(plan.domain)}) as children:
            rig = children.start("hd_sim_node", "hd_sim_node", *plan.simulator)
            monitor = children.start("hd_monitor_node", "hd_monitor.ros", *plan.monitor)
            screen.line(f"hd_sim_node      {plan.description}  (process {rig})")
            screen.line(f"hd_monitor_node  watches it over DDS, ROS_DOMAIN_ID={plan.domain}  (process {monitor})")
            screen.line()
            with listening(plan.domain) as listen:
                right = _conclude(plan, screen, _follow(plan, children, screen, listen))
                if arguments.stay:
                    screen.line(f"Both nodes keep running in ROS_DOMAIN_ID={plan.domain}; Ctrl+C ends them.")
                while arguments.stay:
                    children.check()
                    if (view := listen(0.2)) is not None:
                        screen.update(view, 1.0)
        return int(not right)
    finally:
        signal.signal(signal.SIGTERM, before)


def _follow(plan: Plan, children: Children, screen: Screen, listen: Listen) -> View:
    """Show what the monitor says until the simulated time is over; return its last status."""
    said, best, moved = "no status", 0.0, time.monotonic()
    while time.monotonic() - moved <= PATIENCE:
        children.check()
        view = listen(0.2)
        if view is None:
            continue
        if view.values.get("fault_code") == FaultCode.INTERNAL_ERROR:
            raise DemoError(f"the monitor had an {view.message[:1].lower()}{view.message[1:]}")
        progress = plan.progress(view)
        screen.update(view, progress)
        if progress >= 1.0:
            return view
        said = f"nothing new: {view.message}"
        if progress > best:
            best, moved = progress, time.monotonic()
    raise DemoError(f"{said} on {contract.DIAGNOSTICS} within {PATIENCE:.0f} s")


def _conclude(plan: Plan, screen: Screen, view: View) -> bool:
    """Print the final status, where it came from, and whether it names what was simulated."""
    component, model = view.values.get("component", ""), plan.rig.model
    relative = "relative only, " if view.values.get("index kind") == "relative" else ""
    simulated = {"flexspline": model.flexspline.index, "circular spline": model.circular_spline.index}
    indexes = {s: f"{view.index(s)}   ({relative}simulated {100 * index:.2f} %)" for s, index in simulated.items()}
    screen.line()
    screen.table(
        "Final status",
        {
            "component": component,
            "fault_code": view.values.get("fault_code", ""),
            "level": screen.colour(view.level),
            **indexes,
            "limits": f"warn {view.values.get('warn limit (%)')} %, error {view.values.get('error limit (%)')} %",
            "message": view.message,
        },
    )
    screen.table(
        "It came from",
        {
            "topic": f"{contract.DIAGNOSTICS} (diagnostic_msgs/DiagnosticArray)",
            "node": view.name.partition(":")[0],
            "status": view.name,
        },
    )
    screen.line()
    right = component == plan.expected
    screen.line(
        f"The monitor names what was simulated: {plan.expected}."
        if right
        else f"The monitor says {component}, but {plan.expected} was simulated."
    )
    return right

"""What the demo simulates, for how long, and what the monitor should say about it."""

import argparse
import math
import random
import socket
from collections.abc import Sequence

from hd_monitor.diagnosis.probability import name_component
from hd_monitor.errors import ParameterError
from hd_monitor.offline.parameters import parse_override
from hd_monitor.reducer import LinePair
from hd_monitor.settings import split_joints

from ..parameters import NODE_PARAMETERS
from ..settings import RigSettings, pick
from .screen import View

INPUT_TIMEOUT = 5.0
"""Seconds of real time after which the monitor counts an input as lost."""

DOMAINS = range(1, 102)  # above them, DDS ports run into the system's ephemeral ones
LAST_DOMAIN = 232
"""The highest ROS_DOMAIN_ID."""
_FIRST_PORT, _PORTS_PER_DOMAIN = 7410, 250  # of a domain's first participant, by the DDS standard


class Plan:
    """The rig, the arguments of both nodes, and the verdict to expect, from the command's arguments.

    Raises
    ------
    ParameterError, GeometryError
        If a parameter of either node or an argument is unusable.

    Attributes
    ----------
    rig : RigSettings
    seconds : float
        Simulated time to watch [s].
    time_scale : float
        Simulated seconds in a second.
    domain : int
        ROS_DOMAIN_ID of both nodes.
    simulator, monitor : tuple of str
        Their command lines.
    """

    def __init__(self, arguments: argparse.Namespace) -> None:
        given = dict(map(parse_override, arguments.sim))
        self.rig = RigSettings.from_mapping(pick({"defect": arguments.defect} | given, NODE_PARAMETERS))
        self._settings = next(iter(split_joints(dict(map(parse_override, arguments.monitor))).values()))
        for name in ("time_scale", "seconds"):
            value = getattr(arguments, name)
            if value is not None and not 0.0 < value < math.inf:
                raise ParameterError(f"--{name.replace('_', '-')} = {value:g} is not usable; give a positive number")
        if arguments.domain is not None and not 0 <= arguments.domain <= LAST_DOMAIN:
            raise ParameterError(f"--domain = {arguments.domain} is not a ROS_DOMAIN_ID; give 0 to {LAST_DOMAIN}")
        self.seconds: float = arguments.seconds or self.rig.programme.cycle_duration
        self.time_scale: float = arguments.time_scale
        self.domain: int = free_domain() if arguments.domain is None else arguments.domain
        fixed = [f"time_scale:={self.time_scale}", "wait_for_subscribers:=1"]
        if self._settings.sensorless:  # nobody would subscribe to the vibration that the rig waits to publish
            fixed.append("publish:=none")
        self.simulator = _command_line([f"defect:={arguments.defect}", *arguments.sim, *fixed])
        # Loss counts by the stamps: where they run fast, a delay of the machine looks as many times as long.
        timeout = max(1.0, self.time_scale) * INPUT_TIMEOUT
        self.monitor = _command_line([f"input.timeout:={timeout}", *arguments.monitor])

    @property
    def description(self) -> str:
        """What is simulated, in words."""
        speeds = abs(self.rig.programme.speeds)
        return (
            f"a rig with defect {self.rig.general.defect}: {self.rig.general.programme}, {min(speeds):.0f} to "
            f"{max(speeds):.0f} rpm, {self.time_scale:g} × real time"
        )

    @property
    def expected(self) -> str:
        """The component that a correct verdict names."""
        model = self.rig.model
        return name_component(
            LinePair(model.circular_spline.index, model.flexspline.index),
            self._settings.diagnosis.warn_index,
            self._settings.diagnosis.both_ratio,
        ).value

    def progress(self, view: View) -> float:
        """Part of the simulated time that the monitor has seen, from 0 to 1."""
        return (view.number("joint states") or 0.0) / self.rig.joint.rate / self.seconds


def _command_line(parameters: Sequence[str]) -> tuple[str, ...]:
    return ("--ros-args", *(word for parameter in parameters for word in ("-p", parameter)))


def free_domain() -> int:
    """Find a ROS_DOMAIN_ID without a DDS participant on this machine.

    The first participant of a domain binds a UDP port that follows from the domain's number, so a port that can be
    bound means a domain that is free.

    Raises
    ------
    ParameterError
        If every domain is in use.
    """
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("", _FIRST_PORT + _PORTS_PER_DOMAIN * domain))
            except OSError:
                continue
            return domain
    raise ParameterError("every ROS_DOMAIN_ID seems to be in use on this machine; give one with --domain")

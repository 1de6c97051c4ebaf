"""What hd_monitor_node takes of a machine beside a bare rclpy node: processor, memory, threads, disk.

    python tests/benchmarks/live_cost.py [one samples mixed blocks] [--seconds 60]

A row is one node and, but for the idle ones, a process beside it that sends it what a simulated rig would, in real
time over real DDS, the same to every joint. Processor time is that of the node alone, in the second half of the time,
when the fit has settled; memory and threads are read at the end; disk is what the node's log grew by. Start-up is
what the node takes before the first message. Memory of a joint is what the node has beyond the idle one, by joints.
"""

import argparse
import heapq
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from hd_monitor import contract
from hd_sim_node.demo.plan import free_domain
from hd_sim_node.messages.encoding import MESSAGE_TYPES, encode
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

STARTED = 8.0
"""Seconds after which a node has imported and discovered everything, with a machine to itself."""
BARE = "import rclpy; from rclpy.node import Node; rclpy.init(); rclpy.spin(Node('bare'))"
RIG = {"programme": "strokes", "defect": "flexspline"}
SENT: dict[str, dict[str, Any]] = {
    "block": {"publish": "block"},
    "accel_stamped": {"publish": "samples"},
    "imu": {"publish": "none", "publish_imu": True},
    "joint_effort": {"publish": "none", "joint_states.effort": "reaction"},
}
"""The rig's further parameters by the node's ``input.source``."""
SCENARIOS: dict[str, tuple[str, Sequence[str]]] = {
    "one": ("a joint with blocks of 1 kHz", ["block"]),
    "samples": ("a joint with single samples of 1 kHz", ["accel_stamped"]),
    "mixed": ("six joints: two of each, and an IMU, and efforts alone", [*SENT, "block", "accel_stamped"]),
    "blocks": ("32 joints with blocks of 1 kHz", 32 * ["block"]),
}
"""Name: what is watched, and the source of each joint."""


class Use(NamedTuple):
    """What a process takes at a time."""

    processor: float
    """Processor time so far [s]."""
    memory: float
    """Resident set [MB]."""
    threads: int


def use_of(process: int) -> Use:
    """Read what a process takes."""
    folder = Path(f"/proc/{process}")
    user, system = (folder / "stat").read_text().rpartition(")")[2].split()[11:13]
    status = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines())
    ticks = os.sysconf("SC_CLK_TCK")
    return Use((int(user) + int(system)) / ticks, int(status["VmRSS"].split()[0]) / 1024, int(status["Threads"]))


class Cost(NamedTuple):
    """What a node took."""

    start: Use
    end: Use
    load: float
    """Part of one processor in the second half of the time."""
    written: int
    """Bytes of its log."""


def measure(command: Sequence[str], sources: Mapping[str, str], seconds: float) -> Cost:
    """Run a node, send to its joints, each with its source, for a time, and see what it takes."""
    with ExitStack() as stack, tempfile.TemporaryDirectory() as logs:
        os.environ["ROS_DOMAIN_ID"] = str(free_domain())
        node = subprocess.Popen(
            [sys.executable, *command],
            env=os.environ | {"ROS_LOG_DIR": logs},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        stack.callback(node.wait)
        stack.callback(node.send_signal, signal.SIGINT)
        time.sleep(STARTED)
        start = use_of(node.pid)
        if sources:
            ready = multiprocessing.get_context("spawn").Event()
            feeder = multiprocessing.get_context("spawn").Process(target=send, args=(sources, seconds, ready))
            feeder.start()
            stack.callback(feeder.join)
            stack.callback(feeder.kill)
            ready.wait()
        time.sleep(seconds / 2)
        middle, half = use_of(node.pid), time.monotonic()
        time.sleep(seconds / 2)
        end, took = use_of(node.pid), time.monotonic() - half
        written = sum(file.stat().st_size for file in Path(logs).glob("*.log"))
    return Cost(start, end, (end.processor - middle.processor) / took, written)


def watching(sources: Mapping[str, str]) -> list[str]:
    """Command of a node that watches joints, each with its source."""
    chosen = [f"joints:=[{', '.join(sources)}]", *(f"{joint}.input.source:={kind}" for joint, kind in sources.items())]
    return ["-m", "hd_monitor.ros", "--ros-args", *(word for value in chosen for word in ("-p", value))]


# The process that sends -----------------------------------------------------------------------------------------------


def send(sources: Mapping[str, str], seconds: float, ready: Any) -> None:
    """Publish what rigs would, in real time; what can be done before is done before `ready` is set."""
    import rclpy

    rclpy.init()
    node = rclpy.create_node("rigs")
    epoch = time.time_ns()
    below = [f"{joint}/" if len(sources) > 1 else "" for joint in sources]
    streams = [_vibration(node, *which, epoch, seconds) for which in zip(below, sources.values(), strict=True)]
    messages = list(heapq.merge(*streams, _motion(node, sources, epoch, seconds), key=lambda message: message[0]))
    time.sleep(2.0)  # discovery
    ready.set()
    begun = time.monotonic_ns()
    for due, publisher, data in messages:
        if (ahead := due - (time.monotonic_ns() - begun)) > 1_000_000:
            time.sleep(ahead * 1e-9)
        publisher.publish(data)
    time.sleep(seconds)


@cache
def _messages(kind: str, topic: str, epoch: int, seconds: float) -> list[tuple[int, bytes]]:
    """Return (due [ns], message) of a rig's topic."""
    settings = RigSettings.from_mapping({**RIG, **SENT[kind], "duration": seconds + 2.0})
    found = []
    for stretch in Simulation(settings):
        encoded = encode(stretch, settings, epoch)
        found += [(due, encoded[name][row]) for due, name, row in stretch.schedule() if name == topic]
    return found


def _publisher(node: Any, topic: str, below: str = "") -> Any:
    package, _, name = MESSAGE_TYPES[topic].split("/")
    return node.create_publisher(getattr(import_module(f"{package}.msg"), name), f"{below}{topic}", 2000)


def _vibration(node: Any, below: str, kind: str, epoch: int, seconds: float) -> Iterator[tuple[int, Any, bytes]]:
    for topic in Simulation(RigSettings.from_mapping(SENT[kind])).topics:
        if topic != contract.JOINT_STATES:
            publisher = _publisher(node, topic, below)
            yield from ((due, publisher, data) for due, data in _messages(kind, topic, epoch, seconds))


def _motion(node: Any, sources: Mapping[str, str], epoch: int, seconds: float) -> Iterator[tuple[int, Any, bytes]]:
    """Yield joint states that hold all joints, as those of a robot do."""
    from rclpy.serialization import deserialize_message, serialize_message
    from sensor_msgs.msg import JointState

    publisher = _publisher(node, contract.JOINT_STATES)
    rigs = [_messages(kind, contract.JOINT_STATES, epoch, seconds) for kind in sources.values()]
    for every in zip(*rigs, strict=True):
        own = {data: deserialize_message(data, JointState) for data in {data for _, data in every}}
        message = own[every[0][1]]
        for field in ("position", "velocity", "effort"):
            setattr(message, field, [value for _, data in every for value in getattr(own[data], field)])
        message.name = list(sources)
        yield every[0][0], publisher, serialize_message(message)


# ---------------------------------------------------------------------------------------------------------------------


def row(what: str, cost: Cost, bare: Cost, idle: Cost | None = None, sources: Sequence[str] = ()) -> str:
    """Write a row of the table."""
    messages = 100.0 + sum({"block": 20.0, "joint_effort": 0.0}.get(kind, 1000.0) for kind in sources)  # a second
    cells = [
        what,
        f"{cost.start.processor:.2f} s",
        f"{100.0 * cost.load:.2f} %",
        f"{1e6 * cost.load / messages:.0f} µs" if sources else "",
        f"{cost.end.memory:.0f} MB",
        f"{cost.end.memory - bare.end.memory:.0f} MB",
        "" if idle is None else f"{(cost.end.memory - idle.end.memory) / len(sources):.1f} MB",
        f"{cost.end.threads}",
        f"{cost.written / 1024:.0f} kB",
    ]
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", choices=[*SCENARIOS, []], help="all of them if none is given")
    parser.add_argument("--seconds", type=float, default=60.0, help="that each takes")
    arguments = parser.parse_args()
    print("| node | start-up | of one processor | a message | memory | beyond the bare one | a joint | threads | log |")
    print("|---|---|---|---|---|---|---|---|---|")
    bare = measure(["-c", BARE], {}, arguments.seconds / 2)
    print(row("bare, of rclpy", bare, bare), flush=True)
    idle = measure(watching({"joint": "block"}), {}, arguments.seconds)
    print(row("idle: a joint whose inputs have not begun", idle, bare), flush=True)
    for name in arguments.names or SCENARIOS:
        what, kinds = SCENARIOS[name]
        sources = {f"joint_{number}": kind for number, kind in enumerate(kinds)}
        print(row(what, measure(watching(sources), sources, arguments.seconds), bare, idle, kinds), flush=True)


if __name__ == "__main__":
    main()

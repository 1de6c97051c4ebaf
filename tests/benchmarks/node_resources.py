"""What hd_monitor_node takes of a machine, by the number of its joints: processor, memory, threads, disk.

    python tests/benchmarks/node_resources.py [--joints 0 1 4] [--seconds 40] [--time-scale 1]

Each number of joints is one node with as many simulated rigs beside it, which send blocks of 1 kHz and joint states of
100 Hz over real DDS. Processor time is that of the node alone, in the second half of the time, when the fit has
settled; memory and threads are read at the end; disk is what the node's log grew by. Start-up is what the node takes
before the first message.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

from hd_sim_node.demo.plan import free_domain

STARTED = 5.0
"""Seconds after which a node has imported and discovered everything, with a machine to itself."""


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


def measure(joints: int, seconds: float, time_scale: float) -> str:
    """Run a node with as many joints for a time; return its row of the table."""
    names = [f"joint_{number}" for number in range(joints)]
    with ExitStack() as stack, tempfile.TemporaryDirectory() as logs:
        environment = os.environ | {"ROS_DOMAIN_ID": str(free_domain()), "ROS_LOG_DIR": logs}

        def start(module: str, arguments: Sequence[str], **more: str) -> subprocess.Popen[bytes]:
            process = subprocess.Popen(
                [sys.executable, "-m", module, "--ros-args", *arguments],
                env=environment | more,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            stack.callback(process.wait)
            stack.callback(process.terminate)
            return process

        watched = ["-p", f"joints:=[{', '.join(names)}]"] if joints else ["-p", "autostart:=false"]
        node = start("hd_monitor.ros", watched)
        time.sleep(STARTED)
        begun = use_of(node.pid)
        for name in names:
            topic = f"torsional_acceleration/block:={name}/torsional_acceleration/block"
            parameters = ["-p", f"joint_states.name:={name}", "-p", f"time_scale:={time_scale}"]
            start("hd_sim_node", ["-r", f"__node:=rig_{name}", "-r", topic, *parameters], ROS_LOG_DIR=f"{logs}/rigs")
        time.sleep(seconds / 2)
        middle, half = use_of(node.pid), time.monotonic()
        time.sleep(seconds / 2)
        end, took = use_of(node.pid), time.monotonic() - half
        written = sum(file.stat().st_size for file in Path(logs).glob("*.log")) / 1024
    load = 100.0 * (end.processor - middle.processor) / took
    return (
        f"| {joints} | {begun.processor:.1f} s | {load:.1f} % | {end.memory:.0f} MB | "
        f"{end.memory - begun.memory:.0f} MB | {end.threads} | {written:.0f} kB |"
    )


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--joints", type=int, nargs="+", default=[0, 1, 4])
    parser.add_argument("--seconds", type=float, default=40.0, help="to watch each number of joints")
    parser.add_argument("--time-scale", type=float, default=1.0, help="simulated seconds in a second")
    arguments = parser.parse_args()
    print("| joints | start-up | of one processor | memory | of it since the first message | threads | log |")
    print("|---|---|---|---|---|---|---|")
    for joints in arguments.joints:
        print(measure(joints, arguments.seconds, arguments.time_scale), flush=True)


if __name__ == "__main__":
    main()

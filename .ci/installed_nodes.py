"""Start both nodes from a colcon install tree and wait until data has passed from one to the other over DDS.

Usage: installed_nodes.py INSTALL, in an environment where INSTALL/setup.bash has been sourced.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["ROS_DOMAIN_ID"] = str(1 + os.getpid() % 100)
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray

DEADLINE_SECONDS = 90.0
STOP_SECONDS = 20.0
EXECUTABLES = ("hd_sim_node/lib/hd_sim_node/hd_sim_node", "hd_monitor/lib/hd_monitor/hd_monitor_node")


class Witness(Node):
    """Keeps the last block of the simulator and the last status of the monitor that counts samples."""

    def __init__(self) -> None:
        super().__init__("witness")
        self.block: Float64MultiArray | None = None
        self.status: dict[str, str] | None = None
        self.create_subscription(Float64MultiArray, "torsional_acceleration/block", self._on_block, 10)
        self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 10)

    def _on_block(self, message: Float64MultiArray) -> None:
        self.block = message

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            if float(values.get("samples", "0")) > 0:
                self.status = {"name": status.name, "message": status.message, **values}


def wait_for_both(witness: Witness, processes: list[subprocess.Popen[bytes]]) -> str | None:
    """Return None once block and status have arrived, or else what went wrong."""
    deadline = time.monotonic() + DEADLINE_SECONDS
    while witness.block is None or witness.status is None:
        for process in processes:
            if process.poll() is not None:
                return f"{process.args!r} ended with status {process.returncode}"
        if time.monotonic() > deadline:
            lacking = "no block" if witness.block is None else "no status with samples on /diagnostics"
            return f"{lacking} within {DEADLINE_SECONDS:.0f} s"
        rclpy.spin_once(witness, timeout_sec=0.2)
    return None


def stop(processes: list[subprocess.Popen[bytes]]) -> list[str]:
    """Interrupt the nodes as Ctrl-C does and return what did not end well."""
    problems = []
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        try:
            status = process.wait(STOP_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            problems.append(f"{process.args!r} was still there {STOP_SECONDS:.0f} s after SIGINT")
            continue
        if status != 0:
            problems.append(f"{process.args!r} ended with status {status} after SIGINT")
    return problems


def main(install: Path) -> int:
    """Run the check on one install tree and return the exit status."""
    rclpy.init()
    witness = Witness()
    processes: list[subprocess.Popen[bytes]] = []
    problems: list[str] = []
    with tempfile.TemporaryFile() as output:
        try:
            for executable in EXECUTABLES:
                command = [str(install / executable)]
                processes.append(subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT))
            problem = wait_for_both(witness, processes)
            problems += [problem] if problem else []
        finally:
            problems += stop(processes)
        if problems:
            output.seek(0)
            sys.stdout.write(output.read().decode(errors="replace"))
    if witness.block is not None:
        print(f"block of {witness.block.layout.dim[0].size} samples arrived")
    if witness.status is not None:
        print(f"status arrived: {witness.status}")
    witness.destroy_node()
    rclpy.try_shutdown()
    for problem in problems:
        print(f"PROBLEM: {problem}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))

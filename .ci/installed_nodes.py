"""Start the nodes of a colcon install tree and wait for their messages over DDS.

Usage: installed_nodes.py INSTALL, in an environment where INSTALL/setup.bash has been sourced. With both packages
there, data must pass from the simulator to the monitor; with hd_monitor alone, a status must come, and the demo must
say what to install.
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
SIMULATOR, MONITOR = "hd_sim_node/lib/hd_sim_node/hd_sim_node", "hd_monitor/lib/hd_monitor/hd_monitor_node"


class Witness(Node):
    """Keeps the last block of the simulator and the last status of the monitor, one that counts samples if asked to."""

    def __init__(self, *, with_samples: bool) -> None:
        super().__init__("witness")
        self.with_samples = with_samples
        self.block: Float64MultiArray | None = None
        self.status: dict[str, str] | None = None
        self.create_subscription(Float64MultiArray, "torsional_acceleration/block", self._on_block, 10)
        self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 10)

    def _on_block(self, message: Float64MultiArray) -> None:
        self.block = message

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            if not self.with_samples or float(values.get("samples", "0")) > 0:
                self.status = {"name": status.name, "message": status.message, **values}


def wait_for_messages(witness: Witness, processes: list[subprocess.Popen[bytes]]) -> str | None:
    """Return None once all expected messages have arrived, or else what went wrong."""
    deadline = time.monotonic() + DEADLINE_SECONDS
    while (witness.block is None and witness.with_samples) or witness.status is None:
        for process in processes:
            if process.poll() is not None:
                return f"{process.args!r} ended with status {process.returncode}"
        if time.monotonic() > deadline:
            return f"block {witness.block}, status {witness.status} after {DEADLINE_SECONDS:.0f} s"
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


def check_absence(install: Path) -> list[str]:
    """Run the demo without its simulator and return what is wrong with its answer."""
    command = install / "hd_monitor/lib/hd_monitor/hd-monitor"
    done = subprocess.run([command, "demo"], capture_output=True, text=True, timeout=DEADLINE_SECONDS, check=False)
    print(done.stderr, end="")
    if done.returncode == 2 and "needs the package hd_sim_node" in done.stderr:
        return []
    return [f"hd-monitor demo without hd_sim_node ended with status {done.returncode}: {done.stdout}{done.stderr}"]


def main(install: Path) -> int:
    """Run the check on one install tree and return the exit status."""
    executables = [name for name in (SIMULATOR, MONITOR) if (install / Path(name).parts[0]).is_dir()]
    rclpy.init()
    witness = Witness(with_samples=SIMULATOR in executables)
    processes: list[subprocess.Popen[bytes]] = []
    problems: list[str] = []
    with tempfile.TemporaryFile() as output:
        try:
            for executable in executables:
                command = [str(install / executable)]
                processes.append(subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT))
            problem = wait_for_messages(witness, processes)
            problems += [problem] if problem else []
            problems += [] if witness.with_samples else check_absence(install)
        finally:
            problems += stop(processes)
        if problems:
            output.seek(0)
            sys.stdout.write(output.read().decode(errors="replace"))
    if witness.block is not None:
        print(f"block of {witness.block.layout.dim[0].size} samples arrived")
    if witness.status is not None:
        print(f"status arrived from {', '.join(executables)}: {witness.status}")
    witness.destroy_node()
    rclpy.try_shutdown()
    for problem in problems:
        print(f"PROBLEM: {problem}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))

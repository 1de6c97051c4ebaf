"""How hd_monitor_node bears what happens to a live system: a table of scenarios, each with nodes over real DDS.

    python tests/benchmarks/live_strain.py                     all scenarios, some 15 minutes
    python tests/benchmarks/live_strain.py --seconds 60 hours  one of them, shortened

While a scenario runs, the node is asked for a parameter twice a second, and its statuses and memory are noted. A row
says how long the slowest answer and the longest silence on /diagnostics took, by how much memory grew from the first
third of the time to the last, which verdicts were shown, how many samples the node has taken in since its start, and
how it ended on Ctrl+C.
"""

import argparse
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
import time
from array import array
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from importlib import import_module
from itertools import count
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.benchmarks.live_cost import use_of

from hd_sim_node.demo.plan import free_domain

NODE = "hd_monitor_node"
SETTLED = 20.0
"""Seconds that the node has for import, discovery and its first verdict before a scenario begins."""
ASKED = 0.5
"""Seconds between two requests."""
RIG = ("programme:=strokes", "defect:=flexspline")
FAST = 100.0
TEN_HOURS = 36_000.0 / FAST
"""Seconds in which a rig that is so much faster than real time sends ten hours."""


class Live:
    """A node, a rig, and what is noted of them.

    Parameters
    ----------
    stack : ExitStack
        Ends the processes.
    monitor, rig : sequence of str
        Parameters, as ``name:=value``.
    """

    def __init__(self, stack: ExitStack, monitor: Sequence[str], rig: Sequence[str]) -> None:
        import rclpy
        from diagnostic_msgs.msg import DiagnosticArray
        from rcl_interfaces.srv import GetParameters
        from rclpy.executors import SingleThreadedExecutor

        self._stack, self._rig_parameters = stack, (*RIG, *rig)
        self._log = Path(stack.enter_context(tempfile.TemporaryDirectory())) / "node.log"
        self._environment = os.environ | {"ROS_LOG_DIR": str(self._log.parent)}
        self.monitor = self._start("hd_monitor.ros", monitor)
        self.rig = self._start("hd_sim_node", self._rig_parameters)
        context = rclpy.context.Context()
        rclpy.init(context=context)
        stack.callback(context.try_shutdown)
        self.peer = rclpy.create_node("observer", context=context)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.peer)
        stack.callback(self._executor.shutdown)
        self.peer.create_subscription(DiagnosticArray, "/diagnostics", self._note, 100)
        self._client = self.peer.create_client(GetParameters, f"{NODE}/get_parameters")
        self._request = GetParameters.Request(names=["input.timeout"])
        self._asked: Any = None
        self._asked_at = self._shown_at = 0.0
        self.forget()

    def _start(self, module: str, parameters: Sequence[str]) -> subprocess.Popen[bytes]:
        words = [word for parameter in parameters for word in ("-p", parameter)]
        with self._log.open("ab") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", module, "--ros-args", *words], env=self._environment, stdout=log, stderr=log
            )
        self._stack.callback(process.wait)
        self._stack.callback(process.kill)
        return process

    def restart_rig(self) -> None:
        """Kill the rig as the kernel does, and start another one."""
        self.rig.kill()
        self.rig.wait()
        self.rig = self._start("hd_sim_node", self._rig_parameters)

    def forget(self) -> None:
        """Count from now on."""
        self.slowest = self.silence = 0.0
        self._codes: dict[str, None] = {}
        self._samples = 0
        self._memory: list[float] = []
        self._shown_at = self._asked_at = time.monotonic()
        self._asked = None

    def _note(self, array: Any) -> None:
        now = time.monotonic()
        self.silence, self._shown_at = max(self.silence, now - self._shown_at), now
        for status in array.status:
            values = {pair.key: pair.value for pair in status.values}
            self._codes |= {values["fault_code"]: None}
            self._samples = int(values["samples"])

    def watch(self, seconds: float) -> None:
        """Ask, listen and measure for a time."""
        end = time.monotonic() + seconds
        while (now := time.monotonic()) < end:
            if self._asked is not None:
                self.slowest = max(self.slowest, now - self._asked_at)
                if self._asked.done():
                    self._asked = None
            elif now - self._asked_at > ASKED:
                self._asked_at, self._asked = now, self._client.call_async(self._request)
                self._memory.append(use_of(self.monitor.pid).memory)
            self._executor.spin_once(timeout_sec=0.02)
        self.silence = max(self.silence, time.monotonic() - self._shown_at)

    def end(self) -> str:
        """Interrupt the node; return its row's numbers."""
        self.monitor.send_signal(signal.SIGINT)
        status = self.monitor.wait(60.0)
        shown = ", ".join(self._codes)
        loud = "Traceback" in self._log.read_text(encoding="utf-8", errors="replace")
        third = max(1, len(self._memory) // 3)
        early, late = (sum(part) / len(part) for part in (self._memory[:third], self._memory[-third:]))
        memory = f"{early:.0f} {'+' if late >= early else '-'} {abs(late - early):.1f} MB"
        return (
            f"{self.slowest:.2f} s | {self.silence:.2f} s | {memory} | "
            f"{shown} | {self._samples / 1e6:.1f} million | {status}{', with a traceback' if loud else ''}"
        )


# Scenarios -----------------------------------------------------------------------------------------------------------


def undisturbed(live: Live, seconds: float) -> None:
    live.watch(seconds)


def stopped(live: Live, seconds: float) -> None:
    """Stop the rig, then the node, and let them go on; the time in which the node is stopped does not count."""
    end = time.monotonic() + seconds
    for turn in count():
        process = (live.rig, live.monitor)[turn % 2]
        if time.monotonic() > end:
            return
        process.send_signal(signal.SIGSTOP)
        if process is live.monitor:
            time.sleep(5.0)
            live._shown_at = live._asked_at = time.monotonic()
        else:
            live.watch(5.0)
        process.send_signal(signal.SIGCONT)
        live.watch(10.0)


def killed(live: Live, seconds: float) -> None:
    for _ in _repeatedly(seconds):
        live.restart_rig()
        live.watch(15.0)


def clock_back(live: Live, seconds: float) -> None:
    """Publish /clock and set it back by a minute every ten seconds."""
    clock = _Clock(live)
    for turn in _repeatedly(seconds):
        for _ in range(100):
            clock.publish(time.time() - 60.0 * (turn % 2))
            live.watch(0.1)


def hours(live: Live, seconds: float) -> None:
    """Publish /clock at the rig's speed."""
    clock, begun = _Clock(live), time.monotonic()
    for _ in _repeatedly(seconds):
        clock.publish(time.time() + (FAST - 1.0) * (time.monotonic() - begun))
        live.watch(0.05)


class _Clock:
    """Publishes /clock."""

    def __init__(self, live: Live) -> None:
        self._type: Any = import_module("rosgraph_msgs.msg").Clock
        self._publisher = live.peer.create_publisher(self._type, "/clock", 10)

    def publish(self, seconds: float) -> None:
        from builtin_interfaces.msg import Time

        whole, part = divmod(int(seconds * 1e9), 10**9)
        self._publisher.publish(self._type(clock=Time(sec=whole, nanosec=part)))


def parameters(live: Live, seconds: float) -> None:
    """Set a limit a thousand times."""
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    client = live.peer.create_client(SetParameters, f"{NODE}/set_parameters")
    for number in range(1000):
        value = Parameter("diagnosis.warn_index", value=0.05 + 1e-5 * (number % 2)).to_parameter_msg()
        done = client.call_async(SetParameters.Request(parameters=[value]))
        while not done.done():
            live.watch(0.005)
    live.watch(10.0)


def large(live: Live, seconds: float) -> None:
    """Let another process publish messages of 80 MB where blocks are expected."""
    process = multiprocessing.get_context("spawn").Process(target=_publish_large, args=(seconds,))
    process.start()
    while process.is_alive():
        live.watch(0.1)
    live.watch(10.0)


def _publish_large(seconds: float) -> None:
    import rclpy
    from std_msgs.msg import Float64MultiArray

    rclpy.init()
    publisher = rclpy.create_node("careless").create_publisher(Float64MultiArray, "torsional_acceleration/block", 1)
    message = Float64MultiArray(data=array("d", bytes(80_000_000)))
    for _ in _repeatedly(seconds):
        publisher.publish(message)
        time.sleep(3.0)
    rclpy.shutdown()


def _repeatedly(seconds: float) -> Iterator[int]:
    end, turn = time.monotonic() + seconds, count()
    while time.monotonic() < end:
        yield next(turn)


SCENARIOS: dict[str, tuple[str, Callable[[Live, float], None], float, Sequence[str], Sequence[str]]] = {
    "undisturbed": ("nothing happens", undisturbed, 60.0, (), ()),
    "stopped": ("rig and node are stopped in turn for 5 s, and go on", stopped, 60.0, (), ()),
    "killed": ("the rig is killed and started again every 15 s", killed, 75.0, (), ()),
    "clock": ("/clock jumps back by a minute every 20 s", clock_back, 60.0, ("use_sim_time:=true",), ()),
    "parameters": ("1000 parameters are set", parameters, 0.0, (), ()),
    "fast": ("blocks of 10 kHz", undisturbed, 60.0, (), ("sensor.rate:=10000.0", "block_size:=500")),
    "large": ("messages of 80 MB on the topic of the blocks", large, 40.0, (), ()),
    "hours": (
        "ten hours at 100 times real time, with /clock",
        hours,
        TEN_HOURS,
        ("input.timeout:=200.0", "use_sim_time:=true"),
        (f"time_scale:={FAST}", "block_size:=1000", "joint_states.rate:=20.0"),
    ),
}
"""Name: what happens, how, for how long [s], parameters of the node and of the rig."""


def row(name: str, seconds: float | None) -> str:
    """Run a scenario; return its row."""
    what, happen, usual, monitor, rig = SCENARIOS[name]
    os.environ["ROS_DOMAIN_ID"] = str(free_domain())
    with ExitStack() as stack:
        live = Live(stack, monitor, rig)
        live.watch(SETTLED)
        live.forget()
        happen(live, usual if seconds is None else seconds)
        return f"| {what} | {live.end()} |"


def main() -> None:
    """Run scenarios and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", choices=[*SCENARIOS, []], help="all of them if none is given")
    parser.add_argument("--seconds", type=float, help="that each takes, in place of its own time")
    arguments = parser.parse_args()
    print("| what happens | slowest answer | longest silence | memory | verdicts | samples | exit status |")
    print("|---|---|---|---|---|---|---|")
    for name in arguments.names or SCENARIOS:
        print(row(name, arguments.seconds), flush=True)


if __name__ == "__main__":
    main()

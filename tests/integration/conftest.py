"""A bench with real node processes, and what comes out on /diagnostics."""

import array
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from hd_monitor.cdr import decode_joint_states
from hd_monitor.contract import TORSIONAL_ACCELERATION_BLOCK, Block, pack_block
from hd_monitor.sources import JOINT_STATES

MONITOR, RIG = "hd_monitor.ros", "hd_sim_node"
OK, WARN, ERROR = 0, 1, 2
QUICK = ("time_scale:=10.0", "wait_for_subscribers:=1", "programme:=dwell", "dwell.first:=400.0", "dwell.last:=1000.0")
"""A rig that runs through 400, 500 … 1000 rpm and back in about four seconds."""
NANOSECONDS = 1_000_000_000


@dataclass(frozen=True)
class Shown:
    """One DiagnosticStatus."""

    name: str
    level: int
    message: str
    hardware_id: str
    values: dict[str, str]

    @property
    def component(self) -> str:
        return self.values["component"]

    @property
    def fault_code(self) -> str:
        return self.values["fault_code"]

    def number(self, key: str) -> float:
        return float(self.values[key])


def arguments_of(parameters: tuple[str, ...]) -> list[str]:
    """Turn ``name:=value`` into parameters and ``from->to`` into remappings."""
    words = ["--ros-args"] if parameters else []
    for parameter in parameters:
        words += ["-r", parameter.replace("->", ":=")] if "->" in parameter else ["-p", parameter]
    return words


class Bench:
    """Starts nodes and waits for what they say; a node that dies ends the wait with its own words."""

    def __init__(self, peer: Any, start_module: Callable[..., Any]) -> None:
        from diagnostic_msgs.msg import DiagnosticArray

        self.peer = peer
        self._start_module = start_module
        self._processes: list[Any] = []
        self.statuses: list[Shown] = []
        """Of reducers."""
        self.inputs: list[Shown] = []
        """Of their inputs, each with the status of its reducer at the same place of the other list."""
        self.arrays: list[Any] = peer.collect(DiagnosticArray, "/diagnostics", match=False)
        self._read = 0

    def monitor(self, *parameters: str) -> Any:
        # Loss counts by the stamps, which a rig at ten times real time lets run as fast; and one topic may come seconds
        # later than another where the monitor has yet to find a publisher that has found it.
        return self._start(MONITOR, ("input.timeout:=120.0", "input.startup_timeout:=120.0", *parameters))

    def rig(self, *parameters: str) -> Any:
        return self._start(RIG, parameters)

    def _start(self, module: str, parameters: tuple[str, ...]) -> Any:
        process = self._start_module(module, *arguments_of(parameters))
        self._processes.append(process)
        return process

    def stop(self, process: Any) -> None:
        """End a node that the wait for statuses must not miss."""
        self._processes.remove(process)
        process.interrupt()

    def kill(self, process: Any) -> None:
        """End a node at once, without a chance to put anything in order."""
        self._processes.remove(process)
        process.popen.kill()
        process.popen.wait()

    def forget(self) -> None:
        """Let only what comes from now on count."""
        self._update()
        self.statuses.clear()
        self.inputs.clear()

    def _update(self) -> None:
        for message in self.arrays[self._read :]:
            for status in message.status:
                values = {pair.key: pair.value for pair in status.values}
                shown = Shown(status.name, int.from_bytes(status.level), status.message, status.hardware_id, values)
                (self.statuses if status.name.endswith(" reducer") else self.inputs).append(shown)
        self._read = len(self.arrays)

    def until(self, condition: Callable[[], object], what: str) -> None:
        def met() -> object:
            self._update()
            for process in self._processes:
                if not process.running:
                    pytest.fail(f"a node ended while the test waited for {what}:\n{process.output}")
            return condition()

        try:
            self.peer.until(met, what)
        except pytest.fail.Exception as failure:
            last = (self.statuses[-1], self.inputs[-1]) if self.statuses else "none at all"
            pytest.fail(f"{failure}\nlast statuses: {last}")

    def until_status(self, accepts: Callable[[Shown], object], what: str) -> Shown:
        """Wait for a status of a reducer and return it."""
        return self._until(self.statuses, accepts, what)

    def until_input(self, accepts: Callable[[Shown], object], what: str) -> Shown:
        """Wait for a status of an input and return it."""
        return self._until(self.inputs, accepts, what)

    def _until(self, statuses: list[Shown], accepts: Callable[[Shown], object], what: str) -> Shown:
        checked = 0
        found: list[Shown] = []

        def met() -> bool:
            nonlocal checked
            found.extend(status for status in statuses[checked:] if accepts(status))
            checked = len(statuses)
            return bool(found)

        self.until(met, what)
        return found[0]


@pytest.fixture
def bench(peer: Any, start_module: Callable[..., Any]) -> Bench:
    """Give a bench on this test process's own ROS domain."""
    return Bench(peer, start_module)


class Feeder:
    """Publishes vibration blocks and joint states of a joint that turns evenly, made by hand."""

    RATE, SAMPLES, SPEED = 1000, 50, 750.0  # Hz, samples a block, rpm

    def __init__(
        self,
        peer: Any,
        *,
        namespace: str = "",
        joint: str = "joint",
        qos: Any = None,
        block_topic: str = TORSIONAL_ACCELERATION_BLOCK,
    ) -> None:
        from rclpy.qos import QoSProfile
        from sensor_msgs.msg import JointState
        from std_msgs.msg import Float64MultiArray

        self._peer = peer
        self._joint = joint
        qos = qos or QoSProfile(depth=1000)
        self.blocks = peer.node.create_publisher(Float64MultiArray, f"{namespace}{block_topic}", qos)
        self.motion = peer.node.create_publisher(JointState, f"{namespace}joint_states", qos)
        self._sequence = 0
        self._start = peer.node.get_clock().now().nanoseconds

    def matched(self) -> bool:
        return bool(self.blocks.get_subscription_count() and self.motion.get_subscription_count())

    def block(self, samples: Any = None, *, label: str | None = None) -> Any:
        """Return the next block: a plain sine, the samples given, or a wrong label."""
        from std_msgs.msg import Float64MultiArray, MultiArrayDimension

        stamp = self._start + self._sequence * self.SAMPLES * NANOSECONDS // self.RATE
        times = (stamp - self._start) / NANOSECONDS + np.arange(self.SAMPLES) / self.RATE
        values = np.sin(2 * np.pi * 2 * self.SPEED / 60 * times) if samples is None else samples
        dimension, data = pack_block(Block(stamp, 1 / self.RATE, self._sequence, values))
        message = Float64MultiArray(data=array.array("d", data.tobytes()))
        message.layout.data_offset = 4
        message.layout.dim = [
            MultiArrayDimension(label=label or dimension.label, size=dimension.size, stride=dimension.stride)
        ]
        return message

    def send(self, blocks: int = 20, *, label: str | None = None, samples: Any = None, motion: bool = True) -> None:
        """Publish some blocks and the joint states of the same time."""
        from sensor_msgs.msg import JointState

        for _ in range(blocks):
            start = self._sequence * self.SAMPLES / self.RATE
            self.blocks.publish(self.block(samples, label=label))
            for step in range(5):
                time = start + step * self.SAMPLES / self.RATE / 5
                speed = self.SPEED * 2 * np.pi / 60 / 80
                message = JointState(name=[self._joint], position=[speed * time], velocity=[speed], effort=[10.0])
                stamp = self._start + round(time * NANOSECONDS)
                message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, NANOSECONDS)
                if motion:
                    self.motion.publish(message)
            self._sequence += 1


@pytest.fixture
def feeder(peer: Any) -> Feeder:
    """Give a feeder of hand-made messages."""
    return Feeder(peer)


def feed_until(bench: Bench, feeder: Feeder, samples: int) -> None:
    # What comes before both topics are heard has no counterpart on the other, for which the monitor would wait.
    bench.until(feeder.matched, "the monitor's subscriptions")

    def counted() -> bool:
        feeder.send(2)
        return bool(bench.statuses) and bench.statuses[-1].number("samples") >= samples

    bench.until(counted, f"{samples} samples")


class TorqueSensor:
    """Publishes a wrench 3 ms after every joint state that it hears: -10 N·m about x."""

    DELAY = 3_000_000  # ns

    def __init__(self, peer: Any) -> None:
        from geometry_msgs.msg import WrenchStamped

        from hd_monitor.ros.subscriptions import DrainedSubscription

        self._states = DrainedSubscription(
            peer.node, JOINT_STATES.topic, JOINT_STATES.type, depth=5000, reliability="reliable"
        )
        self._wrenches = peer.publisher(WrenchStamped, "wrench", match=False)

    def measure(self) -> None:
        """Publish what is due."""
        from geometry_msgs.msg import WrenchStamped

        groups, _ = decode_joint_states(self._states.drain())
        for stamp in np.concatenate([np.empty(0, np.int64), *(group.stamps for group in groups)]).tolist():
            message = WrenchStamped()
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp + self.DELAY, NANOSECONDS)
            message.wrench.torque.x, message.wrench.force.z = -10.0, 250.0
            self._wrenches.publish(message)

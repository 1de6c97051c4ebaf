"""What every test shares: ROS 2 on a domain of its own, spun by hand, and node processes that are ended again."""

import importlib.util
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import hypothesis
import pytest

from hd_monitor.process import set_up_process

set_up_process()  # as every process of ours does; those started by tests inherit it

HAVE_ROS = importlib.util.find_spec("rclpy") is not None
NO_ROS = "rclpy is not installed here: no ROS 2 to test on"
DOMAINS = range(1, 102)  # above them, DDS ports run into the system's ephemeral ones
FIRST_LOCK_PORT = 22_300
PATIENCE = 60.0
"""Seconds after which a wait counts as hanging: a guard against a stuck run, not a measure of speed."""

_reserved: list[socket.socket] = []

# The same examples in every run, and no verdict on how fast the machine is: what fails, fails for everyone.
hypothesis.settings.register_profile("project", deadline=None, derandomize=True)
hypothesis.settings.load_profile("project")


def _reserve_domain() -> int:
    """Take a domain that no other test process on this machine has, by binding a port that stands for it."""
    for attempt in range(len(DOMAINS)):
        domain = DOMAINS[(os.getpid() + attempt) % len(DOMAINS)]
        lock = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            lock.bind(("127.0.0.1", FIRST_LOCK_PORT + domain))
        except OSError:
            lock.close()
            continue
        _reserved.append(lock)
        return domain
    raise pytest.UsageError("no free ROS_DOMAIN_ID: are a hundred test processes running on this machine?")


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Share folders of tests among the processors; a few files are done sooner in one process, and can be debugged."""
    return 0 if any(".py" in argument for argument in config.args) else min(len(os.sched_getaffinity(0)), 4)


def pytest_configure(config: pytest.Config) -> None:
    """Set the environment before anything imports rclpy; node processes inherit it."""
    os.environ["ROS_DOMAIN_ID"] = str(_reserve_domain())
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["ROS_PYTHON_CHECK_FIELDS"] = "1"
    os.environ.setdefault("ROS_LOG_DIR", str(Path(tempfile.gettempdir()) / "hd_monitor-test-logs"))
    # A shell lets its background jobs ignore Ctrl+C, and they hand that down: tests that send it would wait forever.
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Give the domain back."""
    while _reserved:
        _reserved.pop().close()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip what needs ROS where there is none, and for no other reason."""
    if not HAVE_ROS:
        for item in items:
            if item.get_closest_marker("ros"):
                item.add_marker(pytest.mark.skip(reason=NO_ROS))


class Peer:
    """A node of the test's own; it lives only while the test waits for something.

    Attributes
    ----------
    node : rclpy.node.Node
    """

    def __init__(self, context: Any, name: str) -> None:
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        self.context = context
        self.node = Node(name, context=context)
        self.executor = SingleThreadedExecutor(context=context)
        self.executor.add_node(self.node)

    def until(self, condition: Callable[[], object], what: str) -> None:
        """Spin until `condition` holds; fail with `what` was waited for if it never does."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > deadline:
                pytest.fail(f"waited {PATIENCE:g} s for {what}")
            self.executor.spin_once(timeout_sec=0.05)

    def collect(self, message_type: Any, topic: str, *, depth: int = 10_000, match: bool = True) -> list[Any]:
        """Subscribe (reliable) and return the list that received messages are appended to, once a publisher matched."""
        from rclpy.qos import QoSProfile

        received: list[Any] = []
        subscription = self.node.create_subscription(message_type, topic, received.append, QoSProfile(depth=depth))
        if match:
            self.until(lambda: subscription.get_publisher_count() > 0, f"a publisher of {topic}")
        return received

    def publisher(self, message_type: Any, topic: str, *, depth: int = 10_000, match: bool = True) -> Any:
        """Publisher (reliable) on `topic`, returned once a subscription matched."""
        from rclpy.qos import QoSProfile

        publisher = self.node.create_publisher(message_type, topic, QoSProfile(depth=depth))
        if match:
            self.until(lambda: publisher.get_subscription_count() > 0, f"a subscription of {topic}")
        return publisher

    def call(self, service_type: Any, name: str, request: Any) -> Any:
        """Call a service of a node once and return its response."""
        client = self.node.create_client(service_type, name)
        self.until(client.service_is_ready, f"the service {name}")
        self._await_discovery(name.split("/", maxsplit=1)[0])
        future = client.call_async(request)
        self.until(future.done, f"an answer of the service {name}")
        self.node.destroy_client(client)
        return future.result()

    def _await_discovery(self, node: str) -> None:
        """Wait until `node` knows every client created here so far.

        A ready service says that the client knows the server. The server may yet have to discover where its answers
        go, and the middleware drops an answer it cannot deliver. Readers are announced in order: once any answer
        reaches a client made later, the earlier ones are known too. The question asked until then changes nothing.
        """
        from rcl_interfaces.srv import GetParameters

        probe = self.node.create_client(GetParameters, f"{node}/get_parameters")
        self.until(probe.service_is_ready, f"the parameter services of {node}")
        asked = -float("inf")
        answers: list[Any] = []

        def answered() -> bool:
            nonlocal asked
            if time.monotonic() > asked + 1.0:
                asked = time.monotonic()
                answers.append(probe.call_async(GetParameters.Request()))
            return any(answer.done() for answer in answers)

        self.until(answered, f"{node} to discover its clients")
        self.node.destroy_client(probe)

    def close(self) -> None:
        """Take the node out of the graph."""
        self.executor.shutdown()
        self.node.destroy_node()


@pytest.fixture
def ros_context() -> Iterator[Any]:
    """Give a ROS context of the test's own on this process's isolated domain."""
    rclpy = pytest.importorskip("rclpy", reason=NO_ROS)
    context = rclpy.context.Context()
    rclpy.init(context=context)
    yield context
    context.try_shutdown()


@pytest.fixture
def peer(ros_context: Any) -> Iterator[Peer]:
    """Give a node to publish, subscribe and call from."""
    peer = Peer(ros_context, "test_peer")
    yield peer
    peer.close()


class Process:
    """A node or command as a real process; its output is kept for the failure message.

    Attributes
    ----------
    popen : subprocess.Popen
    command : str
    """

    def __init__(self, arguments: Sequence[str], log: Path, cwd: Path) -> None:
        self._log = log
        self._interrupted = False
        self.command = " ".join(arguments)
        with log.open("wb") as output:
            self.popen = subprocess.Popen(
                arguments, stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, cwd=cwd
            )

    @property
    def output(self) -> str:
        """What it has printed so far, both streams."""
        return self._log.read_text(encoding="utf-8", errors="replace")

    @property
    def running(self) -> bool:
        """Whether it has not ended yet."""
        return self.popen.poll() is None

    def wait(self) -> int:
        """Wait for it to end by itself and return its status."""
        return self.popen.wait(PATIENCE)

    def send_interrupt(self) -> None:
        """Ask it to end, once, as Ctrl+C does."""
        if self.running and not self._interrupted:
            self.popen.send_signal(signal.SIGINT)
        self._interrupted = True

    def interrupt(self) -> int:
        """End it as Ctrl+C does and return its status."""
        self.send_interrupt()
        try:
            return self.popen.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.popen.kill()
            self.popen.wait()
            pytest.fail(f"does not end on Ctrl+C: {self.command}\n{self.output}")


@pytest.fixture
def start_module(tmp_path: Path) -> Iterator[Callable[..., Process]]:
    """Start ``python -m MODULE ARGUMENTS…`` on this process's domain; whatever still runs at the end is interrupted."""
    started: list[Process] = []

    def start(module: str, *arguments: str) -> Process:
        # -P and a foreign working directory: the installed packages are what runs, as for a user.
        command = [sys.executable, "-P", "-m", module, *arguments]
        process = Process(command, tmp_path / f"{module}-{len(started)}.log", tmp_path)
        started.append(process)
        return process

    yield start
    for process in started:  # all of them before the first is waited for: they end side by side
        process.send_interrupt()
    for process in started:
        process.interrupt()
        print(f"--- {process.command}\n{process.output}")  # pytest shows it where the test failed

"""Node processes that a command starts, watches and always ends."""

import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import IO, Self

from ..errors import HdMonitorError

PATIENCE = 5.0
"""Seconds that a process has to end after each request: as by Ctrl+C, then terminate, then kill."""


class ChildError(HdMonitorError):
    """A process ended although it was still needed."""


class _Child:
    def __init__(self, name: str, module: str, arguments: Sequence[str], environment: Mapping[str, str]) -> None:
        self.name = name
        self.output: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115  read again when the process has ended
        # A session of its own: Ctrl+C in the terminal is for the command, which then ends its children in order.
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", module, *arguments],
            env=dict(environment),
            stdin=subprocess.DEVNULL,
            stdout=self.output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def read_output(self) -> str:
        self.output.seek(0)
        return self.output.read().decode(errors="replace").strip()


class Children:
    """Processes that live as long as the ``with`` block around them.

    Parameters
    ----------
    environment : mapping of str to str
        Theirs.
    """

    def __init__(self, environment: Mapping[str, str]) -> None:
        self._environment = environment
        self._children: list[_Child] = []

    def __enter__(self) -> Self:
        """Start with none."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End all that still run."""
        self.stop()

    def start(self, name: str, module: str, *arguments: str) -> int:
        """Start ``python -m module arguments…``, called `name` in messages, and return its process number."""
        child = _Child(name, module, arguments, self._environment)
        self._children.append(child)
        return child.process.pid

    def check(self) -> None:
        """Raise if one has ended.

        Raises
        ------
        ChildError
            With the process's own last words.
        """
        for child in self._children:
            status = child.process.poll()
            if status is not None:
                words = child.read_output() or "it said nothing"
                raise ChildError(f"{child.name} ended with status {status}:\n{words}")

    def stop(self) -> None:
        """Interrupt all, wait, and force those that do not end."""
        for request in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            running = [child.process for child in self._children if child.process.poll() is None]
            for process in running:
                process.send_signal(request)
            for process in running:
                try:
                    process.wait(PATIENCE)
                except subprocess.TimeoutExpired:
                    continue
        for child in self._children:
            child.output.close()
        self._children = []

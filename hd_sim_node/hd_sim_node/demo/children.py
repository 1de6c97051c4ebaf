"""Node processes that a command starts, watches and always ends."""

import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from contextlib import AbstractContextManager, suppress
from typing import IO

from hd_monitor.errors import FAILED, HdMonitorError

PATIENCE = 5.0
"""Seconds that a process has to end after each request: as by Ctrl+C, then terminate, then kill."""


class DemoError(HdMonitorError):
    """A process ended although it was still needed, or the monitor has stopped reporting."""

    status = FAILED


class Children(AbstractContextManager["Children"]):
    """Processes, with these environment variables, that live as long as the ``with`` block around them."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        self._environment = environment
        self._children: dict[str, tuple[subprocess.Popen[bytes], IO[bytes]]] = {}

    def __exit__(self, *error: object) -> None:
        """Interrupt all, wait, and force those that do not end."""
        for request in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            for process, _ in self._children.values():
                process.send_signal(request)  # does nothing where the process has ended
            for process, _ in self._children.values():
                with suppress(subprocess.TimeoutExpired):
                    process.wait(PATIENCE)
        for _, output in self._children.values():
            output.close()

    def start(self, name: str, module: str, *arguments: str) -> int:
        """Start ``python -m module arguments…``, called `name` in messages, and return its process number."""
        output = tempfile.TemporaryFile()  # noqa: SIM115  read when the process has ended, closed with the block
        # A session of its own: Ctrl+C in the terminal is for the command, which then ends its children in order.
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", module, *arguments],
            env=self._environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        self._children[name] = process, output
        return process.pid

    def check(self) -> None:
        """Raise if one has ended.

        Raises
        ------
        DemoError
            With the process's own output.
        """
        for name, (process, output) in self._children.items():
            status = process.poll()
            if status is not None:
                output.seek(0)
                text = output.read().decode(errors="replace").strip() or "it printed nothing"
                raise DemoError(f"{name} ended with status {status}:\n{text}")

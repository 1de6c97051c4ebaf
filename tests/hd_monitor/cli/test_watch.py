"""The watch command: a terminal of its own, and one clear line where there is none."""

import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

from hd_monitor.cli.main import main

PATIENCE = 60.0


class Terminal:
    """The command in a terminal of 80 columns and 24 lines."""

    def __init__(self, *words: str) -> None:
        self._own, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        self._process = subprocess.Popen(
            [sys.executable, "-m", "hd_monitor.cli.main", "watch", *words],
            stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True,
            env=os.environ | {"TERM": "xterm-256color", "COLUMNS": "80", "LINES": "24"},
        )  # fmt: skip
        os.close(theirs)
        self.output = b""

    def until(self, text: bytes) -> None:
        """Read until the command has written `text`."""
        deadline = time.monotonic() + PATIENCE
        while text not in self.output:
            ready, _, _ = select.select([self._own], [], [], max(deadline - time.monotonic(), 0.0))
            if not ready or not (new := self._read()):
                pytest.fail(f"no {text!r} came: {self.output[-2000:]!r}")
            self.output += new

    def _read(self) -> bytes:
        try:
            return os.read(self._own, 65536)
        except OSError:  # the other end is closed
            return b""

    def press(self, key: bytes) -> int:
        """Press a key that ends the command; return its status."""
        os.write(self._own, key)
        while new := self._read():
            self.output += new
        os.close(self._own)
        return self._process.wait(PATIENCE)


@pytest.mark.parametrize("key", [b"q", b"\x03"], ids=["q", "Ctrl+C"])
def test_a_recording_in_a_real_terminal(recording: Path, key: bytes) -> None:
    terminal = Terminal("--bag", str(recording))
    terminal.until(b"flexspline")
    terminal.until(b"q: quit")
    assert terminal.press(key) == 0
    assert b"Traceback" not in terminal.output
    assert terminal.output.rfind(b"\x1b[?1049l") > terminal.output.rfind(b"\x1b[?1049h")  # the old screen is back


@pytest.mark.ros
def test_live_in_a_real_terminal() -> None:
    terminal = Terminal()
    terminal.until(b"No joint has been heard of yet")
    assert terminal.press(b"q") == 0


def test_without_a_terminal_it_says_what_to_use_instead(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["watch", "--bag", str(recording)]) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert "needs a terminal" in line
    assert "hd-monitor replay" in line


def test_an_unusable_recording_is_one_line_in_the_terminal(tmp_path: Path) -> None:
    terminal = Terminal("--bag", str(tmp_path / "nothing"))
    terminal.until(b"does not exist")
    assert terminal.press(b"") == 2
    assert b"\x1b[?1049h" not in terminal.output


def test_an_impossible_domain_is_one_line() -> None:
    terminal = Terminal("--domain", "233")
    terminal.until(b"233 is not a ROS_DOMAIN_ID; give 0 to 232")
    assert terminal.press(b"") == 2

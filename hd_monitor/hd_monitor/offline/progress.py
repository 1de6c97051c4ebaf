"""Progress of long replays: one line on a terminal, rewritten; a line every few seconds elsewhere."""

import math
import sys
import time

from ..contract import NANOSECONDS
from .bag import Bag
from .batches import Window

_ON_TERMINAL = 0.2
_ELSEWHERE = 5.0
_FIRST = 1.0
"""Seconds between two lines; a replay that takes less than the last shows none."""
_WIPE = "\r\x1b[2K"


class ProgressLine:
    """Writes to standard error how far a replay is; to be called after each window of messages.

    Parameters
    ----------
    bag : Bag
    """

    def __init__(self, bag: Bag) -> None:
        self._bag = bag
        self._terminal = sys.stderr.isatty()
        self._began = time.monotonic()
        self._next = self._began + (_FIRST if self._terminal else _ELSEWHERE)
        self._first: int | None = None

    def __call__(self, window: Window) -> None:
        """Show the progress if it is time to."""
        self._first = window.start if self._first is None else self._first
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + (_ON_TERMINAL if self._terminal else _ELSEWHERE)
        done = (window.end - self._first) / NANOSECONDS
        text = f"{done:.0f} s of the recording, {done / (now - self._began):.0f} times real time"
        first, last = self._bag.span or (0, 0)
        if last > first:
            part = min((window.end - first) / (last - first), 1.0)
            left = (now - self._began) * (1.0 / part - 1.0) if part > 0.0 else math.nan
            text = f"{part:4.0%}: {text}" + (f", {left:.0f} s left" if math.isfinite(left) else "")
        sys.stderr.write(f"{_WIPE}{text}" if self._terminal else f"{text}\n")
        sys.stderr.flush()

    def close(self) -> None:
        """Wipe the line off a terminal."""
        if self._terminal:
            sys.stderr.write(_WIPE)
            sys.stderr.flush()

"""The next period of the message stamps that is complete on all inputs."""

from collections.abc import Sequence
from typing import NamedTuple

from .stream import StampedBuffer


class Window(NamedTuple):
    """A period to assess: its bounds [ns], and whether it starts on another time base than the one before."""

    start: int
    end: int
    cut: bool


class Timeline:
    """Cuts the stamps' time axis into whole periods and hands out those that are complete.

    Parameters
    ----------
    inputs : sequence of StampedBuffer
        The inputs that an assessment needs.
    period, timeout : int
        Length of a period, and silence after which the others stop waiting for an input [ns].
    """

    def __init__(self, inputs: Sequence[StampedBuffer], period: int, timeout: int) -> None:
        self._inputs = tuple(inputs)
        self._period = period
        self._timeout = timeout
        self._start: int | None = None
        self._cut = False
        self.epoch = 0

    def next(self) -> Window | None:
        """Return the next complete period, or None while more data is awaited."""
        while True:
            start = self._start if self._start is not None else self._first_start()
            if start is not None:
                start = self._skip_empty(start)
                if self._complete(start + self._period):
                    return self._hand_out(start)
            if not self._pass_jump():
                return None

    def rest(self) -> Window | None:
        """Return the period of the oldest data even though it is not complete: for the end of a recording."""
        oldest = [buffer.oldest for buffer in self._inputs if buffer.oldest is not None]
        if not oldest:
            return None
        return self._hand_out(min(oldest) // self._period * self._period)

    def _hand_out(self, start: int) -> Window:
        if self._start is None:
            self.epoch = start
            self._cut = True
        window = Window(start, start + self._period, self._cut)
        self._start, self._cut = start + self._period, False
        return window

    def _first_start(self) -> int | None:
        """Begin at the earliest sample once all inputs have some, or one has waited for the others long enough."""
        oldest = [buffer.oldest for buffer in self._inputs if buffer.oldest is not None]
        if not oldest:
            return None
        newest = max(buffer.newest or 0 for buffer in self._inputs)
        if len(oldest) < len(self._inputs) and newest - min(oldest) < self._timeout:
            return None
        return min(oldest) // self._period * self._period

    def _skip_empty(self, start: int) -> int:
        """Jump over a time in which no input has anything."""
        oldest = None
        for buffer in self._inputs:
            if buffer.oldest is not None and (oldest is None or buffer.oldest < oldest):
                oldest = buffer.oldest
        if oldest is not None and oldest >= start + self._period:
            return oldest // self._period * self._period
        return start

    def _complete(self, end: int) -> bool:
        newest = None
        waiting = some = False
        for buffer in self._inputs:
            until = buffer.complete_until
            if (until is None or until < end) and not self._ended(buffer):
                waiting = True
            if buffer.newest is not None and (newest is None or buffer.newest > newest):
                newest = buffer.newest
            some = some or (buffer.oldest is not None and buffer.oldest < end)
        given_up = newest is not None and newest >= end + self._timeout
        return some and (given_up or not waiting)

    def _ended(self, buffer: StampedBuffer) -> bool:
        """Whether a buffer's clock was set back: nothing more will come on the old time base."""
        return buffer.jumped

    def _pass_jump(self) -> bool:
        """Go on to the new time base once all inputs have jumped, or one has left the others waiting long enough."""
        jumped = [buffer for buffer in self._inputs if buffer.jumped]
        if not jumped:
            return False
        waited = max(buffer.seconds_after_jump for buffer in jumped) * 1e9 >= self._timeout
        if len(jumped) < len(self._inputs) and not waited:
            return False
        for buffer in jumped:
            buffer.pass_jump()
        self._start = None
        return True

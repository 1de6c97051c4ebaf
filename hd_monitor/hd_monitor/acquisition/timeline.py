"""The periods of the message stamps, handed out as soon as they are complete on all inputs."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from ..sources import Quantity
from .stream import Samples, StampedBuffer


@dataclass(frozen=True, slots=True, kw_only=True)
class Period:
    """The samples of one period.

    Attributes
    ----------
    epoch, start, end : int
        Zero of the core's times, and the period's bounds [ns].
    cut : bool
        Whether it starts on another time base than the one before.
    samples, following : dict of Quantity to Samples
        Those of the period, and the first one after it, or none: it closes the interpolation. Values in columns:
        θ'' [rad/s²]; position [rad], velocity [rad/s] and effort [N·m]; torque [N·m].
    """

    epoch: int
    start: int
    end: int
    cut: bool
    samples: dict[Quantity, Samples]
    following: dict[Quantity, Samples]


class Timeline:
    """Cuts the stamps' time axis into whole periods and hands out those that are complete.

    Parameters
    ----------
    buffers : mapping of Quantity to StampedBuffer
        What has come in; periods are taken out of it.
    needed : collection of Quantity
        The inputs that an assessment needs.
    period, timeout : int
        Length of a period, and silence after which the others stop waiting for an input [ns].

    Attributes
    ----------
    timeout : int
        As given; may be changed at any time.
    """

    def __init__(
        self,
        buffers: Mapping[Quantity, StampedBuffer],
        needed: Collection[Quantity],
        period: int,
        timeout: int,
    ) -> None:
        self._buffers = buffers
        self._inputs = [buffers[quantity] for quantity in needed]
        self._period = period
        self.timeout = timeout
        self._start: int | None = None
        self._epoch = 0

    def next(self) -> Period | None:
        """Take out the next complete period, or return None while more data is awaited."""
        while True:
            if (span := self._span()) is not None:
                start = self._next_start(*span)
                if start is not None and self._complete(start + self._period, *span):
                    return self._take(start)
            if not self._pass_jump():
                return None

    def rest(self) -> Period | None:
        """Take out the period of the oldest data even though it is not complete: for the end of a recording."""
        span = self._span()
        return None if span is None else self._take(span[0] // self._period * self._period)

    def _take(self, start: int) -> Period:
        cut, end = self._start is None, start + self._period
        if cut:
            self._epoch = start
        self._start = end
        samples = {quantity: buffer.take(end) for quantity, buffer in self._buffers.items()}
        return Period(
            epoch=self._epoch,
            start=start,
            end=end,
            cut=cut,
            samples=samples,
            following={quantity: buffer.peek_first() for quantity, buffer in self._buffers.items()},
        )

    def _span(self) -> tuple[int, int] | None:
        """Earliest stamp still here and latest one that came [ns]; None if nothing is here."""
        oldest = [stamp for buffer in self._inputs if (stamp := buffer.oldest) is not None]
        newest = [stamp for buffer in self._inputs if (stamp := buffer.newest) is not None]
        return (min(oldest), max(newest)) if oldest else None

    def _next_start(self, oldest: int, newest: int) -> int | None:
        """Begin at the earliest sample, once all inputs have some or one has waited for the others long enough.

        Later, continue where the last period ended, or jump over a time in which no input has anything.
        """
        first = oldest // self._period * self._period
        if self._start is not None:
            return max(first, self._start)
        waiting = any(buffer.oldest is None for buffer in self._inputs)
        return None if waiting and newest - oldest < self.timeout else first

    def _complete(self, end: int, oldest: int, newest: int) -> bool:
        """Whether there is something before `end` [ns], and nothing more will come."""
        if oldest >= end:
            return False
        waiting = any(
            (buffer.complete_until is None or buffer.complete_until < end) and not buffer.jumped
            for buffer in self._inputs
        )
        return not waiting or newest >= end + self.timeout

    def _pass_jump(self) -> bool:
        """Switch to the new time base once all inputs have jumped, or one has left the others waiting long enough."""
        jumped = [buffer for buffer in self._inputs if buffer.jumped]
        if not jumped:
            return False
        waited = max(buffer.seconds_after_jump for buffer in jumped) * 1e9 >= self.timeout
        if len(jumped) < len(self._inputs) and not waited:
            return False
        for buffer in jumped:
            buffer.pass_jump()
        self._start = None
        return True

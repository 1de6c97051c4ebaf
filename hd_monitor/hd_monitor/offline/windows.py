"""Windows: a recording cut into pieces of a few seconds, which is what a monitor is fed with."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from .batches import Batch


class Window(NamedTuple):
    """Messages of a few seconds: times of recording of the first and the last one [ns], and their bytes by topic."""

    start: int
    end: int
    messages: dict[str, list[bytes]]


def windows(batches: Iterable[Batch], *, length: int, most: int, pause: int) -> Iterator[Window]:
    """Yield windows of messages in the order of `batches`.

    Parameters
    ----------
    batches : iterable of Batch
    length : int
        Time [ns] after a window's first message that the next window begins at the latest; it also begins where time
        goes back before that first message.
    most : int
        Messages that a window holds at most.
    pause : int
        Time [ns] without a message that begins a new window.
    """
    collected: dict[str, list[bytes]] = {}
    opened = latest = count = 0
    for batch in batches:
        times = batch.times
        # Unsigned times that go back look like a pause; that splits the work there, but not the window.
        pauses = np.flatnonzero(times[1:] - times[:-1] >= pause) + 1
        at = 0
        while at < len(times):
            time = int(times[at])
            if count and (count >= most or not opened <= time < opened + length or time - latest >= pause):
                yield Window(opened, latest, collected)
                collected, count = {}, 0
            if not count:
                opened = time
            pauses = pauses[np.searchsorted(pauses, at, "right") :]
            stop = min(at + most - count, int(pauses[0]) if pauses.size else len(times))
            span = times[at:stop]
            outside = (span < opened) | (span >= opened + length)
            if outside.any():
                stop = at + int(outside.argmax())
            _collect(collected, batch, at, stop)
            latest = int(times[stop - 1])
            count += stop - at
            at = stop
    if count:
        yield Window(opened, latest, collected)


def _collect(collected: dict[str, list[bytes]], batch: Batch, begin: int, end: int) -> None:
    topics = batch.topics[begin:end]
    for number, name in enumerate(batch.names):
        chosen = np.flatnonzero(topics == number) + begin
        if chosen.size:
            collected.setdefault(name, []).extend(map(batch.data.__getitem__, chosen.tolist()))

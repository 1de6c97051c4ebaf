"""Messages handed on by the thousand, as columns: what costs little for one message costs much for a million."""

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from .compression import MAGIC, decompress
from .errors import one_line

ROWS = 4096
"""Messages taken at once from a source that gives them one by one."""


class RawTopic(NamedTuple):
    """A topic: its name, its type as ``package/msg/Type`` and the number of its messages."""

    name: str
    type: str
    messages: int


class RawMessage(NamedTuple):
    """A serialised message: its topic, the time it was recorded at [ns] and its bytes."""

    topic: str
    time: int
    data: bytes


class Window(NamedTuple):
    """Messages without a pause: times of recording of the first and the last one [ns], and their bytes by topic."""

    start: int
    end: int
    messages: dict[str, list[bytes]]


class Batch(NamedTuple):
    """Messages in the order of the recording, in columns of shape (messages,)."""

    times: NDArray[np.integer[Any]]
    """Times of recording [ns]."""
    topics: NDArray[np.intp]
    """Of each message the place of its topic among those wanted."""
    data: NDArray[np.object_]
    """Serialised messages, as bytes."""

    @classmethod
    def of_rows(cls, rows: Iterable[tuple[int, int, bytes]]) -> Self:
        """Turn messages, at least one, into columns."""
        times, topics, data = zip(*rows, strict=True)
        kind = np.int64 if max(times) < 2**63 else np.uint64  # MCAP counts to 2**64, and damage makes use of it
        return cls(np.array(times, kind), np.array(topics), np.array(data, dtype=np.object_))

    def part(self, which: NDArray[Any] | slice) -> Self:
        """Return some of the messages, or all in another order."""
        return type(self)(self.times[which], self.topics[which], self.data[which])

    def unpacked(self, limit: int, lost: Callable[[int, str], None]) -> Iterator[Self]:
        """Yield the messages with those decompressed that are compressed, which their first bytes tell.

        Parameters
        ----------
        limit : int
            Bytes to which a message may expand; several batches are yielded where they do so together.
        lost : callable
            Told of each message that cannot be decompressed the place of its topic, and why.
        """
        if not (self.data >= MAGIC).any():  # no CDR message is: it begins with 0
            yield self
            return
        data, size = self.data.copy(), 0
        rows: list[int] = []
        for row, packed in enumerate(self.data):
            if packed.startswith(MAGIC):
                try:
                    data[row] = decompress("zstd", packed, limit)
                except Exception as error:  # the class is the decompressor's own
                    lost(int(self.topics[row]), one_line(error))
                    continue
            size += len(data[row])
            if size > limit and rows:
                yield type(self)(self.times[rows], self.topics[rows], data[rows])
                data[rows], rows, size = None, [], len(data[row])
            rows.append(row)
        if rows:
            yield type(self)(self.times[rows], self.topics[rows], data[rows])

    def windows(self, names: Sequence[str], pause: int) -> Iterator[Window]:
        """Yield the messages by the names of their topics; a `pause` [ns], unless 0, begins a new window."""
        # Unsigned times that go back look like a pause: one window more does no harm.
        steps = self.times[1:] - self.times[:-1]
        pauses = (np.flatnonzero(steps >= pause) + 1).tolist() if pause else []
        for bounds in itertools.pairwise([0, *pauses, len(self.times)]):
            times, topics, data = self.part(slice(*bounds))
            found = {name: data[topics == place].tolist() for place, name in enumerate(names)}
            if len(times):
                yield Window(int(times[0]), int(times[-1]), {name: own for name, own in found.items() if own})


def in_batches(rows: Iterable[tuple[int, int, bytes]]) -> Iterator[Batch]:
    """Yield the messages that `rows` gives as time, place of the topic and bytes."""
    return map(Batch.of_rows, itertools.batched(rows, ROWS))

"""Messages handed on by the thousand, as columns: what costs little for one message costs much for a million."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

ROWS = 1024
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


class Batch(NamedTuple):
    """Messages in the order of the recording.

    Attributes
    ----------
    times : numpy.ndarray
        Times of recording [ns].
    topics : numpy.ndarray
        Of each message the place of its topic in `names`.
    names : sequence of str
    data : list of bytes
    """

    times: NDArray[np.int64] | NDArray[np.uint64]
    topics: NDArray[np.intp]
    names: list[str]
    data: list[bytes]

    def counts(self) -> Counter[str]:
        """Return how many messages there are of each topic."""
        return Counter(dict(zip(self.names, np.bincount(self.topics, minlength=len(self.names)).tolist(), strict=True)))

    def rows(self) -> Iterator[RawMessage]:
        """Yield the messages one by one."""
        return map(RawMessage, map(self.names.__getitem__, self.topics.tolist()), self.times.tolist(), self.data)

    @classmethod
    def of_rows(cls, rows: Iterable[tuple[Any, int, bytes]], name: Callable[[Any], str]) -> Self:
        """Turn messages, at least one, into columns; `name` gives the topic from the key that stands in its place."""
        sources, times, data = zip(*rows, strict=True)
        topics = {source: name(source) for source in dict.fromkeys(sources)}
        names = list(dict.fromkeys(topics.values()))
        place = {source: names.index(topic) for source, topic in topics.items()}
        try:
            stamps = np.fromiter(times, np.int64, len(times))
        except OverflowError:  # MCAP counts from 0 to 2**64, and damage makes use of it
            stamps = np.fromiter(times, np.uint64, len(times))
        return cls(stamps, np.fromiter(map(place.__getitem__, sources), np.intp, len(sources)), names, list(data))


def in_batches(rows: Iterator[tuple[Any, int, bytes]], name: Callable[[Any], str] = str) -> Iterator[Batch]:
    """Yield the messages that `rows` gives; if it fails, what it gave before is yielded first."""
    while True:
        taken: list[tuple[Any, int, bytes]] = []
        try:
            taken.extend(islice(rows, ROWS))  # an iterator that fails leaves in the list what it gave
        except Exception:
            if taken:
                yield Batch.of_rows(taken, name)
            raise
        if not taken:
            return
        yield Batch.of_rows(taken, name)

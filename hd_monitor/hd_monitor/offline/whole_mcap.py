"""Whole MCAP files: the ``mcap`` package reads what their summary says; the chunks are read in bulk, in order of time.

The package reads messages too, one by one; ``tests/benchmarks/replay_speed.py`` prints how much longer that takes.
"""

import heapq
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import BinaryIO

import numpy as np
from mcap.reader import make_reader
from mcap.records import ChunkIndex, Statistics
from mcap.summary import Summary
from numpy.typing import NDArray

from .batches import Batch, RawTopic
from .mcap_records import (
    HEAD_BYTES,
    DamageError,
    Messages,
    Records,
    checked_content,
    parse_chunk,
    permitted_size,
    type_name,
)

_CHANNELS = 1 << 16


class WholeMcap:
    """An MCAP file as its summary describes it.

    Parameters
    ----------
    path : Path
    limit : int
        Bytes to which a chunk may expand.
    note : callable
        Told in a sentence of each chunk left out.

    Attributes
    ----------
    span : tuple of (int, int) or None
        Times of recording of the first and the last message [ns]; None without messages.
    indexed : bool
        Whether the summary lists all chunks, topics and types; if not, the file can only be walked through.

    Raises
    ------
    Exception
        If the file does not end as it should or its summary is damaged; the class is the ``mcap`` package's own.
    """

    def __init__(self, path: Path, limit: int, note: Callable[[str], None]) -> None:
        self._path, self._limit, self._note = path, limit, note
        with path.open("rb") as file:
            summary = make_reader(file).get_summary()
        self._summary = summary or Summary()
        statistics = self._summary.statistics
        messages = statistics.message_count if statistics else 0
        self._counts = statistics.channel_message_counts if statistics else {}
        self.indexed = statistics is not None and (not messages or self._is_complete(statistics))
        self.span = (statistics.message_start_time, statistics.message_end_time) if statistics and messages else None

    def _is_complete(self, statistics: Statistics) -> bool:
        """Whether the summary repeats what it may leave out."""
        listed, channels, schemas = self._summary.chunk_indexes, self._summary.channels, self._summary.schemas
        types = {channel.schema_id for channel in channels.values()} - {0}
        counted = sum(self._counts.values()) == statistics.message_count
        known = self._counts.keys() <= channels.keys() and types <= schemas.keys()
        return 0 < statistics.chunk_count == len(listed) and counted and known

    def topics(self) -> list[RawTopic]:
        """Return the topics as the summary lists them."""
        types = {number: schema.name for number, schema in self._summary.schemas.items()}
        return [
            RawTopic(c.topic, type_name(types.get(c.schema_id, ""), c.message_encoding), self._counts.get(number, 0))
            for number, c in self._summary.channels.items()
        ]

    def batches(self, names: Sequence[str]) -> Iterator[Batch]:
        """Yield the messages of the topics of these names by time, those of equal times in the order of the file.

        Only chunks that overlap in time are held in memory together.

        Raises
        ------
        DamageError
            If a chunk does not hold what the index says, or too many overlap.
        Exception
            If something cannot be decompressed; the class is the decompressor's own.
        """
        topics = {number: names.index(c.topic) for number, c in self._summary.channels.items() if c.topic in names}
        places = np.full(_CHANNELS, -1, dtype=np.intp)
        places[list(topics)] = list(topics.values())
        ordered = [chunk for chunk in _holding(self._summary.chunk_indexes, topics) if self._is_permitted(chunk)]
        if _largest_overlap(ordered) > 2 * self._limit:
            raise DamageError(f"chunks of more than {2 * self._limit} bytes overlap in time")
        held: dict[int, Messages] = {}  # by the places of their chunks
        with self._path.open("rb") as file:
            for chunk, following in zip_longest(ordered, ordered[1:]):
                held[chunk.chunk_start_offset] = self._read(file, chunk, places)
                # What is not older than the next chunk's first message has to wait for that chunk.
                cuts = {begin: _older(held[begin], following) for begin in sorted(held)}
                older = Messages.joined([held[begin].part(slice(cut)) for begin, cut in cuts.items()])
                for some in older.stretches():
                    yield Batch(some.times, places[some.channels], np.array(some.data(), dtype=np.object_))
                held = {begin: found.part(slice(cuts[begin], None)) for begin, found in held.items()}
                held = {begin: found for begin, found in held.items() if found.times.size}

    def _is_permitted(self, chunk: ChunkIndex) -> bool:
        try:
            permitted_size(chunk, self._limit)
        except DamageError as error:
            self._note(f"a chunk was left out ({error})")
            return False
        return True

    def _read(self, file: BinaryIO, chunk: ChunkIndex, places: NDArray[np.intp]) -> Messages:
        """Return a chunk's messages of the topics that have places, by time."""
        begin = chunk.chunk_start_offset
        file.seek(begin + HEAD_BYTES)
        found = parse_chunk(file.read(max(chunk.chunk_length - HEAD_BYTES, 0)))
        if len(found.data) < chunk.compressed_size:
            raise DamageError(f"the chunk at byte {begin} is cut off")
        if found.uncompressed_size != chunk.uncompressed_size:
            raise DamageError(f"the chunk at byte {begin} is not of the size that the index gives")
        messages, _, whole = Records.parse(checked_content(found, self._limit))
        if not whole:
            raise DamageError(f"the records of the chunk at byte {begin} do not fill it")
        ends = (int(messages.times.min()), int(messages.times.max())) if messages.times.size else ()
        if any(not chunk.message_start_time <= time <= chunk.message_end_time for time in ends):
            raise DamageError(f"the chunk at byte {begin} holds messages of other times than announced")
        return messages.part(places[messages.channels] >= 0).in_order()


def _holding(chunks: Iterable[ChunkIndex], channels: Collection[int]) -> list[ChunkIndex]:
    """Return the chunks in which one of the channels is, as far as the index says so, by their first times."""
    offsets = ((chunk, chunk.message_index_offsets) for chunk in chunks if channels)
    found = [chunk for chunk, own in offsets if not own or not own.keys().isdisjoint(channels)]
    return sorted(found, key=lambda chunk: (chunk.message_start_time, chunk.chunk_start_offset))


def _largest_overlap(chunks: Iterable[ChunkIndex]) -> int:
    """Most bytes that two or more chunks hold of which none ends before another begins; chunks go by first times."""
    largest, total = 0, 0
    held: list[tuple[int, int]] = []
    for chunk in chunks:
        while held and held[0][0] < chunk.message_start_time:
            total -= heapq.heappop(held)[1]
        heapq.heappush(held, (chunk.message_end_time, chunk.uncompressed_size))
        total += chunk.uncompressed_size
        largest = max(largest, total if len(held) > 1 else 0)
    return largest


def _older(found: Messages, following: ChunkIndex | None) -> int:
    """Count the messages older than a chunk; all are if none follows."""
    if following is None:
        return len(found.times)
    # As an int, the time would be compared in floating point, which does not hold it.
    return int(np.searchsorted(found.times, np.uint64(following.message_start_time)))

"""Whole MCAP files: the ``mcap`` package reads what their summary says; the chunks are read in bulk, in order of time.

The package reads messages too, one by one; ``tests/benchmarks/replay_speed.py`` prints how much longer that takes.
"""

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import BinaryIO

import numpy as np
from mcap.reader import make_reader
from mcap.records import ChunkIndex
from mcap.summary import Summary
from numpy.typing import NDArray

from .batches import Batch, RawTopic
from .compression import decompress_where_packed
from .mcap_records import HEAD_BYTES, DamageError, Records, checked_content, parse_chunk

_CHANNELS = 1 << 16


class WholeMcap:
    """An MCAP file as its summary describes it.

    Parameters
    ----------
    path : Path

    Attributes
    ----------
    span : tuple of (int, int) or None
        Times of recording of the first and the last message [ns]; None without messages.
    indexed : bool
        Whether the summary lists the chunks; without it the file can only be walked through.

    Raises
    ------
    Exception
        If the file does not end as it should or its summary is damaged; the class is the ``mcap`` package's own.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        with path.open("rb") as file:
            summary = make_reader(file).get_summary()
        self._summary = summary or Summary()
        statistics = self._summary.statistics
        messages = statistics.message_count if statistics else 0
        self._counts = statistics.channel_message_counts if statistics else {}
        self.indexed = statistics is not None and (bool(self._summary.chunk_indexes) or not messages)
        self.span = (statistics.message_start_time, statistics.message_end_time) if statistics and messages else None

    def topics(self) -> list[RawTopic]:
        """Return the topics as the summary lists them."""
        types = {number: schema.name for number, schema in self._summary.schemas.items()}
        channels = self._summary.channels.items()
        return [RawTopic(c.topic, types.get(c.schema_id, ""), self._counts.get(number, 0)) for number, c in channels]

    def batches(self, names: Sequence[str]) -> Iterator[Batch]:
        """Yield the messages of the topics of these names by time, those of equal times in the order of the file.

        Only chunks that overlap in time are held in memory together.

        Raises
        ------
        DamageError
            If a chunk does not hold what the index says.
        Exception
            If something cannot be decompressed; the class is the decompressor's own.
        """
        topics = {number: names.index(c.topic) for number, c in self._summary.channels.items() if c.topic in names}
        places = np.full(_CHANNELS, -1, dtype=np.intp)
        places[list(topics)] = list(topics.values())
        ordered = _holding(self._summary.chunk_indexes, topics)
        held: dict[int, Batch] = {}  # by the places of their chunks
        with self._path.open("rb") as file:
            for chunk, following in zip_longest(ordered, ordered[1:]):
                held[chunk.chunk_start_offset] = Batch.joined([_read(file, chunk, places)])
                # What is not older than the next chunk's first message has to wait for that chunk.
                cuts = {begin: _older(held[begin], following) for begin in sorted(held)}
                yield Batch.joined(held[begin].part(slice(cut)) for begin, cut in cuts.items())
                held = {begin: batch.part(slice(cuts[begin], None)) for begin, batch in held.items()}
                held = {begin: batch for begin, batch in held.items() if batch.times.size}


def _holding(chunks: Iterable[ChunkIndex], channels: Collection[int]) -> list[ChunkIndex]:
    """Return the chunks in which one of the channels is, as far as the index says so, by their first times."""
    offsets = ((chunk, chunk.message_index_offsets) for chunk in chunks if channels)
    found = [chunk for chunk, own in offsets if not own or not own.keys().isdisjoint(channels)]
    return sorted(found, key=lambda chunk: (chunk.message_start_time, chunk.chunk_start_offset))


def _read(file: BinaryIO, chunk: ChunkIndex, places: NDArray[np.intp]) -> Batch:
    begin = chunk.chunk_start_offset
    file.seek(begin + HEAD_BYTES)
    found = parse_chunk(file.read(max(chunk.chunk_length - HEAD_BYTES, 0)))
    if len(found.data) < chunk.compressed_size:
        raise DamageError(f"the chunk at byte {begin} is cut off")
    records = Records.parse(checked_content(found))
    times = records.messages.times
    if not records.whole:
        raise DamageError(f"the records of the chunk at byte {begin} do not fill it")
    if times.size and not chunk.message_start_time <= int(times.min()) <= int(times.max()) <= chunk.message_end_time:
        raise DamageError(f"the chunk at byte {begin} holds messages of other times than announced")
    topics = places[records.messages.channels]
    messages = records.messages.part(topics >= 0)
    return Batch(messages.times, topics[topics >= 0], decompress_where_packed(messages.data()))


def _older(batch: Batch, following: ChunkIndex | None) -> int:
    """Count the messages older than a chunk; all are if none follows."""
    if following is None:
        return len(batch.times)
    # As an int, the time would be compared in floating point, which does not hold it.
    return int(np.searchsorted(batch.times, np.uint64(following.message_start_time)))

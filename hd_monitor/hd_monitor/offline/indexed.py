"""Whole MCAP files, read chunk by chunk as their index lists them, in the order of recording."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .batches import Batch
from .compression import MAGIC, decompress_where_packed, decompress_whole
from .mcap import ChunkBody, DamageError, Messages, Records

_CHANNELS = 1 << 16


class Chunk(NamedTuple):
    """A chunk as the index of its file describes it.

    Attributes
    ----------
    start, end : int
        Times of recording of its first and its last message [ns].
    begin : int
        Where its record begins in the file.
    compression : str
    packed, size : int
        Bytes of its content as it stands in the file, and decompressed.
    """

    start: int
    end: int
    begin: int
    compression: str
    packed: int
    size: int


def read_indexed(path: Path, chunks: Sequence[Chunk], topics: Mapping[int, str], packed: bool) -> Iterator[Batch]:
    """Yield the messages of some channels by their times, those of equal times in the order of the file.

    Only chunks that overlap in time are held in memory together.

    Parameters
    ----------
    path : Path
    chunks : sequence of Chunk
    topics : mapping of int to str
        Topics of the channels that are wanted.
    packed : bool
        Whether each message is compressed.

    Raises
    ------
    DamageError
        If a chunk does not hold what the index says.
    Exception
        If something cannot be decompressed; the class is the decompressor's own.
    """
    names = list(dict.fromkeys(topics.values()))
    place = np.full(_CHANNELS, -1, dtype=np.intp)  # of the channel's topic among the names
    for channel, name in topics.items():
        place[channel] = names.index(name)
    ordered = sorted(chunks, key=lambda chunk: (chunk.start, chunk.begin))
    held: dict[int, Messages] = {}  # by the places of their chunks
    with path.open("rb") as file:
        for chunk, following in zip_longest(ordered, ordered[1:]):
            messages = _read(file, chunk)
            held[chunk.begin] = messages.part(place[messages.channels] >= 0).by_time()
            # What is not older than the next chunk's first message has to wait for that chunk.
            cuts = {begin: _older(held[begin], following) for begin in sorted(held)}
            yield _merged([held[begin].part(slice(cut)) for begin, cut in cuts.items()], names, place, packed)
            held = {begin: held[begin].part(slice(cut, None)) for begin, cut in cuts.items()}
            held = {begin: messages for begin, messages in held.items() if messages.times.size}


def _read(file: BinaryIO, chunk: Chunk) -> Messages:
    records = Records.parse(ChunkBody.read(file, chunk.begin, chunk.compression, chunk.packed, chunk.size).content())
    times = records.messages.times
    if not records.whole:
        raise DamageError(f"the records of the chunk at byte {chunk.begin} do not fill it")
    if times.size and not chunk.start <= int(times.min()) <= int(times.max()) <= chunk.end:
        raise DamageError(f"the chunk at byte {chunk.begin} holds messages of other times than announced")
    return records.messages


def _older(messages: Messages, following: Chunk | None) -> int:
    """Count the messages older than a chunk; all are if none follows."""
    if following is None:
        return len(messages.times)
    # As an int, the time would be compared in floating point, which does not hold it.
    return int(np.searchsorted(messages.times, np.uint64(following.start)))


def _merged(parts: list[Messages], names: list[str], place: NDArray[np.intp], packed: bool) -> Batch:
    times = np.concatenate([part.times for part in parts])
    topics = place[np.concatenate([part.channels for part in parts])]
    data = _data(parts[0], packed)
    if len(parts) > 1:
        data.extend(message for part in parts[1:] for message in _data(part, packed))
        order = np.argsort(times, kind="stable")
        times, topics, data = times[order], topics[order], [data[index] for index in order.tolist()]
    return Batch(times, topics, names, data)


def _data(messages: Messages, packed: bool) -> list[bytes]:
    data = messages.data()
    if packed:
        return [decompress_whole("zstd", message) for message in data]
    return decompress_where_packed(data) if messages.may_begin(MAGIC) else data

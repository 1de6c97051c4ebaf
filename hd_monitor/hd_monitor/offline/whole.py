"""Whole recordings: rosbags opens them and knows their order; what it lists chunk by chunk is read in bulk."""

from collections.abc import Collection, Iterator
from operator import attrgetter
from pathlib import Path
from typing import Any

from rosbags.rosbag2 import Reader

from .batches import Batch, in_batches
from .compression import decompress_where_packed
from .indexed import Chunk, read_indexed


def read_whole(reader: Reader, wanted: Collection[str]) -> Iterator[Batch]:
    """Yield the messages of the topics in `wanted`, in the order in which rosbags gives them.

    Raises
    ------
    Exception
        If the recording is damaged; the class is rosbags' or a decompressor's own.
    """
    connections = [connection for connection in reader.connections if connection.topic in wanted]
    if not connections:
        return
    files = _indexed_files(reader)
    if files is None:
        for batch in in_batches(reader.messages(connections), attrgetter("topic")):
            yield batch._replace(data=decompress_where_packed(batch.data))
        return
    types = {(connection.topic, connection.msgtype) for connection in connections}
    packed = reader.compression_mode == "message"
    for file in files:
        topics = {c.id: c.topic for c in file.connections if (c.topic, c.msgtype) in types}
        yield from read_indexed(Path(file.path), _chunks(file, topics), topics, packed)


def _indexed_files(reader: Reader) -> list[Any] | None:
    """Return rosbags' readers of the single files; None if one of them is of a kind that only rosbags reads.

    An older rosbags keeps no such readers, and its index of chunks elsewhere.
    """
    storage: Any = getattr(reader, "storage", None)
    files = getattr(storage, "storages", [storage])
    if all(getattr(file, "chunks", None) for file in files if file is None or file.metadata.message_count):
        return [file for file in files if file.metadata.message_count]
    return None


def _chunks(file: Any, channels: Collection[int]) -> list[Chunk]:
    """Return the chunks in which one of the channels is, as far as the index says so."""
    return [
        Chunk(
            start=chunk.message_start_time,
            end=chunk.message_end_time,
            begin=chunk.chunk_start_offset,
            compression=chunk.compression,
            packed=chunk.compressed_size,
            size=chunk.uncompressed_size,
        )
        for chunk in file.chunks
        if not chunk.channel_count or any(chunk.channel_count.get(channel) for channel in channels)
    ]

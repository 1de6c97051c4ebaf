"""Whole recordings: rosbags opens them and knows their order; what it lists chunk or row by row is read in bulk."""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from rosbags.rosbag2 import Reader

from .batches import Batch, in_batches
from .compression import decompress_where_packed, decompress_whole
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
    files = _files(reader)
    if files is None:
        rows = ((connection.topic, time, data) for connection, time, data in reader.messages(connections))
        for batch in in_batches(rows):
            yield batch._replace(data=decompress_where_packed(batch.data))
        return
    types = {(connection.topic, connection.msgtype) for connection in connections}
    packed = reader.compression_mode == "message"
    for file in files:
        topics = {c.id: c.topic for c in file.connections if (c.topic, c.msgtype) in types}
        if getattr(file, "chunks", None):
            yield from read_indexed(Path(file.path), _chunks(file, topics), topics, packed)
        elif topics:
            yield from _rows(file, topics, packed)


def _files(reader: Reader) -> list[Any] | None:
    """Return rosbags' readers of the single files; None if one of them is of a kind that only rosbags reads.

    An older rosbags keeps no such readers, and its index of chunks elsewhere.
    """
    storage: Any = getattr(reader, "storage", None)
    files = getattr(storage, "storages", [storage])
    filled = [file for file in files if file is None or file.metadata.message_count]
    if all(getattr(file, "chunks", None) or getattr(file, "dbconn", None) for file in filled):
        return filled
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


def _rows(file: Any, topics: Mapping[int, str], packed: bool) -> Iterator[Batch]:
    """Yield a database's messages by their times, those of equal times in the order in which they were written."""
    query = (
        f"SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN ({', '.join('?' * len(topics))}) "
        "ORDER BY timestamp, id"
    )
    for batch in in_batches(file.dbconn.execute(query, tuple(topics)), topics.__getitem__):
        if packed:
            yield batch._replace(data=[decompress_whole("zstd", message) for message in batch.data])
        else:
            yield batch._replace(data=decompress_where_packed(batch.data))

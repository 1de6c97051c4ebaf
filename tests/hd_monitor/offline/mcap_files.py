"""MCAP files written by hand, for what no recorder here writes: any chunks, any order, any fault."""

import struct
import zlib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

lz4 = pytest.importorskip("lz4.frame")
zstd = pytest.importorskip("backports.zstd")

MAGIC = b"\x89MCAP0\r\n"
TYPE = "std_msgs/msg/String"
PACK = {"": bytes, "lz4": lz4.compress, "zstd": zstd.compress}


class Sent(NamedTuple):
    """A message: number of its channel, time of recording [ns], data."""

    channel: int
    time: int
    data: bytes


def write(
    path: Path,
    chunks: Sequence[Sequence[Sent]],
    topics: Sequence[str],
    *,
    compression: str = "",
    checksum: bool = True,
    indexed: bool = True,
    bounds: tuple[int, int] | None = None,
) -> Path:
    """Write a file; channels count from 1. `bounds` are announced in place of the chunks' own first and last time."""
    head = b"".join(
        _record(4, struct.pack("<HH", number, 1) + _string(topic) + _string("cdr") + struct.pack("<I", 0))
        for number, topic in enumerate(topics, 1)
    )
    head = _record(3, struct.pack("<H", 1) + _string(TYPE) + _string("ros2msg") + _string("string data")) + head
    out = bytearray(MAGIC + _record(1, _string("ros2") + _string("by hand")))
    index = b""
    for number, chunk in enumerate(chunks):
        content = bytearray(b"" if number else head)
        places: dict[int, list[tuple[int, int]]] = {}
        for message in chunk:
            places.setdefault(message.channel, []).append((message.time, len(content)))
            content += message_record(message)
        times = bounds or (min((m.time for m in chunk), default=0), max((m.time for m in chunk), default=0))
        packed = PACK[compression](bytes(content))
        crc = zlib.crc32(content) if checksum else 0
        body = struct.pack("<QQQI", *times, len(content), crc) + _string(compression) + struct.pack("<Q", len(packed))
        begin = len(out)
        out += _record(6, body + packed)
        end, offsets = len(out), []
        for channel, pairs in places.items() if indexed else ():
            offsets.append((channel, len(out)))
            rows = b"".join(struct.pack("<QQ", *pair) for pair in pairs)
            out += _record(7, struct.pack("<HI", channel, len(rows)) + rows)
        where = b"".join(struct.pack("<HQ", *offset) for offset in offsets)
        index += _record(
            8,
            struct.pack("<QQQQI", *times, begin, end - begin, len(where))
            + where
            + struct.pack("<Q", len(out) - end)
            + _string(compression)
            + struct.pack("<QQ", len(packed), len(content)),
        )
    out += _record(15, struct.pack("<I", 0))
    summary = len(out)
    messages = [message for chunk in chunks for message in chunk]
    out += head + _statistics(messages, len(topics), len(chunks)) + index
    out += _record(2, struct.pack("<QQI", summary, 0, 0)) + MAGIC
    path.write_bytes(out)
    return path


def write_unchunked(path: Path, messages: Sequence[Sent], topic: str) -> Path:
    """Write a file whose messages are outside chunks."""
    head = _record(3, struct.pack("<H", 1) + _string(TYPE) + _string("ros2msg") + _string("string data"))
    head += _record(4, struct.pack("<HH", 1, 1) + _string(topic) + _string("cdr") + struct.pack("<I", 0))
    out = MAGIC + _record(1, _string("ros2") + _string("by hand")) + head
    out += b"".join(map(message_record, messages)) + _record(15, struct.pack("<I", 0))
    summary = head + _statistics(messages, 1, 0)
    path.write_bytes(out + summary + _record(2, struct.pack("<QQI", len(out), 0, 0)) + MAGIC)
    return path


def message_record(message: Sent) -> bytes:
    return _record(5, struct.pack("<HIQQ", message.channel, 0, message.time, message.time) + message.data)


def _statistics(messages: Sequence[Sent], channels: int, chunks: int) -> bytes:
    counts = Counter(message.channel for message in messages)
    times = [message.time for message in messages] or [0]
    rows = b"".join(struct.pack("<HQ", *pair) for pair in sorted(counts.items()))
    numbers = (len(messages), 1, channels, 0, 0, chunks, min(times), max(times), len(rows))
    return _record(11, struct.pack("<QHIIIIQQI", *numbers) + rows)


def _record(code: int, body: bytes) -> bytes:
    return struct.pack("<BQ", code, len(body)) + body


def _string(text: str) -> bytes:
    return struct.pack("<I", len(text)) + text.encode()

"""MCAP files of recorded messages, written without the library, which a robot need not have.

The records are those of https://mcap.dev/spec: header, schemas, channels, messages, the end of the data, a summary that
repeats schemas and channels, and a footer. There are no chunks: nothing is compressed or indexed.
"""

import struct
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

_MAGIC = b"\x89MCAP0\r\n"
_HEADER, _FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _STATISTICS, _DATA_END = 1, 2, 3, 4, 5, 11, 15


class Channel(NamedTuple):
    """A topic: its name, its message type as ``package/msg/Type``, and that type's definition."""

    topic: str
    type: str
    definition: str


class Recorded(NamedTuple):
    """A serialised message: index of its channel, time at which it was received [ns], data."""

    channel: int
    time: int
    data: bytes


def mcap_file(channels: Sequence[Channel], messages: Iterable[Recorded], *, library: str) -> bytes:
    """Return the content of a file that holds some messages, in the order given."""
    heads = b"".join(
        _record(_SCHEMA, struct.pack("<H", i) + _text(c.type) + _text("ros2msg") + _text(c.definition))
        + _record(_CHANNEL, struct.pack("<HH", i, i) + _text(c.topic) + _text("cdr") + struct.pack("<I", 0))
        for i, c in enumerate(channels, 1)
    )
    counts: Counter[int] = Counter()
    parts = [_MAGIC, _record(_HEADER, _text("ros2") + _text(library)), heads]
    first, last = 1 << 64, 0
    for channel, time, data in messages:
        parts.append(_record(_MESSAGE, struct.pack("<HIQQ", channel + 1, counts[channel], time, time) + data))
        counts[channel] += 1
        first, last = min(first, time), max(last, time)
    parts.append(_record(_DATA_END, struct.pack("<I", 0)))
    summary = sum(map(len, parts))
    rows = b"".join(struct.pack("<HQ", channel + 1, count) for channel, count in sorted(counts.items()))
    total = counts.total()
    numbers = (total, len(channels), len(channels), 0, 0, 0, first if total else 0, last, len(rows))
    parts += [heads, _record(_STATISTICS, struct.pack("<QHIIIIQQI", *numbers) + rows)]
    return b"".join([*parts, _record(_FOOTER, struct.pack("<QQI", summary, 0, 0)), _MAGIC])


def _record(code: int, body: bytes) -> bytes:
    return struct.pack("<BQ", code, len(body)) + body


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<I", len(data)) + data

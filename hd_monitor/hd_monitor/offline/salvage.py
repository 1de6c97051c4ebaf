"""Reading of damaged recordings: whatever is whole in a cut-off or partly overwritten file.

rosbags refuses a file that does not end as it should, and a recorder that lost its power leaves just that. The readers
here walk through the file from its start, hand over every message that is still whole, and note what is not.
"""

import os
import shutil
import sqlite3
import struct
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import BinaryIO, NamedTuple

from .compression import decompress_leniently
from .errors import BagError

MCAP_MAGIC = b"\x89MCAP0\r\n"
SQLITE_MAGIC = b"SQLite format 3\0"

_CHANNEL, _SCHEMA, _MESSAGE, _CHUNK, _DATA_END = 0x04, 0x03, 0x05, 0x06, 0x0F
_LARGEST_RECORD = 1 << 31


class RawMessage(NamedTuple):
    """A serialised message: its topic, the time it was recorded at [ns] and its bytes."""

    topic: str
    time: int
    data: bytes


class RawTopic(NamedTuple):
    """A topic: its name, its type as ``package/msg/Type`` and the number of its messages."""

    name: str
    type: str
    messages: int


def _check_beginning(path: Path, magic: bytes, kind: str) -> None:
    with path.open("rb") as file:
        begun = file.read(len(magic))
    if begun != magic:
        what = f"does not begin as {kind} does" if begun else "is empty"
        raise BagError(f"{path} {what}: nothing can be read from it; give another recording")


class DamagedMcap:
    """An MCAP file read record by record.

    Parameters
    ----------
    path : Path
    note : callable
        Takes a sentence about each place that cannot be read.

    Raises
    ------
    BagError
        If the file does not even begin as an MCAP file does.
    """

    def __init__(self, path: Path, note: Callable[[str], None]) -> None:
        self._path = path
        self._note = note
        self._types: dict[int, str] = {}
        self._channels: dict[int, tuple[str, str]] = {}
        _check_beginning(path, MCAP_MAGIC, "an MCAP file")

    def topics(self) -> list[RawTopic]:
        """Find the topics and count their messages, in one walk through the file."""
        counts: dict[tuple[str, str], int] = {}
        for channel, _, _ in self._walk(lambda _: None):
            counts[channel] = counts.get(channel, 0) + 1
        for channel in self._channels.values():
            counts.setdefault(channel, 0)
        return [RawTopic(name, kind, count) for (name, kind), count in counts.items()]

    def messages(self) -> Iterator[RawMessage]:
        """Yield all whole messages in the order of the file, each chunk's by time."""
        for (name, _), time, data in self._walk(self._note):
            yield RawMessage(name, time, data)

    def _walk(self, note: Callable[[str], None]) -> Iterator[tuple[tuple[str, str], int, bytes]]:
        with self._path.open("rb") as file:
            file.seek(len(MCAP_MAGIC))
            for code, body in _records(file, self._path.name, note):
                if code != _CHUNK:
                    yield from self._record(code, body)
                    continue
                try:
                    size, content = _unpack_chunk(body)
                except Exception as error:  # the decompressors raise whatever their authors chose
                    note(f"{self._path.name}: a damaged chunk was left out ({_reason(error)})")
                    continue
                if len(content) < size:
                    note(f"{self._path.name}: {size - len(content)} bytes of a chunk are missing")
                found = [message for part in _split(content) for message in self._record(*part)]
                yield from sorted(found, key=lambda message: message[1])

    def _record(self, code: int, body: bytes) -> Iterator[tuple[tuple[str, str], int, bytes]]:
        if code == _MESSAGE and len(body) >= 22:
            channel, time = struct.unpack_from("<H4xQ", body)
            if channel in self._channels:
                yield self._channels[channel], time, body[22:]
        elif code == _SCHEMA and len(body) >= 6:
            number, length = struct.unpack_from("<HI", body)
            self._types[number] = body[6 : 6 + length].decode(errors="replace")
        elif code == _CHANNEL and len(body) >= 8:
            number, schema, length = struct.unpack_from("<HHI", body)
            self._channels[number] = (body[8 : 8 + length].decode(errors="replace"), self._types.get(schema, ""))


def _records(file: BinaryIO, name: str, note: Callable[[str], None]) -> Iterator[tuple[int, bytes]]:
    """Yield (code, body) of each record that holds messages, channels or types, up to the end or the first damage."""
    wanted = (_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK)
    while True:
        head = file.read(9)
        if len(head) < 9:
            note(f"{name} is cut off after {file.tell()} bytes: the recording was not closed")
            return
        code, length = struct.unpack("<BQ", head)
        if code == _DATA_END:
            return
        if length > _LARGEST_RECORD or not 0 < code < 0x80:
            note(f"{name} is damaged at byte {file.tell() - 9}: what follows cannot be read")
            return
        body = file.read(length)
        if len(body) < length:
            note(f"{name} is cut off after {file.tell()} bytes: the recording was not closed")
            if code == _CHUNK:
                yield code, body
            return
        if code in wanted:
            yield code, body


def _unpack_chunk(body: bytes) -> tuple[int, bytes]:
    """Return the announced size and the contents of a chunk, which is shorter than announced if it was cut off."""
    size, length = struct.unpack_from("<Q4xI", body, 16)
    compression = body[32 : 32 + length].decode()
    (packed,) = struct.unpack_from("<Q", body, 32 + length)
    return size, decompress_leniently(compression, body[40 + length : 40 + length + packed])


def _split(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield (code, body) of each whole record of a chunk."""
    at = 0
    while at + 9 <= len(content):
        code, length = struct.unpack_from("<BQ", content, at)
        at += 9 + length
        if at > len(content):
            return
        yield code, content[at - length : at]


def restore_length(source: Path, target: Path) -> bool:
    """Copy a SQLite file that was cut off to `target` in its full length; return False if it is not cut off.

    SQLite reads nothing at all from a file that is shorter than its header says; with zeros in place of what is missing
    it reads up to there.
    """
    with source.open("rb") as file:
        header = file.read(100)
    if len(header) < 100 or not header.startswith(SQLITE_MAGIC):
        return False
    (page,) = struct.unpack_from(">H", header, 16)
    (pages,) = struct.unpack_from(">I", header, 28)
    length = pages * (page if page != 1 else 65536)
    if source.stat().st_size >= length:
        return False
    shutil.copyfile(source, target)
    os.truncate(target, length)
    return True


class DamagedSqlite:
    """A SQLite storage file read row by row, without its index.

    Parameters
    ----------
    path : Path
    note : callable
        Takes a sentence about each place that cannot be read.

    Raises
    ------
    BagError
        If the file is no SQLite database, or its list of topics cannot be read.
    """

    def __init__(self, path: Path, note: Callable[[str], None]) -> None:
        self._path = path
        self._note = note
        _check_beginning(path, SQLITE_MAGIC, "a SQLite file")
        try:
            with closing(self._connect()) as database:
                rows = database.execute("SELECT id, name, type FROM topics").fetchall()
            self._topics = {int(number): (str(name), str(kind)) for number, name, kind in rows}
        except Exception as error:  # a damaged file also yields text that is none and numbers that are none
            reason = f"{path} is damaged in its list of topics ({_reason(error)}); give another recording"
            raise BagError(reason) from None

    def topics(self) -> list[RawTopic]:
        """Find the topics and count their messages, in one walk through the file."""
        counts = dict.fromkeys(self._topics.values(), 0)
        for channel, _, _ in self._walk(lambda _: None):
            counts[channel] += 1
        return [RawTopic(name, kind, count) for (name, kind), count in counts.items()]

    def messages(self) -> Iterator[RawMessage]:
        """Yield all messages in the order in which they were written, up to the first damage."""
        for (name, _), time, data in self._walk(self._note):
            yield RawMessage(name, time, data)

    def _connect(self) -> sqlite3.Connection:
        # A write-ahead log beside the file is read only without `immutable`.
        log = self._path.with_name(f"{self._path.name}-wal")
        mode = "mode=ro" if log.exists() and log.stat().st_size else "immutable=1"
        return sqlite3.connect(f"{self._path.resolve().as_uri()}?{mode}", uri=True)

    def _walk(self, note: Callable[[str], None]) -> Iterator[tuple[tuple[str, str], int, bytes]]:
        try:
            with closing(self._connect()) as database:
                for number, time, data in database.execute(
                    "SELECT topic_id, timestamp, data FROM messages NOT INDEXED"
                ):
                    if number in self._topics and isinstance(time, int) and isinstance(data, bytes):
                        yield self._topics[number], time, data
        except Exception as error:  # a damaged file also yields text that is none
            note(f"{self._path.name} is damaged ({_reason(error)}): what follows cannot be read")


def _reason(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__

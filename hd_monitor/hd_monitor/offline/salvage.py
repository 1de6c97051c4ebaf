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
from .errors import BagError, one_line
from .mcap import (
    CHANNEL,
    CHUNK,
    MAGIC,
    MESSAGE,
    SCHEMA,
    Channels,
    ChunkBody,
    DamageError,
    Records,
    bare_message,
    heads,
)

SQLITE_MAGIC = b"SQLite format 3\0"


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
        self._channels = Channels()
        _check_beginning(path, MAGIC, "an MCAP file")

    def topics(self) -> list[RawTopic]:
        """Find the topics and count their messages, in one walk through the file."""
        counts: dict[tuple[str, str], int] = {}
        for channel, _, _ in self._walk(lambda _: None):
            counts[channel] = counts.get(channel, 0) + 1
        for channel in self._channels.topics.values():
            counts.setdefault(channel, 0)
        return [RawTopic(name, kind, count) for (name, kind), count in counts.items()]

    def messages(self) -> Iterator[RawMessage]:
        """Yield all whole messages in the order of the file, each chunk's by time."""
        for (name, _), time, data in self._walk(self._note):
            yield RawMessage(name, time, data)

    def _walk(self, note: Callable[[str], None]) -> Iterator[tuple[tuple[str, str], int, bytes]]:
        topics = self._channels.topics
        with self._path.open("rb") as file:
            for code, body in self._records(file, note):
                if code == CHUNK:
                    found = self._chunk(body, note)
                elif code == MESSAGE:
                    found = bare_message(body)
                else:
                    self._channels.learn(code, body)
                    continue
                for channel, time, data in found:
                    if channel in topics:
                        yield topics[channel], time, data

    def _records(self, file: BinaryIO, note: Callable[[str], None]) -> Iterator[tuple[int, bytes]]:
        """Yield kind and body of each record that matters, up to the end or the first damage."""
        try:
            for head in heads(file, self._path.name):
                if head.code == CHUNK or (head.code in (SCHEMA, CHANNEL, MESSAGE) and head.whole):
                    file.seek(head.begin)
                    yield head.code, file.read(head.end - head.begin)
        except DamageError as damage:
            note(str(damage))

    def _chunk(self, body: bytes, note: Callable[[str], None]) -> Iterator[tuple[int, int, bytes]]:
        try:
            chunk = ChunkBody.parse(body)
            content = decompress_leniently(chunk.compression, chunk.packed)
        except Exception as error:  # the decompressors raise whatever their authors chose
            note(f"{self._path.name}: a damaged chunk was left out ({one_line(error)})")
            return iter(())
        if len(content) < chunk.size:
            note(f"{self._path.name}: {chunk.size - len(content)} bytes of a chunk are missing")
        records = Records.parse(content)
        for code, part in records.others:
            self._channels.learn(code, part)
        found = records.messages.by_time()
        return zip(found.channels.tolist(), found.times.tolist(), found.data(), strict=True)


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
            reason = f"{path} is damaged in its list of topics ({one_line(error)}); give another recording"
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
            note(f"{self._path.name} is damaged ({one_line(error)}): what follows cannot be read")

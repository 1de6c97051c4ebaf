"""Reading of damaged recordings: whatever is whole in a cut-off or partly overwritten file.

A file that does not end as it should has no summary, and a recorder that lost its power leaves just that. The readers
here walk through the file from its start, hand over every message that is still whole, and note what is not.
"""

import struct
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode

from . import mcap_records, sqlite
from .batches import RawMessage, RawTopic
from .compression import expand
from .errors import BagError, one_line
from .mcap_records import (
    DamageError,
    Records,
    bare_message,
    heads,
    parse_chunk,
    permitted_size,
    string_at,
    type_name,
)

Note = Callable[[str], None]
_Row = tuple[tuple[str, str], int, bytes]
"""A message: its topic and the topic's type, the time it was recorded at [ns] and its bytes."""


class Walk(ABC):
    """A storage file read from its start as far as it goes, without its index.

    Parameters
    ----------
    path : Path
    given : Path
        The file as the user knows it, of which `path` may be a decompressed or restored copy.
    limit : int
        Bytes to which a chunk may expand.
    note : callable
        Takes a sentence about each place that cannot be read.

    Raises
    ------
    BagError
        If the file does not even begin as one of its kind does.
    """

    MAGIC: bytes
    KIND: str

    def __init__(self, path: Path, given: Path, limit: int, note: Note) -> None:
        self._topics: dict[int, tuple[str, str]] = {}
        self._path, self._name, self._limit, self._note = path, given.name, limit, note
        with path.open("rb") as file:
            begun = file.read(len(self.MAGIC))
        if begun != self.MAGIC:
            what = f"does not begin as {self.KIND} does" if begun else "is empty"
            raise BagError(f"{given} {what}: nothing can be read from it; give another recording")

    def topics(self) -> list[RawTopic]:
        """Find the topics and count their messages, in one walk through the file."""
        counts = Counter(topic for topic, _, _ in self._rows(lambda _: None))
        return [RawTopic(*topic, counts[topic]) for topic in dict.fromkeys([*counts, *self._topics.values()])]

    def messages(self) -> Iterator[RawMessage]:
        """Yield all messages that are whole, in the order in which they were written, each chunk's by time."""
        for (name, _), time, data in self._rows(self._note):
            yield RawMessage(name, time, data)

    @abstractmethod
    def _rows(self, note: Note) -> Iterator[_Row]: ...


class McapWalk(Walk):
    """An MCAP file read record by record."""

    MAGIC = mcap_records.MAGIC
    KIND = "an MCAP file"

    def __init__(self, path: Path, given: Path, limit: int, note: Note) -> None:
        super().__init__(path, given, limit, note)
        self._types: dict[int, str] = {}

    def _rows(self, note: Note) -> Iterator[_Row]:
        with self._path.open("rb") as file:
            for code, body in self._records(file, note):
                if code == Opcode.CHUNK:
                    found = self._chunk(body, note)
                elif code == Opcode.MESSAGE:
                    found = bare_message(body)
                else:
                    self._learn(code, body, note)
                    continue
                for channel, time, data in found:
                    if channel in self._topics:
                        yield self._topics[channel], time, data

    def _records(self, file: BinaryIO, note: Note) -> Iterator[tuple[int, bytes]]:
        """Yield kind and body of each record that matters, up to the end or the first damage."""
        try:
            for head in heads(file, self._name):
                known = head.code in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE)
                if head.code == Opcode.CHUNK or (known and head.whole):
                    file.seek(head.begin)
                    yield head.code, file.read(head.end - head.begin)
        except DamageError as damage:
            note(str(damage))

    def _learn(self, code: int, body: bytes, note: Note) -> None:
        """Keep what a record says of types or topics."""
        try:
            if code == Opcode.SCHEMA and len(body) >= 2:
                (number,) = struct.unpack_from("<H", body)
                self._types[number], _ = string_at(body, 2)
            elif code == Opcode.CHANNEL and len(body) >= 4:
                number, schema = struct.unpack_from("<HH", body)
                topic, end = string_at(body, 4)
                encoding, _ = string_at(body, end)
                self._topics[number] = topic, type_name(self._types.get(schema, ""), encoding)
        except DamageError as damage:
            note(f"{self._name}: a record of topics or types is damaged ({damage})")

    def _chunk(self, body: bytes, note: Note) -> Iterator[tuple[int, int, bytes]]:
        try:
            chunk = parse_chunk(body)
            size = permitted_size(chunk, self._limit)
            content, _ = expand(chunk.compression, chunk.data, size + 1)
        except Exception as error:  # the decompressors raise whatever their authors chose
            note(f"{self._name}: a chunk was left out ({one_line(error)})")
            return
        if len(content) < size:
            note(f"{self._name}: {size - len(content)} bytes of a chunk are missing")
        elif len(content) > size:
            note(f"{self._name}: a chunk holds more than the {size} bytes announced, and only those are read")
            content = content[:size]
        records = Records.parse(content)
        for code, part in records.others():
            self._learn(code, part, note)
        for some in records.messages.in_order().stretches():
            yield from zip(some.channels.tolist(), some.times.tolist(), some.data(), strict=True)


def length_before_cut(path: Path) -> int | None:
    """Return the length [bytes] that the header of a SQLite file announces; None if the file is not shorter."""
    with path.open("rb") as file:
        header = file.read(100)
    if len(header) < 100 or not header.startswith(sqlite.MAGIC):
        return None
    (page,) = struct.unpack_from(">H", header, 16)
    (pages,) = struct.unpack_from(">I", header, 28)
    length = pages * (int(page) if page != 1 else 65536)
    return length if path.stat().st_size < length else None


class SqliteWalk(Walk):
    """A SQLite storage file read row by row; a `BagError` too if its list of topics cannot be read."""

    MAGIC = sqlite.MAGIC
    KIND = "a SQLite file"

    def __init__(self, path: Path, given: Path, limit: int, note: Note) -> None:
        super().__init__(path, given, limit, note)
        try:
            with sqlite.opened(path) as database:
                for number, name, kind in database.execute("SELECT id, name, type FROM topics"):
                    self._topics[int(number)] = str(name), str(kind)
        except Exception as error:  # a damaged file also yields invalid text and numbers
            reason = f"{given} is damaged in its list of topics ({one_line(error)}); give another recording"
            raise BagError(reason) from None

    def _rows(self, note: Note) -> Iterator[_Row]:
        try:
            with sqlite.opened(self._path) as database:
                rows = database.execute("SELECT topic_id, timestamp, data FROM messages NOT INDEXED")
                for number, time, data in rows:
                    if number in self._topics and isinstance(time, int) and isinstance(data, bytes):
                        yield self._topics[number], time, data
        except Exception as error:  # a damaged file also yields invalid text
            note(f"{self._name} is damaged ({one_line(error)}): what follows cannot be read")

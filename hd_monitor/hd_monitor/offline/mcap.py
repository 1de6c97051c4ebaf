"""The records of MCAP files: what stands where in the file, in a chunk and in a message.

A file is a row of records, and so is the content of each of its chunks. Chunks are taken apart in bulk, for a recording
holds thousands of messages for every second that its reading may take.
"""

import struct
from collections.abc import Iterator
from typing import Any, BinaryIO, NamedTuple, Self
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from .compression import decompress_whole

MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 0x03, 0x04, 0x05, 0x06, 0x0F

_HEAD = struct.Struct("<BQ")  # code and length of what follows
_MESSAGE_HEAD = 22  # channel, sequence, times of recording and of publishing
_CHUNK_HEAD = struct.Struct("<QQQI")  # first and last time, size of the content, its checksum
_LARGEST = 1 << 31


class DamageError(ValueError):
    """A place in a file that does not hold what it should."""


class Head(NamedTuple):
    """A record's kind, where the rest of it begins and ends in the file, and whether that is all of it."""

    code: int
    begin: int
    end: int
    whole: bool


def heads(file: BinaryIO, name: str) -> Iterator[Head]:
    """Yield the head of each record of the data section; of a last one that is cut off too.

    Raises
    ------
    DamageError
        Where the data break off; the message is what a note says of it.
    """
    size = file.seek(0, 2)
    at = len(MAGIC)
    while at + _HEAD.size <= size:
        file.seek(at)
        code, length = _HEAD.unpack(file.read(_HEAD.size))
        if code == DATA_END:
            return
        if length > _LARGEST or not 0 < code < 0x80:
            raise DamageError(f"{name} is damaged at byte {at}: what follows cannot be read")
        begin = at + _HEAD.size
        at = begin + length
        yield Head(code, begin, min(at, size), at <= size)
    raise DamageError(f"{name} is cut off after {size} bytes: the recording was not closed")


class ChunkBody(NamedTuple):
    """A chunk as it stands in the file; its `packed` content is shorter than it was where the file is cut off."""

    size: int
    checksum: int
    compression: str
    packed: bytes

    @classmethod
    def parse(cls, body: bytes) -> Self:
        """Take a chunk's record apart."""
        _, _, size, checksum = _CHUNK_HEAD.unpack_from(body)
        compression, at = _string(body, _CHUNK_HEAD.size)
        (packed,) = struct.unpack_from("<Q", body, at)
        return cls(size, checksum, compression.decode(), body[at + 8 : at + 8 + packed])

    @classmethod
    def read(cls, file: BinaryIO, begin: int, compression: str, packed: int, size: int) -> Self:
        """Read the chunk whose record begins at `begin`, the rest being known from the file's index.

        Raises
        ------
        DamageError
            If the file ends before the chunk does.
        """
        file.seek(begin + _HEAD.size)
        head = _CHUNK_HEAD.size + 4 + len(compression.encode()) + 8
        described, content = file.read(head), file.read(packed)
        if len(content) < packed:
            raise DamageError(f"the chunk at byte {begin} is cut off")
        return cls(size, _CHUNK_HEAD.unpack_from(described)[3], compression, content)

    def content(self) -> bytes:
        """Return the content, decompressed.

        Raises
        ------
        DamageError
            If its size or its checksum is another than announced.
        Exception
            If it cannot be decompressed; the class is the decompressor's own.
        """
        content = decompress_whole(self.compression, self.packed)
        if len(content) != self.size:
            raise DamageError(f"a chunk holds {len(content)} bytes instead of {self.size}")
        if self.checksum and crc32(content) != self.checksum:
            raise DamageError("the checksum of a chunk is wrong")
        return content


class Channels:
    """Topics and their types by the number of their channel, as the records name them."""

    def __init__(self) -> None:
        self._types: dict[int, str] = {}
        self.topics: dict[int, tuple[str, str]] = {}

    def learn(self, code: int, body: bytes) -> None:
        """Keep what a record says of types or topics."""
        if code == SCHEMA and len(body) >= 6:
            (number,) = struct.unpack_from("<H", body)
            self._types[number] = _string(body, 2)[0].decode(errors="replace")
        elif code == CHANNEL and len(body) >= 8:
            number, schema = struct.unpack_from("<HH", body)
            self.topics[number] = (_string(body, 4)[0].decode(errors="replace"), self._types.get(schema, ""))


class Messages(NamedTuple):
    """Messages of one chunk: their times of recording [ns], their channels, and where in `content` each one stands."""

    content: bytes
    times: NDArray[np.uint64]
    channels: NDArray[np.uint16]
    begins: NDArray[np.int64]
    ends: NDArray[np.int64]

    def part(self, which: NDArray[Any] | slice) -> Self:
        """Return some of the messages, or all in another order."""
        return self._replace(
            times=self.times[which], channels=self.channels[which], begins=self.begins[which], ends=self.ends[which]
        )

    def by_time(self) -> Self:
        """Return the messages in the order of their times; those of equal times stay in the order of the file."""
        if (self.times[1:] >= self.times[:-1]).all():
            return self
        return self.part(np.argsort(self.times, kind="stable"))

    def data(self) -> list[bytes]:
        """Return the serialised messages themselves."""
        content = self.content
        return [content[begin:end] for begin, end in zip(self.begins.tolist(), self.ends.tolist(), strict=True)]

    def may_begin(self, beginning: bytes) -> bool:
        """Whether any message could begin with these four bytes; False is certain."""
        last = max(len(self.content) - 4, 0)  # a shorter message stands for what it ends with
        places = np.minimum(self.begins, last)
        return bool((_numbers(self.content, "<u4", places) == int.from_bytes(beginning, "little")).any())


class Records(NamedTuple):
    """The content of a chunk: its messages in the order of the file, kind and body of each other record.

    `whole` is False if something had to be left out: a last record that is cut off, a message too short to be one.
    """

    messages: Messages
    others: list[tuple[int, bytes]]
    whole: bool

    @classmethod
    def parse(cls, content: bytes) -> Self:
        """Take the content of a chunk apart."""
        found: list[int] = []
        at, head, last = 0, _HEAD.size, len(content) - _HEAD.size
        unpack, append = _HEAD.unpack_from, found.append
        while at <= last:  # the one loop over single messages: as little in it as will do
            append(at)
            at += head + unpack(content, at)[1]
        if at > len(content):
            found.pop()
        starts = np.array(found, dtype=np.int64)
        begins = starts + _HEAD.size
        ends = begins + _numbers(content, "<u8", starts + 1).astype(np.int64)
        is_message = _numbers(content, "u1", starts) == MESSAGE
        is_whole = ends - begins >= _MESSAGE_HEAD
        others = np.flatnonzero(~is_message)
        spans = zip(starts[others].tolist(), begins[others].tolist(), ends[others].tolist(), strict=True)
        chosen = is_message & is_whole
        begins, ends = begins[chosen], ends[chosen]
        times, channels = _numbers(content, "<u8", begins + 6), _numbers(content, "<u2", begins)
        return cls(
            Messages(content, times, channels, begins + _MESSAGE_HEAD, ends),
            [(content[start], content[begin:end]) for start, begin, end in spans],
            at == len(content) and not (is_message & ~is_whole).any(),
        )


def bare_message(body: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Yield channel, time of recording [ns] and data of a message outside any chunk, unless it is too short for one."""
    if len(body) >= _MESSAGE_HEAD:
        channel, time = struct.unpack_from("<H4xQ", body)
        yield channel, time, body[_MESSAGE_HEAD:]


def _numbers(content: bytes, kind: str, places: NDArray[np.int64]) -> NDArray[Any]:
    """Read a number at each place, wherever that is: the fields of MCAP are not aligned."""
    dtype = np.dtype(kind)
    count = max(len(content) - dtype.itemsize + 1, 0)
    return np.ndarray((count,), dtype, content, strides=(1,))[places]


def _string(body: bytes, at: int) -> tuple[bytes, int]:
    (length,) = struct.unpack_from("<I", body, at)
    at += 4
    return body[at : at + length], at + length

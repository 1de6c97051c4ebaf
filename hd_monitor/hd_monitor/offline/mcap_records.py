"""The records of MCAP files: what stands where in the file, in a chunk and in a message.

A file is a row of records, and so is the content of each of its chunks. Chunks are taken apart in bulk, for a recording
holds thousands of messages for every second that its reading may take.
"""

import struct
from collections.abc import Iterator, Sequence
from io import BytesIO
from typing import Any, BinaryIO, NamedTuple, Self
from zlib import crc32

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Chunk, ChunkIndex
from numpy.typing import NDArray

from .compression import expand

MAGIC = b"\x89MCAP0\r\n"

_HEAD = struct.Struct("<BQ")  # code and length of what follows
HEAD_BYTES = _HEAD.size
_MESSAGE_HEAD = 22  # channel, sequence, times of recording and of publishing
_LARGEST = 1 << 31
_ROWS = 1 << 16  # messages of which single objects exist at once; a recorder's chunk of 1 MiB has fewer
_STRETCH = 1 << 21  # bytes of a chunk of whose records single objects exist at once


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
    while at + HEAD_BYTES <= size:
        file.seek(at)
        code, length = _HEAD.unpack(file.read(HEAD_BYTES))
        if code == Opcode.DATA_END:
            return
        if length > _LARGEST or not 0 < code < 0x80:
            raise DamageError(f"{name} is damaged at byte {at}: what follows cannot be read")
        begin = at + HEAD_BYTES
        at = begin + length
        yield Head(code, begin, min(at, size), at <= size)
    raise DamageError(f"{name} is cut off after {size} bytes: the recording was not closed")


def parse_chunk(body: bytes) -> Chunk:
    """Read the body of a chunk's record; its `data` is short where the body is cut off.

    Raises
    ------
    Exception
        If there is nothing of the data, or what precedes it is damaged; the class is the ``mcap`` package's own.
    """
    chunk: Chunk = Chunk.read(ReadDataStream(BytesIO(body)))
    return chunk


def checked_content(chunk: Chunk, limit: int) -> bytes:
    """Return a chunk's content, decompressed; raise as `decompress` if it cannot be.

    Raises
    ------
    DamageError
        If its size or its checksum is not the one announced, or the size announced is more than `limit` bytes.
    """
    size = permitted_size(chunk, limit)
    content, _ = expand(chunk.compression, chunk.data, size + 1)
    if len(content) != size:
        raise DamageError(f"a chunk holds {'more' if len(content) > size else 'fewer'} than the {size} bytes announced")
    if chunk.uncompressed_crc and crc32(content) != chunk.uncompressed_crc:
        raise DamageError("the checksum of a chunk is wrong")
    return content


def permitted_size(chunk: Chunk | ChunkIndex, limit: int) -> int:
    """Return the size that a chunk announces for its content [bytes]; a `DamageError` if it is more than `limit`."""
    size = chunk.uncompressed_size
    if chunk.compression and size > limit:
        raise DamageError(f"{size} bytes are announced, --chunk-limit permits {limit}")
    return size


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

    def in_order(self) -> Self:
        """Return the messages by time; those of equal times stay in order."""
        ordered = bool((self.times[1:] >= self.times[:-1]).all())
        return self if ordered else self.part(np.argsort(self.times, kind="stable"))

    @classmethod
    def joined(cls, parts: Sequence[Self]) -> Self:
        """Put messages of several chunks together by time; those of equal times stay in order."""
        if len(parts) == 1:
            return parts[0]
        content = b"".join(part.content for part in parts)
        shifts = np.cumsum([0, *(len(part.content) for part in parts[:-1])])
        moved = [(*part[1:3], part.begins + by, part.ends + by) for part, by in zip(parts, shifts, strict=True)]
        return cls(content, *map(np.concatenate, zip(*moved, strict=True))).in_order()

    def stretches(self) -> Iterator[Self]:
        """Yield the messages in stretches short enough to be single objects."""
        for first in range(0, self.times.size, _ROWS):
            yield self.part(slice(first, first + _ROWS))

    def data(self) -> list[bytes]:
        """Return the serialised messages themselves."""
        content = self.content
        return [content[begin:end] for begin, end in zip(self.begins.tolist(), self.ends.tolist(), strict=True)]


class Records(NamedTuple):
    """The content of a chunk: its messages in the order of the file, and what it says of channels and their types.

    `whole` is False if something had to be left out: a last record that is cut off, a message too short to be one, or
    what follows a record of a kind that there is not.
    """

    messages: Messages
    definitions: tuple[NDArray[np.int64], NDArray[np.int64]]
    """Where records of channels and types, their heads included, begin and end."""
    whole: bool

    @classmethod
    def parse(cls, content: bytes) -> Self:
        """Take the content of a chunk apart."""
        parts: list[list[NDArray[Any]]] = []
        at, head, last, whole = 0, HEAD_BYTES, len(content) - HEAD_BYTES, True
        unpack = _HEAD.unpack_from
        while at <= last and whole:
            found: list[int] = []
            append = found.append
            until = min(last, at + _STRETCH)
            while at <= until:  # the one loop over single messages: as little in it as will do
                append(at)
                at += head + unpack(content, at)[1]
            if at > len(content):
                found.pop()
            starts = np.array(found, dtype=np.int64)
            codes = _numbers(content, "u1", starts)
            if not codes.all():
                starts, whole = starts[: int(np.argmin(codes))], False
                codes = codes[: starts.size]
            begins = starts + head
            ends = begins + _numbers(content, "<u8", starts + 1).astype(np.int64)
            is_message = codes == Opcode.MESSAGE
            chosen = is_message & (ends - begins >= _MESSAGE_HEAD)
            whole &= np.array_equal(chosen, is_message)
            defines = (codes == Opcode.SCHEMA) | (codes == Opcode.CHANNEL)
            parts.append([begins[chosen], ends[chosen], starts[defines], ends[defines]])
        if not parts:
            parts.append([np.zeros(0, dtype=np.int64)] * 4)
        begins, ends, *definitions = map(np.concatenate, zip(*parts, strict=True)) if len(parts) > 1 else parts[0]
        times, channels = _numbers(content, "<u8", begins + 6), _numbers(content, "<u2", begins)
        messages = Messages(content, times, channels, begins + _MESSAGE_HEAD, ends)
        return cls(messages, (definitions[0], definitions[1]), whole and at == len(content))

    def others(self) -> Iterator[tuple[int, bytes]]:
        """Yield kind and body of each record of a channel or a type."""
        content = self.messages.content
        for start, end in zip(*self.definitions, strict=True):
            yield content[start], content[start + HEAD_BYTES : end]


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


def type_name(schema: str, encoding: str) -> str:
    """Return the type of a channel's messages; where they are not serialised as ROS does, it says so."""
    return schema if encoding in ("", "cdr") else f"{schema or 'untyped'} in {encoding}"


def string_at(body: bytes, at: int) -> tuple[str, int]:
    """Read a string that its length precedes; return where it ends too; raise a `DamageError` if it is cut off."""
    if at + 4 > len(body):
        raise DamageError("a string's length is missing")
    (length,) = struct.unpack_from("<I", body, at)
    end = at + 4 + length
    if end > len(body):
        raise DamageError(f"a string has {len(body) - at - 4} of {length} bytes")
    return body[at + 4 : end].decode(errors="replace"), end

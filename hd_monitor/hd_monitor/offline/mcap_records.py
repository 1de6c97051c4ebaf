"""The records of MCAP files: what stands where in the file, in a chunk and in a message.

A file is a row of records, and so is the content of each of its chunks. Chunks are taken apart in bulk, for a recording
holds thousands of messages for every second that its reading may take.
"""

import struct
from collections.abc import Iterator
from io import BytesIO
from typing import Any, BinaryIO, NamedTuple, Self
from zlib import crc32

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Chunk
from numpy.typing import NDArray

from .compression import decompress

MAGIC = b"\x89MCAP0\r\n"

_HEAD = struct.Struct("<BQ")  # code and length of what follows
HEAD_BYTES = _HEAD.size
_MESSAGE_HEAD = 22  # channel, sequence, times of recording and of publishing
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


def checked_content(chunk: Chunk) -> bytes:
    """Return a chunk's content, decompressed; raise as `decompress` if it cannot be.

    Raises
    ------
    DamageError
        If its size or its checksum is not the one announced.
    """
    content = decompress(chunk.compression, chunk.data)
    if len(content) != chunk.uncompressed_size:
        raise DamageError(f"a chunk holds {len(content)} bytes instead of {chunk.uncompressed_size}")
    if chunk.uncompressed_crc and crc32(content) != chunk.uncompressed_crc:
        raise DamageError("the checksum of a chunk is wrong")
    return content


class Messages(NamedTuple):
    """Messages of one chunk: their times of recording [ns], their channels, and where in `content` each one stands."""

    content: bytes
    times: NDArray[np.uint64]
    channels: NDArray[np.uint16]
    begins: NDArray[np.int64]
    ends: NDArray[np.int64]

    def part(self, which: NDArray[np.bool_]) -> Self:
        """Return some of the messages."""
        return self._replace(
            times=self.times[which], channels=self.channels[which], begins=self.begins[which], ends=self.ends[which]
        )

    def data(self) -> list[bytes]:
        """Return the serialised messages themselves."""
        content = self.content
        return [content[begin:end] for begin, end in zip(self.begins.tolist(), self.ends.tolist(), strict=True)]


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
        at, head, last = 0, HEAD_BYTES, len(content) - HEAD_BYTES
        unpack, append = _HEAD.unpack_from, found.append
        while at <= last:  # the one loop over single messages: as little in it as will do
            append(at)
            at += head + unpack(content, at)[1]
        if at > len(content):
            found.pop()
        starts = np.array(found, dtype=np.int64)
        begins = starts + HEAD_BYTES
        ends = begins + _numbers(content, "<u8", starts + 1).astype(np.int64)
        is_message = _numbers(content, "u1", starts) == Opcode.MESSAGE
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


def string_at(body: bytes, at: int) -> str:
    """Read a string that its length precedes."""
    (length,) = struct.unpack_from("<I", body, at)
    return body[at + 4 : at + 4 + length].decode(errors="replace")

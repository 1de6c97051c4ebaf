"""Places of the values in a serialised (CDR) message, found on one message and compared with many at once."""

import struct
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import BoolArray, IntArray
from .contract import NANOSECONDS
from .errors import LayoutError

ENCAPSULATION = 4
"""Bytes before the payload: representation (2), options (2). Alignment counts from behind them."""

_BIG_ENDIAN, _LITTLE_ENDIAN = 0, 1
_LONGEST_SEQUENCE = 1 << 28


class Fault(NamedTuple):
    """A message that could not be read: its position in the batch and why."""

    place: int
    reason: str


@dataclass(frozen=True, slots=True)
class Layout[T]:
    """Places of a message's values (`record`), and the bytes that decide them (`decisive`)."""

    record: np.dtype[np.void]
    decisive: BoolArray
    content: T


class Template:
    """Walks once through a message and notes the places of its values.

    Parameters
    ----------
    message : bytes
        With its 4-byte header, of either byte order.

    Raises
    ------
    LayoutError
        Here and in every method, if the message is not plain CDR or ends before its contents do.
    """

    def __init__(self, message: bytes) -> None:
        if len(message) < ENCAPSULATION:
            raise LayoutError(f"a message of {len(message)} bytes is too short for a CDR header; it was cut off")
        if message[0] != 0 or message[1] not in (_BIG_ENDIAN, _LITTLE_ENDIAN):
            raise LayoutError(f"a message is encapsulated as {message[:2].hex()}; only plain CDR (0000, 0001) is read")
        self._message = message
        self._order = "<" if message[1] == _LITTLE_ENDIAN else ">"
        self._at = ENCAPSULATION
        self._decisive = np.zeros(len(message), dtype=np.bool_)
        self._decisive[:2] = True
        self._fields: dict[str, tuple[str | tuple[str, tuple[int]], int]] = {}  # name: format and place

    def _take(self, size: int, alignment: int) -> int:
        start = ENCAPSULATION + -(-(self._at - ENCAPSULATION) // alignment) * alignment
        if start + size > len(self._message):
            raise LayoutError(
                f"a message ends after {len(self._message)} bytes, but its contents need {start + size}; it was cut "
                "off or is of another type"
            )
        self._at = start + size
        return start

    def count(self) -> int:
        """Read a number that decides the layout."""
        start = self._take(4, 4)
        self._decisive[start : start + 4] = True
        return int(struct.unpack_from(f"{self._order}I", self._message, start)[0])

    def byte(self) -> int:
        """Read a byte, which decides nothing."""
        return self._message[self._take(1, 1)]

    def text(self, *, decisive: bool = False) -> str:
        """Read a string; its length always decides the layout, its letters if `decisive`."""
        length = self.count()
        start = self._take(length, 1)
        if decisive:
            self._decisive[start : start + length] = True
        return self._message[start : start + length].rstrip(b"\0").decode(errors="replace")

    def doubles(self, name: str, count: int) -> None:
        """Note a field of `count` doubles."""
        if count > _LONGEST_SEQUENCE:
            raise LayoutError(f"a message announces {count} values; it is damaged or of another type")
        self._fields[name] = (f"{self._order}f8", (count,)), self._take(8 * count, 8 if count else 1)

    def time(self) -> int:
        """Read a header and return its stamp [ns]."""
        start = self._at
        self.stamp()
        seconds, nanoseconds = struct.unpack_from(f"{self._order}iI", self._message, start)
        return int(seconds) * NANOSECONDS + int(nanoseconds)

    def stamp(self) -> None:
        """Note a header: its stamp as fields, the length of its frame's name as layout."""
        self._fields["seconds"] = f"{self._order}i4", self._take(4, 4)
        self._fields["nanoseconds"] = f"{self._order}u4", self._take(4, 4)
        self.text()

    def layout[T](self, content: T) -> Layout[T]:
        """Return the layout noted, with the content that follows from the layout alone."""
        formats, offsets = zip(*self._fields.values(), strict=True)
        names, size = list(self._fields), len(self._message)
        record = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})
        return Layout(record, self._decisive, content)


def groups_of[T](
    messages: Sequence[bytes], parse: Callable[[bytes], Layout[T]], faults: list[Fault]
) -> Iterator[tuple[IntArray, npt.NDArray[np.void], T]]:
    """Yield (positions, structured array, content) for each set of messages that share a layout."""
    lengths = np.fromiter(map(len, messages), dtype=np.int64, count=len(messages))
    for length in np.unique(lengths).tolist():
        left = np.flatnonzero(lengths == length)
        while left.size:
            first = int(left[0])
            try:
                layout = parse(messages[first])
            except LayoutError as error:
                faults.append(Fault(first, str(error)))
                left = left[1:]
                continue
            chosen = messages if left.size == len(messages) else [messages[i] for i in left.tolist()]
            joined = b"".join(chosen)
            raw = np.frombuffer(joined, dtype=np.uint8).reshape(left.size, length)
            key = raw[:, layout.decisive]
            same = np.asarray((key == key[0]).all(axis=1))
            rows = np.frombuffer(joined, dtype=layout.record)
            if same.all():
                yield left, rows, layout.content
                break
            yield left[same], rows[same], layout.content
            left = left[~same]

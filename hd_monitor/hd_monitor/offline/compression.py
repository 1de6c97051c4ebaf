"""Decompression of files, chunks and messages: Zstandard and LZ4."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import lz4.frame
import numpy as np
import zstandard
from numpy.typing import NDArray

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of Zstandard data; no CDR message begins so."""

_PIECE = 1 << 20
"""Bytes of a file that are decompressed at once."""


def _decompressor(kind: str) -> Any:
    if kind == "lz4":
        return lz4.frame.LZ4FrameDecompressor()
    if kind == "zstd":
        return zstandard.ZstdDecompressor().decompressobj()
    raise ValueError(f"its compression {kind!r} is unknown")


def _parts(kind: str, pieces: Iterable[bytes]) -> Iterator[bytes]:
    """Yield the contents of compressed data that comes in pieces, one frame after the other."""
    frame = _decompressor(kind)
    for data in pieces:
        while data:
            if frame.eof:
                frame = _decompressor(kind)
            yield frame.decompress(data)
            data = frame.unused_data if frame.eof else b""
    if not frame.eof:
        raise ValueError("its compressed data is cut off")


def decompress(kind: str, data: bytes, *, whole: bool = True) -> bytes:
    """Return the contents of a chunk or a message, by the name of its compression.

    Raises
    ------
    ValueError
        If the kind is neither ``''``, ``'zstd'`` nor ``'lz4'``, or the data is cut off; unless `whole`, what precedes
        the cut is returned instead.
    Exception
        If the data is damaged; the class is the module's own.
    """
    if not kind:
        return data
    return b"".join(_parts(kind, [data])) if whole else bytes(_decompressor(kind).decompress(data))


def decompress_where_packed(messages: Sequence[bytes] | NDArray[np.object_]) -> NDArray[np.object_]:
    """Return messages, shape (messages,), those that are compressed decompressed; their first bytes say so.

    Raises
    ------
    Exception
        As `decompress`.
    """
    found: NDArray[np.object_] = np.asarray(messages, dtype=np.object_)
    if (found >= MAGIC).any():  # no CDR message is: it begins with 0
        found = np.array([decompress("zstd", m) if m.startswith(MAGIC) else m for m in found], dtype=np.object_)
    return found


def decompress_file(source: Path, target: Path) -> None:
    """Write the contents of a Zstandard file; what precedes damage is kept and the error raised."""
    with source.open("rb") as packed, target.open("wb") as plain:
        plain.writelines(_parts("zstd", iter(lambda: packed.read(_PIECE), b"")))

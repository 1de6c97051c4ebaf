"""Decompression of files, chunks and messages, Zstandard and LZ4, to no more than the caller permits."""

import errno
import os
import shutil
from pathlib import Path

import lz4.frame
import zstandard

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of Zstandard data; no CDR message begins so."""
CHUNK_LIMIT = 256 << 20
"""Bytes to which a chunk or a message may expand by default; recorders write chunks of some MiB."""

_PIECE = 1 << 17
"""Bytes of a file that are decompressed at once."""
_LARGEST_HEADER = 18
"""Bytes of a Zstandard frame that tell its size."""
_DENSEST = 1000
"""Times its size to which a file may expand; recordings of real machines expand tenfold."""


def expand(kind: str, data: bytes, size: int) -> tuple[bytes, bool]:
    """Decompress no more than `size` bytes, frame after frame, by the name of the compression.

    Returns
    -------
    content : bytes
        All that `data` expands to, up to `size` bytes; what is not compressed in full.
    complete : bool
        Whether that is all; of cut-off Zstandard data only if it announces its size.

    Raises
    ------
    ValueError
        If the kind is neither ``''``, ``'zstd'`` nor ``'lz4'``.
    Exception
        If the data is damaged; the class is the module's own.
    """
    if not kind:
        return data, True
    if kind == "zstd":
        with zstandard.ZstdDecompressor().stream_reader(data, read_across_frames=True) as frames:
            content = frames.read(size)
        return content, bool(data) and len(content) >= zstandard.frame_content_size(data)
    if kind == "lz4":
        return _expand_lz4(data, size)
    raise ValueError(f"its compression {kind!r} is unknown")


def _expand_lz4(data: bytes, size: int) -> tuple[bytes, bool]:
    content, complete = b"", False
    while data and len(content) < size:
        frame = lz4.frame.LZ4FrameDecompressor()
        content += frame.decompress(data, max_length=size - len(content))
        complete = frame.eof
        data = frame.unused_data if complete else b""
    return content, complete


def decompress(kind: str, data: bytes, limit: int) -> bytes:
    """Return the contents of a chunk or a message, by the name of its compression.

    Raises
    ------
    ValueError
        If the data is cut off or expands to more than `limit` bytes; otherwise as `expand`.
    Exception
        As `expand`.
    """
    content, complete = expand(kind, data, limit + 1)
    if kind and len(content) > limit:
        raise ValueError(f"it expands to more than {limit} bytes")
    if not complete:
        raise ValueError("its compressed data is cut off")
    return content


def decompress_file(source: Path, target: Path, limit: int) -> None:
    """Write the contents of a Zstandard file; what precedes damage is kept and the error raised.

    Raises
    ------
    OSError
        If the disk has no room for as much as the file announces, or turns out to hold.
    ValueError
        If it is cut off, or expands to more than `limit` bytes and more than a thousand times its size.
    zstandard.ZstdError
        If it is damaged.
    """
    most = max(limit, _DENSEST * source.stat().st_size)
    room = shutil.disk_usage(target.parent).free
    written = 0
    with source.open("rb") as packed, target.open("wb") as plain:
        announced = zstandard.frame_content_size(packed.read(_LARGEST_HEADER))
        packed.seek(0)
        frames = zstandard.ZstdDecompressor().stream_reader(packed, read_across_frames=True)
        while piece := frames.read(_PIECE):
            written += len(piece)
            if max(written, announced) > room:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            if written > most:
                raise ValueError(f"it expands to more than {most} bytes")
            plain.write(piece)
    if written < announced:
        raise ValueError("its compressed data is cut off")

"""Decompression, by the modules that rosbags has brought along."""

import importlib
import shutil
from functools import cache
from itertools import repeat
from pathlib import Path
from typing import Any

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of Zstandard data; no CDR message begins so."""

_ZSTANDARD = ("compression.zstd", "backports.zstd", "zstandard")  # Python's own, then by rosbags' age


@cache
def _module() -> Any:
    for name in _ZSTANDARD:
        try:
            return importlib.import_module(name)
        except ModuleNotFoundError:
            continue
    raise ModuleNotFoundError("no module for Zstandard", name="zstandard")


def _decompressor(kind: str) -> Any:
    if kind == "lz4":
        return importlib.import_module("lz4.frame").LZ4FrameDecompressor()
    if kind == "zstd":
        made = _module().ZstdDecompressor()
        return made.decompressobj() if hasattr(made, "decompressobj") else made
    raise ValueError(f"its compression {kind!r} is unknown")


def decompress(data: bytes) -> bytes:
    """Return the contents of Zstandard data; of data cut off, what precedes the cut.

    Raises
    ------
    Exception
        If the data is damaged; the class is the module's own.
    """
    return decompress_leniently("zstd", data)


def decompress_where_packed(messages: list[bytes]) -> list[bytes]:
    """Decompress those messages that are compressed.

    A file taken out of its folder has lost the note that each of its messages is compressed.
    """
    if not any(map(bytes.startswith, messages, repeat(MAGIC))):
        return messages
    return [decompress(message) if message.startswith(MAGIC) else message for message in messages]


def decompress_leniently(kind: str, data: bytes) -> bytes:
    """Return as much of the contents of a chunk as there is, by the name of its compression.

    Raises
    ------
    ValueError
        If the kind is neither ``''``, ``'zstd'`` nor ``'lz4'``.
    Exception
        If the data is damaged; the class is the module's own.
    """
    return bytes(_decompressor(kind).decompress(data)) if kind else data


def decompress_whole(kind: str, data: bytes) -> bytes:
    """Return the contents of a chunk or a message, by the name of its compression.

    Raises
    ------
    ValueError
        If the kind is neither ``''``, ``'zstd'`` nor ``'lz4'``, or the data is cut off.
    Exception
        If the data is damaged; the class is the module's own.
    """
    if not kind:
        return data
    parts: list[bytes] = []
    while data or not parts:  # one frame after the other
        frame = _decompressor(kind)
        parts.append(bytes(frame.decompress(data)))
        if not frame.eof:
            raise ValueError("its compressed data is cut off")
        data = frame.unused_data or b""
    return parts[0] if len(parts) == 1 else b"".join(parts)


def decompress_file(source: Path, target: Path) -> None:
    """Write the contents of a Zstandard file; what precedes a damage is kept and the module's error raised."""
    with _module().open(source, "rb") as packed, target.open("wb") as plain:
        shutil.copyfileobj(packed, plain)

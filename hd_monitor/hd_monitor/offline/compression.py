"""Decompression, by the modules that rosbags has brought along."""

import importlib
import shutil
from pathlib import Path
from typing import Any

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of Zstandard data; no CDR message begins so."""

_ZSTANDARD = ("compression.zstd", "backports.zstd", "zstandard")  # Python's own, then by rosbags' age


def _module() -> Any:
    for name in _ZSTANDARD:
        try:
            return importlib.import_module(name)
        except ModuleNotFoundError:
            continue
    raise ModuleNotFoundError("no module for Zstandard", name="zstandard")


def _decompressor() -> Any:
    made = _module().ZstdDecompressor()
    return made.decompressobj() if hasattr(made, "decompressobj") else made


def decompress(data: bytes) -> bytes:
    """Return the contents of Zstandard data; of data cut off, what precedes the cut.

    Raises
    ------
    Exception
        If the data is damaged; the class is the module's own.
    """
    return bytes(_decompressor().decompress(data))


def decompress_leniently(kind: str, data: bytes) -> bytes:
    """Return as much of the contents of a chunk as there is, by the name of its compression.

    Raises
    ------
    ValueError
        If the kind is neither ``''``, ``'zstd'`` nor ``'lz4'``.
    Exception
        If the data is damaged; the class is the module's own.
    """
    if kind == "":
        return data
    if kind == "zstd":
        return decompress(data)
    if kind == "lz4":
        return bytes(importlib.import_module("lz4.frame").LZ4FrameDecompressor().decompress(data))
    raise ValueError(f"its compression {kind!r} is unknown")


def decompress_file(source: Path, target: Path) -> None:
    """Write the contents of a Zstandard file; what precedes a damage is kept and the module's error raised."""
    with _module().open(source, "rb") as packed, target.open("wb") as plain:
        shutil.copyfileobj(packed, plain)

"""Decompression, by the modules that rosbags has brought along."""

import importlib
import shutil
import sys
from pathlib import Path
from typing import Any

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of Zstandard data; no CDR message begins so."""


def _module() -> Any:
    return importlib.import_module("compression.zstd" if sys.version_info >= (3, 14) else "backports.zstd")


def decompress(data: bytes) -> bytes:
    """Return the contents of Zstandard data.

    Raises
    ------
    Exception
        If the data is damaged; the class is the module's own.
    """
    return bytes(_module().decompress(data))


def decompress_leniently(kind: str, data: bytes) -> bytes:
    """Return as much of the contents of Zstandard or LZ4 data as there is: cut-off data gives what precedes the cut.

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
        return bytes(_module().ZstdDecompressor().decompress(data))
    if kind == "lz4":
        return bytes(importlib.import_module("lz4.frame").LZ4FrameDecompressor().decompress(data))
    raise ValueError(f"its compression {kind!r} is unknown")


def decompress_file(source: Path, target: Path) -> None:
    """Write the contents of a Zstandard file; what precedes a damage is kept and the module's error raised."""
    with _module().open(source, "rb") as packed, target.open("wb") as plain:
        shutil.copyfileobj(packed, plain)

"""Whole data decompresses whole, cut-off data as far as it goes, and nothing beyond the size that is permitted."""

import shutil
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from hd_monitor.offline.compression import decompress, decompress_file, expand

lz4 = pytest.importorskip("lz4.frame")
zstd = pytest.importorskip("backports.zstd")

TEXT = b"".join(b"%d bottles of grease " % number for number in range(50_000))
PACKED = {"zstd": zstd.compress(TEXT), "lz4": lz4.compress(TEXT)}


SIZE = len(TEXT)


@pytest.mark.parametrize("kind", ["zstd", "lz4"])
def test_whole_data_is_decompressed_frame_after_frame(kind: str) -> None:
    assert decompress(kind, PACKED[kind], SIZE) == TEXT
    assert decompress(kind, 2 * PACKED[kind], 2 * SIZE) == 2 * TEXT


@pytest.mark.parametrize("kind", ["zstd", "lz4"])
def test_data_cut_off_is_refused_and_expands_as_far_as_it_goes(kind: str) -> None:
    part = PACKED[kind][: len(PACKED[kind]) // 2]
    content, complete = expand(kind, part, SIZE)
    assert TEXT.startswith(content)
    assert len(content) > 1000
    assert not complete
    with pytest.raises(ValueError, match="cut off"):
        decompress(kind, part, SIZE)
    with pytest.raises(ValueError, match="cut off"):
        decompress(kind, b"", SIZE)


@pytest.mark.parametrize("kind", ["zstd", "lz4"])
def test_no_more_is_decompressed_than_is_permitted(kind: str) -> None:
    bomb = (zstd if kind == "zstd" else lz4).compress(bytes(64 << 20))
    tracemalloc.start()
    assert expand(kind, bomb, 1000) == (bytes(1000), False)
    with pytest.raises(ValueError, match="more than 1000 bytes"):
        decompress(kind, bomb, 1000)
    assert tracemalloc.get_traced_memory()[1] < 1 << 20
    tracemalloc.stop()


def test_an_unknown_compression_is_named() -> None:
    assert decompress("", TEXT, 0) is TEXT
    with pytest.raises(ValueError, match="'brotli' is unknown"):
        decompress("brotli", TEXT, SIZE)


def streamed(content: bytes) -> bytes:
    """Compress without announcing the size."""
    packer = zstd.ZstdCompressor()
    return bytes(packer.compress(content) + packer.flush())


@pytest.mark.parametrize("pack", [zstd.compress, streamed])
def test_a_file_expands_to_the_disk_within_bounds(tmp_path: Path, pack: Callable[[bytes], bytes]) -> None:
    source, target = tmp_path / "packed", tmp_path / "plain"
    source.write_bytes(pack(TEXT))
    decompress_file(source, target, 1000)  # a thousand times its size at any rate
    assert target.read_bytes() == TEXT
    source.write_bytes(pack(bytes(32 << 20)))
    decompress_file(source, target, 32 << 20)
    with pytest.raises(ValueError, match="expands to more than"):
        decompress_file(source, target, 8 << 20)
    assert target.stat().st_size <= 8 << 20


@pytest.mark.parametrize("pack", [zstd.compress, streamed])
def test_a_disk_without_room_is_not_filled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pack: Callable[[bytes], bytes]
) -> None:
    source, target = tmp_path / "packed", tmp_path / "plain"
    source.write_bytes(pack(TEXT))
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=SIZE // 2))
    with pytest.raises(OSError, match="No space left"):
        decompress_file(source, target, SIZE)
    assert target.stat().st_size <= SIZE // 2

"""Whole data decompresses whole; data that is cut off gives what precedes the cut, where the caller permits that."""

import pytest

from hd_monitor.offline.compression import decompress, decompress_where_packed

lz4 = pytest.importorskip("lz4.frame")
zstd = pytest.importorskip("backports.zstd")

TEXT = b"".join(b"%d bottles of grease " % number for number in range(50_000))
PACKED = {"zstd": zstd.compress(TEXT), "lz4": lz4.compress(TEXT)}


@pytest.mark.parametrize("kind", ["zstd", "lz4"])
def test_both_ways_agree_on_whole_data(kind: str) -> None:
    assert decompress(kind, PACKED[kind]) == decompress(kind, PACKED[kind], whole=False) == TEXT
    assert decompress(kind, 2 * PACKED[kind]) == 2 * TEXT


@pytest.mark.parametrize("kind", ["zstd", "lz4"])
def test_data_cut_off_is_refused_unless_the_caller_permits_it(kind: str) -> None:
    part = PACKED[kind][: len(PACKED[kind]) // 2]
    assert TEXT.startswith(decompress(kind, part, whole=False))
    assert len(decompress(kind, part, whole=False)) > 1000
    with pytest.raises(ValueError, match="cut off"):
        decompress(kind, part)
    with pytest.raises(ValueError, match="cut off"):
        decompress(kind, b"")


def test_an_unknown_compression_is_named() -> None:
    assert decompress("", TEXT) is TEXT
    with pytest.raises(ValueError, match="'brotli' is unknown"):
        decompress("brotli", TEXT)


def test_only_compressed_messages_are_decompressed() -> None:
    assert decompress_where_packed([b"\0\1", PACKED["zstd"], b""]).tolist() == [b"\0\1", TEXT, b""]

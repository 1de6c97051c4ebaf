"""Chunks are taken apart strictly where they should be whole, and as far as they go where they are not."""

import struct
import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from mcap.opcode import Opcode
from mcap.records import Chunk
from tests.hd_monitor.offline import mcap_files
from tests.hd_monitor.offline.mcap_files import Sent

from hd_monitor.offline.mcap_records import DamageError, Records, checked_content, heads

SENT = [Sent(3, 50, b"fifty"), Sent(1, 40, b""), Sent(3, 50, b"more")]
CONTENT = b"".join(map(mcap_files.message_record, SENT))


def found(content: bytes) -> list[Sent]:
    messages = Records.parse(content).messages
    columns = messages.channels.tolist(), messages.times.tolist(), messages.data()
    return [Sent(*row) for row in zip(*columns, strict=True)]


def test_whole_records_are_whole() -> None:
    assert found(CONTENT) == SENT
    assert Records.parse(CONTENT).whole
    assert Records.parse(b"").whole
    assert found(b"") == []


@pytest.mark.parametrize("missing", range(1, 40))
def test_what_is_cut_off_gives_the_records_before_the_cut(missing: int) -> None:
    assert found(CONTENT[:-missing]) == SENT[: 2 if missing < 36 else 1]
    # Where the cut is between two records, only the size that was announced tells.
    assert not Records.parse(CONTENT[:-missing]).whole or missing == len(mcap_files.message_record(SENT[2]))


def test_a_message_too_short_to_be_one_is_left_out() -> None:
    short = struct.pack("<BQ", Opcode.MESSAGE, 3) + b"abc"
    assert found(short + CONTENT + short) == SENT
    assert not Records.parse(short + CONTENT).whole


def test_other_records_are_handed_on() -> None:
    other = struct.pack("<BQ", 0x0C, 3) + b"abc"
    assert Records.parse(other + CONTENT + other).others == [(0x0C, b"abc")] * 2


@pytest.mark.parametrize("compression", ["", "lz4", "zstd"])
def test_a_chunk_of_another_size_or_checksum_than_announced_is_damaged(compression: str) -> None:
    size, checksum, packed = len(CONTENT), zlib.crc32(CONTENT), mcap_files.PACK[compression](CONTENT)
    chunk = Chunk(compression, packed, 50, 40, checksum, size)
    assert checked_content(chunk) == CONTENT
    assert checked_content(replace(chunk, uncompressed_crc=0)) == CONTENT
    with pytest.raises(DamageError, match="bytes instead of"):
        checked_content(replace(chunk, uncompressed_size=size + 1))
    with pytest.raises(DamageError, match="checksum"):
        checked_content(replace(chunk, uncompressed_crc=checksum + 1))


def test_a_file_cut_anywhere_says_so(tmp_path: Path) -> None:
    path = mcap_files.write(tmp_path / "a.mcap", [SENT], ["/a", "/b", "/c"])
    with path.open("rb") as file:
        whole = list(heads(file, path.name))
    assert all(head.whole for head in whole)
    raw = path.read_bytes()
    for size in range(len(mcap_files.MAGIC), whole[-1].end):
        path.write_bytes(raw[:size])
        with path.open("rb") as file, pytest.raises(DamageError, match=f"cut off after {size} bytes"):
            list(heads(file, path.name))

"""Chunks are taken apart strictly where they should be whole, and as far as they go where they are not."""

import struct
import tracemalloc
import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from mcap.opcode import Opcode
from mcap.records import Chunk
from tests.hd_monitor.offline import mcap_files
from tests.hd_monitor.offline.mcap_files import Sent

from hd_monitor.offline.mcap_records import DamageError, Messages, Records, checked_content, heads

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


def test_records_of_channels_and_types_are_handed_on_and_others_passed_over() -> None:
    channel, unknown = struct.pack("<BQ", Opcode.CHANNEL, 3) + b"abc", struct.pack("<BQ", 0xC0, 3) + b"abc"
    records = Records.parse(channel + CONTENT + unknown + channel)
    assert list(records.others()) == [(Opcode.CHANNEL, b"abc")] * 2
    assert records.whole


def test_nothing_is_read_beyond_a_record_of_no_kind() -> None:
    assert found(CONTENT + bytes(9) + CONTENT) == SENT
    assert not Records.parse(CONTENT + bytes(9) + CONTENT).whole


@pytest.mark.parametrize("record", [bytes(9), struct.pack("<BQ", 0x80, 0), mcap_files.message_record(SENT[1])])
def test_records_by_the_million_are_no_objects(record: bytes) -> None:
    content = record * ((32 << 20) // len(record))
    tracemalloc.start()
    records = Records.parse(content)
    assert tracemalloc.get_traced_memory()[1] < 3 * len(content)
    tracemalloc.stop()
    assert records.whole is any(record)
    assert max(len(some.times) for some in [*records.messages.stretches(), records.messages.part(slice(0))]) <= 1 << 16


def test_messages_of_several_chunks_go_by_time_and_equal_times_stay_in_order() -> None:
    first = Records.parse(CONTENT).messages.in_order()
    second = Records.parse(
        mcap_files.message_record(Sent(2, 50, b"last")) + mcap_files.message_record(SENT[1])
    ).messages
    assert Messages.joined([first, second.in_order()]).data() == [b"", b"", b"fifty", b"more", b"last"]


@pytest.mark.parametrize("compression", ["", "lz4", "zstd"])
def test_a_chunk_of_another_size_or_checksum_than_announced_is_damaged(compression: str) -> None:
    size, checksum, packed = len(CONTENT), zlib.crc32(CONTENT), mcap_files.PACK[compression](CONTENT)
    chunk = Chunk(compression, packed, 50, 40, checksum, size)
    assert checked_content(chunk, size) == CONTENT
    assert checked_content(replace(chunk, uncompressed_crc=0), size) == CONTENT
    with pytest.raises(DamageError, match="fewer than the"):
        checked_content(replace(chunk, uncompressed_size=size + 1), 2 * size)
    with pytest.raises(DamageError, match="more than the"):
        checked_content(replace(chunk, uncompressed_size=size - 1), 2 * size)
    with pytest.raises(DamageError, match="checksum"):
        checked_content(replace(chunk, uncompressed_crc=checksum + 1), size)


@pytest.mark.parametrize("compression", ["lz4", "zstd"])
def test_a_chunk_of_more_than_the_limit_is_not_decompressed(compression: str) -> None:
    chunk = Chunk(compression, b"not even compressed", 50, 40, 0, 1001)
    with pytest.raises(DamageError, match="1001 bytes are announced, --chunk-limit permits 1000"):
        checked_content(chunk, 1000)


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

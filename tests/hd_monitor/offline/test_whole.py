"""Whole recordings, read in bulk, give message by message what rosbags gives one by one, in the same order."""

import itertools
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.hd_monitor.offline import mcap_files
from tests.hd_monitor.offline import recordings as rec
from tests.hd_monitor.offline.mcap_files import Sent

from hd_monitor.offline.bag import Bag
from hd_monitor.offline.compression import CHUNK_LIMIT, MAGIC
from hd_monitor.offline.whole_mcap import WholeMcap

TOPICS = ("/a", "/b", "/c")
Row = tuple[str, int, bytes]


def by_rosbags(path: Path, topics: Sequence[str] = TOPICS) -> list[Row]:
    with rec.rosbag2.Reader(path) as reader:
        chosen = [c for c in reader.connections if c.topic in topics]
        return [(c.topic, time, bytes(data)) for c, time, data in reader.messages(chosen)] if chosen else []


def by_us(path: Path, topics: Sequence[str] = TOPICS) -> tuple[list[Row], list[str]]:
    with Bag(path) as bag:
        return [(topic, time, data) for topic, time, data in bag.messages(topics)], bag.notes


def not_in_bulk(*_: object) -> Iterator[Any]:
    pytest.fail("not read in bulk")


@pytest.fixture
def bulk_only() -> Iterator[None]:
    """Fail where messages are read one by one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hd_monitor.offline.bag.in_batches", not_in_bulk)
        yield


def some(first: int, count: int, channel: int = 1) -> list[Sent]:
    """Messages of different lengths, 10 ns apart."""
    return [Sent(channel, rec.START + t, bytes([channel]) * (t % 7)) for t in range(first, first + 10 * count, 10)]


times = st.one_of(st.integers(0, 6), st.integers(0, 1000)).map(lambda offset: rec.START + offset)
contents = st.binary(max_size=9).filter(lambda data: not data.startswith(MAGIC))  # which we take for compressed
messages = st.builds(Sent, st.integers(1, 3), times, contents)
chunkings = st.lists(st.lists(messages, max_size=12), min_size=1, max_size=8).filter(any)


@settings(max_examples=150, deadline=None)
@given(
    chunks=chunkings,
    topics=st.sets(st.sampled_from(TOPICS)).map(tuple),
    compression=st.sampled_from(["", "lz4", "zstd"]),
    checksum=st.booleans(),
)
def test_any_chunks_give_what_rosbags_gives(
    tmp_path_factory: pytest.TempPathFactory,
    chunks: list[list[Sent]],
    topics: tuple[str, ...],
    compression: str,
    checksum: bool,
) -> None:
    path = tmp_path_factory.mktemp("chunks") / "a.mcap"
    mcap_files.write(path, chunks, TOPICS, compression=compression, checksum=checksum)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hd_monitor.offline.bag.in_batches", not_in_bulk)
        assert by_us(path, topics) == (by_rosbags(path, topics), [])


@pytest.mark.usefixtures("bulk_only")
@pytest.mark.parametrize("compression", [None, "file", "message", "storage"])
@pytest.mark.parametrize("topics", [("/joint_states",), ("/joint_states", "/torsional_acceleration/block"), ("/x",)])
def test_a_recorded_folder_gives_what_rosbags_gives(
    tmp_path: Path, compression: str | None, topics: tuple[str, ...]
) -> None:
    path = rec.write(tmp_path / "bag", rec.small(40.0), compression=compression)
    assert by_us(path, topics) == (by_rosbags(path, topics), [])


@pytest.mark.usefixtures("bulk_only")
@pytest.mark.parametrize("compression", [None, "file", "message"])
@pytest.mark.parametrize("topics", [("/joint_states",), ("/joint_states", "/torsional_acceleration/block"), ("/x",)])
def test_a_database_gives_what_rosbags_gives(tmp_path: Path, topics: tuple[str, ...], compression: str | None) -> None:
    path = rec.write(tmp_path / "bag", rec.small(40.0), storage=rec.SQLITE, compression=compression)
    assert by_us(path, topics) == (by_rosbags(path, topics), [])


def test_rows_of_equal_times_come_in_the_order_in_which_they_were_written(tmp_path: Path) -> None:
    in_order = sorted(rec.small(3.0), key=lambda event: event.time)
    events = [event._replace(time=event.time // 10**9 * 10**9) for event in in_order]
    path = rec.write(tmp_path / "bag", events, storage=rec.SQLITE)
    topics = ("/joint_states", "/torsional_acceleration/block")
    rows, notes = by_us(path, topics)
    assert (rows, notes) == (by_rosbags(path, topics), [])
    assert [topic for topic, _, _ in rows] == [event.topic for event in events]


def split_bag(folder: Path, files: dict[str, list[list[Sent]]], mode: str = "") -> Path:
    """Write a bag of several files, in the order given."""
    folder.mkdir()
    every = [message for chunks in files.values() for chunk in chunks for message in chunk]
    for name, chunks in files.items():
        mcap_files.write(folder / name, chunks, TOPICS)
    information: dict[str, Any] = {
        "version": 5,
        "storage_identifier": "mcap",
        "relative_file_paths": list(files),
        "duration": {"nanoseconds": 10_000},
        "starting_time": {"nanoseconds_since_epoch": rec.START},
        "message_count": len(every),
        "compression_format": "zstd" if mode else "",
        "compression_mode": mode,
        "topics_with_message_count": [
            {
                "topic_metadata": {
                    "name": topic,
                    "type": mcap_files.TYPE,
                    "serialization_format": "cdr",
                    "offered_qos_profiles": "",
                },
                "message_count": sum(message.channel == number for message in every),
            }
            for number, topic in enumerate(TOPICS, 1)
        ],
    }
    (folder / "metadata.yaml").write_text(yaml.safe_dump({"rosbag2_bagfile_information": information}))
    return folder


@pytest.mark.usefixtures("bulk_only")
def test_files_come_in_the_order_of_the_metadata_even_where_times_do_not(tmp_path: Path) -> None:
    files: dict[str, list[list[Sent]]] = {
        "z.mcap": [some(500, 20), some(600, 9, 2)],
        "empty.mcap": [[]],
        "a.mcap": [some(0, 20, 3), some(55, 20)],
    }
    path = split_bag(tmp_path / "bag", files)
    rows, notes = by_us(path)
    assert rows == by_rosbags(path)
    assert len(rows) == 69
    assert not notes
    assert rows[0][1] > rows[-1][1]


@pytest.mark.usefixtures("bulk_only")
def test_a_late_chunk_is_read_before_what_it_precedes(tmp_path: Path) -> None:
    path = mcap_files.write(tmp_path / "a.mcap", [some(0, 5), some(400, 5), some(100, 40, 2), some(20, 5, 3)], TOPICS)
    rows, _ = by_us(path)
    assert rows == by_rosbags(path)
    assert [time for _, time, _ in rows] == sorted(time for _, time, _ in rows)


def test_only_chunks_that_overlap_are_held_together(tmp_path: Path) -> None:
    chunks = [some(1000 * number, 50, 1 + number % 3) for number in range(20)]
    path = mcap_files.write(tmp_path / "a.mcap", chunks, TOPICS)
    assert [len(batch.data) for batch in WholeMcap(path, CHUNK_LIMIT, pytest.fail).batches(TOPICS)] == [50] * 20


@pytest.mark.usefixtures("bulk_only")
def test_messages_compressed_singly_are_read_from_a_file_that_lost_its_folder(tmp_path: Path) -> None:
    path = rec.write(tmp_path / "bag", rec.small(), compression="message")
    alone = shutil.copy(rec.storage_file(path), tmp_path / "alone.mcap")
    topics = ("/joint_states", "/torsional_acceleration/block")
    assert by_us(Path(alone), topics) == (by_rosbags(path, topics), [])


def test_an_incompletely_compressed_message_is_noted_and_no_other_is_lost(tmp_path: Path) -> None:
    packed = [message._replace(data=mcap_files.zstd.compress(message.data)) for message in some(0, 30)]
    cut = [*packed[:20], packed[20]._replace(data=packed[20].data[:-2]), *packed[21:]]
    rows, notes = by_us(split_bag(tmp_path / "bag", {"a.mcap": [cut]}, "MESSAGE"))
    assert [row for row in rows if row[1] != cut[20].time] == everything([[*some(0, 20), *some(210, 9)]])
    assert "cut off" in " ".join(notes)


def test_a_file_without_chunks_is_walked_through(tmp_path: Path) -> None:
    path = mcap_files.write_unchunked(tmp_path / "a.mcap", some(0, 3000), "/a")
    rows, notes = by_us(path)
    assert rows == by_rosbags(path)
    assert len(rows) == 3000
    assert not notes


def test_a_topic_whose_record_is_damaged_is_noted_and_costs_no_other(tmp_path: Path) -> None:
    path = mcap_files.write(tmp_path / "x.mcap", [some(0, 9), some(50, 9, 2)], TOPICS)
    whole = by_us(path, ["/a"])[0]
    path.write_bytes(path.read_bytes().replace(b"/b\x03\0\0\0cdr", b"/b\xff\xff\0\0cdr"))
    rows, notes = by_us(path)
    assert rows == whole
    assert any("topics or types is damaged" in note for note in notes)


def test_a_file_without_message_indexes_is_read_all_the_same(tmp_path: Path) -> None:
    plain = mcap_files.write(tmp_path / "plain.mcap", [some(0, 9), some(50, 9, 2)], TOPICS)
    bare = mcap_files.write(tmp_path / "bare.mcap", [some(0, 9), some(50, 9, 2)], TOPICS, indexed=False)
    assert by_us(bare) == by_us(plain)


FIVE = [some(1000 * number, 40, 1 + number % 2) for number in range(5)]


def everything(chunks: Sequence[Sequence[Sent]]) -> list[Row]:
    return [(TOPICS[m.channel - 1], m.time, m.data) for m in itertools.chain(*chunks)]


def test_a_wrong_checksum_is_noted_and_no_message_is_lost_or_given_twice(tmp_path: Path) -> None:
    path = mcap_files.write(tmp_path / "a.mcap", FIVE, TOPICS)
    raw = bytearray(path.read_bytes())
    place = raw.index(mcap_files.message_record(FIVE[3][6])) + 9 + 22
    raw[place] ^= 0xFF
    path.write_bytes(raw)
    rows, notes = by_us(path)
    assert len(rows) == 200
    assert [row[:2] for row in rows] == [row[:2] for row in everything(FIVE)]
    assert "checksum" in " ".join(notes)


@pytest.mark.parametrize("compression", ["lz4", "zstd"])
def test_a_chunk_that_cannot_be_decompressed_costs_that_chunk_only(tmp_path: Path, compression: str) -> None:
    path = mcap_files.write(tmp_path / "a.mcap", FIVE, TOPICS, compression=compression)
    raw = bytearray(path.read_bytes())
    content = b"".join(map(mcap_files.message_record, FIVE[2]))
    place = raw.index(mcap_files.PACK[compression](content))
    raw[place : place + 20] = bytes(20)
    path.write_bytes(raw)
    rows, notes = by_us(path)
    assert rows == everything([*FIVE[:2], *FIVE[3:]])
    assert notes


def test_a_record_that_leaves_its_chunk_is_noted_and_costs_the_rest_of_that_chunk_only(tmp_path: Path) -> None:
    path = mcap_files.write(tmp_path / "a.mcap", FIVE, TOPICS, checksum=False)
    raw = bytearray(path.read_bytes())
    place = raw.index(mcap_files.message_record(FIVE[2][30])) + 1
    raw[place : place + 8] = b"\xff" * 8
    path.write_bytes(raw)
    rows, notes = by_us(path)
    assert rows == everything([*FIVE[:2], FIVE[2][:30], *FIVE[3:]])
    assert "do not fill it" in " ".join(notes)


def test_times_outside_those_announced_are_noted_and_lose_no_message(tmp_path: Path) -> None:
    path = mcap_files.write(tmp_path / "a.mcap", FIVE, TOPICS, bounds=(rec.START, rec.START + 2000))
    rows, notes = by_us(path)
    assert rows == everything(FIVE)
    assert "other times than announced" in " ".join(notes)


def test_damage_among_chunks_that_overlap_loses_no_message_and_gives_none_twice(tmp_path: Path) -> None:
    chunks = [some(0, 20), some(50, 10), some(120, 10), some(250, 10)]
    path = mcap_files.write(tmp_path / "a.mcap", chunks, TOPICS)
    raw = bytearray(path.read_bytes())
    raw[raw.rindex(mcap_files.message_record(chunks[2][3])) + 9 + 22] ^= 0xFF
    path.write_bytes(raw)
    rows, notes = by_us(path)
    assert sorted(row[1] for row in rows) == sorted(message.time for chunk in chunks for message in chunk)
    assert "checksum" in " ".join(notes)

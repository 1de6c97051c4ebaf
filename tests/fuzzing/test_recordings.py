"""Recordings of any content are read as far as they are whole, or refused."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from hypothesis import strategies as st
from tests.fuzzing.survival import damaged, survive
from tests.hd_monitor.offline import mcap_files, recordings

from hd_monitor.offline.bag import Bag


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Storage files of small recordings, by the end of their name; several of a kind in a list."""
    folder = tmp_path_factory.mktemp("whole")
    sent = [[mcap_files.Sent(1 + n % 2, n + 10 * chunk, bytes([n])) for n in range(4)] for chunk in range(2)]
    made = {
        f"{pack}.mcap": mcap_files.write(folder / f"{pack}.mcap", sent, ("/a", "/b"), compression=pack).read_bytes()
        for pack in mcap_files.PACK
    }
    made["open.mcap"] = mcap_files.write_unchunked(folder / "open.mcap", sent[0], "/a").read_bytes()
    bag = recordings.write(folder / "bag", recordings.small(0.2), storage=recordings.SQLITE)
    made["rows.db3"] = recordings.storage_file(bag).read_bytes()
    made["metadata.yaml"] = (bag / "metadata.yaml").read_bytes()
    made[".mcap.zstd"] = mcap_files.zstd.compress(made[".mcap"])
    return made


def read(path: Path) -> None:
    with Bag(path) as bag:
        for _ in bag.messages([topic.name for topic in bag.topics]):
            pass
        assert not any("\n" in note for note in bag.notes)


@pytest.mark.parametrize("suffix", [".mcap", ".mcap.zstd", ".db3"])
def test_damaged_storage_files(bags: dict[str, bytes], tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"damaged{suffix}"

    def write_and_read(content: bytes) -> None:
        path.write_bytes(content)
        read(path)

    survive(write_and_read, damaged(*(content for name, content in bags.items() if name.endswith(suffix))), weight=2)


def test_damaged_metadata(bags: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / "bag_0.db3").write_bytes(bags["rows.db3"])

    def write_and_read(content: bytes) -> None:
        (tmp_path / "metadata.yaml").write_bytes(content)
        read(tmp_path)

    survive(write_and_read, damaged(bags["metadata.yaml"]), weight=2)


cells = st.none() | st.integers(-(2**63), 2**63 - 1) | st.floats() | st.text(max_size=8) | st.binary(max_size=8)


def test_sqlite_rows_of_any_type(tmp_path: Path) -> None:
    path = tmp_path / "rows.db3"

    def write_and_read(rows: tuple[list[tuple[Any, ...]], list[tuple[Any, ...]]]) -> None:
        path.unlink(missing_ok=True)
        with closing(sqlite3.connect(path)) as database:
            database.execute("PRAGMA synchronous = OFF")
            database.execute("CREATE TABLE topics (id, name, type)")
            database.execute("CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id, timestamp, data)")
            database.executemany("INSERT INTO topics VALUES (?, ?, ?)", rows[0])
            database.executemany("INSERT INTO messages VALUES (NULL, ?, ?, ?)", rows[1])
            database.commit()
        read(path)

    topic, message = st.tuples(st.just(1) | cells, cells, cells), st.tuples(st.just(1) | cells, cells, cells)
    survive(write_and_read, st.tuples(st.lists(topic, max_size=3), st.lists(message, max_size=4)), weight=2)

"""Recordings of any content are read as far as they are whole, or refused."""

from pathlib import Path
from typing import Any

import pytest
from hypothesis import strategies as st
from tests.fuzzing.readers import read_bag, storage_files, write_rows
from tests.fuzzing.survival import damaged, survive


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return storage_files(tmp_path_factory.mktemp("whole"))


@pytest.mark.parametrize("suffix", [".mcap", ".mcap.zstd", ".db3"])
def test_damaged_storage_files(bags: dict[str, bytes], tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"damaged{suffix}"

    def write_and_read(content: bytes) -> None:
        path.write_bytes(content)
        read_bag(path)

    survive(write_and_read, damaged(*(content for name, content in bags.items() if name.endswith(suffix))), weight=2)


def test_damaged_metadata(bags: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / "bag_0.db3").write_bytes(bags["rows.db3"])

    def write_and_read(content: bytes) -> None:
        (tmp_path / "metadata.yaml").write_bytes(content)
        read_bag(tmp_path)

    survive(write_and_read, damaged(bags["metadata.yaml"]), weight=2)


cells = st.none() | st.integers(-(2**63), 2**63 - 1) | st.floats() | st.text(max_size=8) | st.binary(max_size=8)


def test_sqlite_rows_of_any_type(tmp_path: Path) -> None:
    path = tmp_path / "rows.db3"

    def write_and_read(rows: tuple[list[tuple[Any, ...]], list[tuple[Any, ...]]]) -> None:
        write_rows(path, *rows)
        read_bag(path)

    topic, message = st.tuples(st.just(1) | cells, cells, cells), st.tuples(st.just(1) | cells, cells, cells)
    survive(write_and_read, st.tuples(st.lists(topic, max_size=3), st.lists(message, max_size=4)), weight=2)

"""Windows cut from columns are those that would be cut message by message."""

from collections.abc import Iterator, Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor.offline.batches import ROWS, Batch, Window, in_batches

zstd = pytest.importorskip("backports.zstd")

NAMES = ("/a", "/b", "/c")
Row = tuple[int, int, bytes]


def one_by_one(rows: Sequence[Row], pause: int) -> Iterator[Window]:
    collected: dict[str, list[bytes]] = {}
    opened = latest = rows[0][0]
    for time, place, data in rows:
        if not 0 <= time - latest < pause:
            yield Window(opened, latest, collected)
            collected, opened = {}, time
        collected.setdefault(NAMES[place], []).append(data)
        latest = time
    yield Window(opened, latest, collected)


steps = st.one_of(st.integers(0, 3), st.sampled_from([9, 10, 11, 30]))
pieces = st.lists(st.tuples(st.integers(0, 2), steps), min_size=1, max_size=40)


@settings(max_examples=500)
@given(
    start=st.sampled_from([0, 1_700_000_000_000_000_000, 2**63 - 20, 2**63, 2**64 - 2500]),
    piece=pieces,
    pause=st.sampled_from([1, 2, 10, 25, 1000]),
)
def test_windows_end_at_pauses_only(start: int, piece: list[tuple[int, int]], pause: int) -> None:
    time, rows = start, []
    for place, step in piece:
        time += step
        rows.append((time, place, b"%d" % time))
    found = list(Batch.of_rows(rows).windows(NAMES, pause))
    assert found == list(one_by_one(rows, pause))


@settings(max_examples=500)
@given(times=st.lists(st.sampled_from([0, 1, 5, 30, 2**63, 2**64 - 1]), min_size=1), pause=st.integers(1, 40))
def test_windows_hold_every_message_in_order_even_where_times_go_back(times: list[int], pause: int) -> None:
    rows = [(time, number % 3, b"%d" % number) for number, time in enumerate(times)]
    windows = list(Batch.of_rows(rows).windows(NAMES, pause))
    for place, name in enumerate(NAMES):
        found = [data for window in windows for data in window.messages.get(name, [])]
        assert found == [data for _, own, data in rows if own == place]


@pytest.mark.parametrize("count", [ROWS - 1, ROWS, ROWS + 7])
def test_rows_come_in_batches_of_limited_size(count: int) -> None:
    rows = [(number, number % 3, b"%d" % number) for number in range(count)]
    batches = list(in_batches(iter(rows)))
    assert max(len(batch.times) for batch in batches) <= ROWS
    assert [row for batch in batches for row in zip(*batch, strict=True)] == rows


def test_compressed_messages_are_decompressed_and_damaged_ones_reported() -> None:
    packed = zstd.compress(b"\0\1" * 50)
    rows = [(1, 0, b"\0\1"), (2, 1, packed), (3, 2, packed[:-3]), (4, 1, b"")]
    lost: list[tuple[int, str]] = []
    (batch,) = Batch.of_rows(rows).unpacked(1000, lambda *row: lost.append(row))
    assert (batch.times.tolist(), batch.topics.tolist()) == ([1, 2, 4], [0, 1, 1])
    assert batch.data.tolist() == [b"\0\1", b"\0\1" * 50, b""]
    assert lost == [(2, "its compressed data is cut off")]
    batch = Batch.of_rows(rows[:1])
    assert list(batch.unpacked(100, lambda place, cause: pytest.fail(cause))) == [batch]


def test_messages_that_expand_beyond_the_limit_together_come_one_batch_after_the_other() -> None:
    packed = zstd.compress(bytes(1000))
    lost: list[tuple[int, str]] = []
    rows = [(time, 0, packed) for time in range(5)] + [(5, 1, zstd.compress(bytes(2001)))]
    batches = list(Batch.of_rows(rows).unpacked(2000, lambda *row: lost.append(row)))
    assert [batch.times.tolist() for batch in batches] == [[0, 1], [2, 3], [4]]
    assert all(data == bytes(1000) for batch in batches for data in batch.data)
    assert lost == [(1, "it expands to more than 2000 bytes")]


def test_columns_give_the_rows_they_were_made_of() -> None:
    rows = [(5, 1, b"x"), (2**64 - 1, 0, b"y"), (7, 1, b"")]
    batch = Batch.of_rows(rows)
    assert [(int(time), int(place), data) for time, place, data in zip(*batch, strict=True)] == rows

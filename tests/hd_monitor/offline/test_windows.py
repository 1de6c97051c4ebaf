"""Windows cut from columns are those that would be cut message by message."""

from collections.abc import Iterable, Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor.offline.batches import ROWS, Batch, in_batches
from hd_monitor.offline.windows import Window, windows

Row = tuple[str, int, bytes]


def one_by_one(rows: Iterable[Row], length: int, most: int, pause: int) -> Iterator[Window]:
    collected: dict[str, list[bytes]] = {}
    opened = latest = count = 0
    for topic, time, data in rows:
        full = count >= most or not opened <= time < opened + length or time - latest >= pause
        if count and full:
            yield Window(opened, latest, collected)
            collected, count = {}, 0
        if not count:
            opened = time
        collected.setdefault(topic, []).append(data)
        latest = time
        count += 1
    if count:
        yield Window(opened, latest, collected)


topics = st.sampled_from(["/a", "/b", "/c"])
steps = st.one_of(st.integers(0, 3), st.sampled_from([-10, 9, 10, 11, 30]))
pieces = st.lists(st.lists(st.tuples(topics, steps), min_size=1, max_size=12), max_size=6)


@settings(max_examples=500)
@given(
    start=st.sampled_from([0, 1_700_000_000_000_000_000, 2**63 - 20, 2**63, 2**64 - 2500]),
    pieces=pieces,
    length=st.sampled_from([1, 10, 25, 1000]),
    most=st.integers(1, 10),
    pause=st.sampled_from([1, 2, 10, 25, 1000]),
)
def test_windows_do_not_depend_on_batches(
    start: int, pieces: list[list[tuple[str, int]]], length: int, most: int, pause: int
) -> None:
    time, batches = 0, []
    for piece in pieces:
        rows = []
        for topic, step in piece:
            time = max(time + step, 0)
            rows.append((topic, start + time, b"%d" % time))
        batches.append(Batch.of_rows(rows, str))
    every = [row for batch in batches for row in batch.rows()]
    found = list(windows(batches, length=length, most=most, pause=pause))
    assert found == list(one_by_one(every, length, most, pause))


def test_what_a_failing_source_gave_before_is_handed_on() -> None:
    def rows() -> Iterator[Row]:
        for number in range(ROWS + 7):
            yield "/a", number, b""
        raise OSError("gone")

    batches = in_batches(rows())
    assert [len(next(batches).data), len(next(batches).data)] == [ROWS, 7]
    with pytest.raises(OSError, match="gone"):
        next(batches)


def test_columns_give_the_rows_they_were_made_of() -> None:
    rows = [("/b", 5, b"x"), ("/a", 2**64 - 1, b"y"), ("/b", 7, b"")]
    batch = Batch.of_rows(rows, str)
    assert list(batch.rows()) == rows
    assert batch.counts() == {"/a": 1, "/b": 2}

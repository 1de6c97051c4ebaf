"""SQLite storage files, read by the schema of rosbag2_storage_sqlite3: tables ``topics`` and ``messages``."""

import itertools
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

from .batches import Batch, RawTopic, in_batches

MAGIC = b"SQLite format 3\0"

_STEPS = 100_000
"""Instructions of SQLite's between two looks at how many there were."""
_STEPS_OF_A_BYTE = 3
"""Instructions for which a byte of a file may account; one of a sound recording accounts for less than one."""


def has_unsaved_rows(path: Path) -> bool:
    """Whether a write-ahead log stands beside the file: its recorder was not closed."""
    return _log(path).is_file() and _log(path).stat().st_size > 0


def _log(path: Path) -> Path:
    return path.with_name(f"{path.name}-wal")


@contextmanager
def opened(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a file for reading, with what its write-ahead log holds; without one nothing is written beside it.

    Raises
    ------
    ValueError
        If the file asks for more work than its size can account for.
    sqlite3.Error
        If it is damaged.
    """
    unsaved = has_unsaved_rows(path)
    size = path.stat().st_size + (_log(path).stat().st_size if unsaved else 0)
    steps = itertools.count(0, _STEPS)
    mode = "mode=ro" if unsaved else "immutable=1"
    with closing(sqlite3.connect(f"{path.resolve().as_uri()}?{mode}", uri=True)) as database:
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, min(size, (1 << 31) - 1))  # no value is larger than its file
        database.set_progress_handler(lambda: next(steps) > _STEPS + _STEPS_OF_A_BYTE * size, _STEPS)
        try:
            yield database
        except sqlite3.OperationalError as error:
            if str(error) == "interrupted":
                raise ValueError("it leads to more rows than it has room for") from None
            raise


def holds_views(path: Path) -> bool:
    """Whether what should be a table of messages or of topics is worked out by the database instead."""
    query = "SELECT 1 FROM sqlite_master WHERE lower(name) IN ('messages', 'topics') AND rootpage = 0"
    with opened(path) as database:
        return database.execute(query).fetchone() is not None


class WholeSqlite:
    """A SQLite storage file.

    Parameters
    ----------
    path : Path

    Attributes
    ----------
    span : tuple of (int, int) or None
        Times of recording of the first and the last message [ns]; None without messages.

    Raises
    ------
    sqlite3.Error
        If the file is damaged.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        with opened(path) as database:
            counts = dict(database.execute("SELECT topic_id, count(*) FROM messages GROUP BY topic_id"))
            rows = database.execute("SELECT id, name, type FROM topics ORDER BY id").fetchall()
            # One subquery each: only so does SQLite take both ends from its index.
            ends = "SELECT (SELECT min(timestamp) FROM messages), (SELECT max(timestamp) FROM messages)"
            first, last = database.execute(ends).fetchone()
        self._topics = {number: RawTopic(str(name), str(kind), counts.get(number, 0)) for number, name, kind in rows}
        self.span = None if first is None else (int(first), int(last))

    def topics(self) -> list[RawTopic]:
        """Return the topics and how many messages each has."""
        return list(self._topics.values())

    def batches(self, names: Sequence[str]) -> Iterator[Batch]:
        """Yield the messages of the topics of these names by time, those of equal times as they were written.

        Raises
        ------
        Exception
            If the file is damaged.
        """
        places = {number: names.index(name) for number, (name, _, _) in self._topics.items() if name in names}
        query = (
            f"SELECT timestamp, topic_id, data FROM messages WHERE topic_id IN ({', '.join('?' * len(places))}) "
            "ORDER BY timestamp, id"
        )
        with opened(self._path) as database:
            rows = database.execute(query, tuple(places))
            yield from in_batches((time, places[number], data) for time, number, data in rows)

"""SQLite storage files, read by the schema of rosbag2_storage_sqlite3: tables ``topics`` and ``messages``."""

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

from .batches import Batch, RawTopic, in_batches
from .compression import decompress_where_packed

MAGIC = b"SQLite format 3\0"


def has_unsaved_rows(path: Path) -> bool:
    """Whether a write-ahead log stands beside the file: its recorder was not closed."""
    log = path.with_name(f"{path.name}-wal")
    return log.is_file() and log.stat().st_size > 0


def connect(path: Path) -> sqlite3.Connection:
    """Open a file for reading, with what its write-ahead log holds; without one nothing is written beside it."""
    mode = "mode=ro" if has_unsaved_rows(path) else "immutable=1"
    return sqlite3.connect(f"{path.resolve().as_uri()}?{mode}", uri=True)


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
        with closing(connect(path)) as database:
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
        with closing(connect(self._path)) as database:
            rows = database.execute(query, tuple(places))
            for batch in in_batches((time, places[number], data) for time, number, data in rows):
                yield batch._replace(data=decompress_where_packed(batch.data))

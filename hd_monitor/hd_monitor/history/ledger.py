"""The ledger: one SQLite file with the entries of every reducer of a robot.

The file has two tables, ``reducers`` and ``entries``; what is searched for has a column, the rest is JSON. It has a
write-ahead log, so that a reader never waits for the writer and a process killed at any time leaves the entries before.
"""

import json
import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

from ..errors import OutputError
from .entry import Entry, Kind

PATIENCE = 2.0
"""s to wait for another process that is writing."""

_REDUCER_BITS = 32
"""By which an entry's id begins with its reducer: SQLite lays rows out by id, so that a reducer's lie together."""

_PAGE = 16_384
"""Bytes that are read at once, about ten entries; of a new file."""

_SCHEMA = (
    """
CREATE TABLE reducers (
    id INTEGER PRIMARY KEY,
    serial TEXT NOT NULL,
    joint TEXT NOT NULL,
    UNIQUE (serial, joint)
);
CREATE TABLE entries (
    id INTEGER PRIMARY KEY,
    reducer INTEGER NOT NULL REFERENCES reducers,
    joint TEXT NOT NULL,
    time REAL NOT NULL,
    kind TEXT NOT NULL,
    recording TEXT NOT NULL,
    content TEXT NOT NULL
);
CREATE INDEX by_time ON entries (reducer, time);
CREATE UNIQUE INDEX one_of_a_recording ON entries (reducer, recording, time, kind) WHERE recording != '';
""",
    "CREATE INDEX exchanges ON entries (reducer, time) WHERE kind = 'exchange';",
    f"""
CREATE TABLE gathered (
    id INTEGER PRIMARY KEY,
    reducer INTEGER NOT NULL REFERENCES reducers,
    joint TEXT NOT NULL,
    time REAL NOT NULL,
    kind TEXT NOT NULL,
    recording TEXT NOT NULL,
    content TEXT NOT NULL
);
INSERT INTO gathered
    SELECT (reducer << {_REDUCER_BITS}) + ROW_NUMBER() OVER (PARTITION BY reducer ORDER BY id),
        reducer, joint, time, kind, recording, content
    FROM entries;
DROP TABLE entries;
ALTER TABLE gathered RENAME TO entries;
CREATE INDEX by_time ON entries (reducer, time);
CREATE UNIQUE INDEX one_of_a_recording ON entries (reducer, recording, time, kind) WHERE recording != '';
CREATE INDEX exchanges ON entries (reducer, time) WHERE kind = 'exchange';
""",
)
"""What makes the tables of each version out of those of the one before."""

VERSION = len(_SCHEMA)
"""Of the tables, in ``PRAGMA user_version``."""


class LedgerError(OutputError):
    """The ledger cannot be read or written; what it had is still there."""


class Reducer(NamedTuple):
    """A reducer that the ledger knows: its serial number, or where that is empty the joint."""

    serial: str
    joint: str

    def __str__(self) -> str:
        """Return the name by which people know it."""
        return self.serial or f"joint {self.joint} (no serial number)"


class Ledger:
    """The file, open for reading and writing.

    Parameters
    ----------
    path : Path
        Made if missing, unless `read_only`.
    read_only : bool
        Whether it is only read, also from a disk that cannot be written.

    Raises
    ------
    LedgerError
        If it cannot be opened, is not a ledger, or was written by a newer version.
    """

    def __init__(self, path: Path, *, read_only: bool = False) -> None:
        self.path = path
        if read_only and not path.is_file():
            raise LedgerError(f"{path} does not exist; give the file of history.path or of replay --history")
        if not read_only:
            try:
                path.open("ab").close()  # SQLite does not say why it cannot open a file
            except OSError as error:
                raise LedgerError(f"{path} cannot be opened: {error.strerror}; choose another place") from None
        # Where nothing can be written, SQLite reads a file with a write-ahead log only if told that nobody writes to it
        frozen = read_only and not os.access(path.parent, os.W_OK)
        place = f"{path.absolute().as_uri()}{'?immutable=1' if frozen else ''}"
        with self._explained("opened"):
            self._file = sqlite3.connect(place, uri=True, timeout=PATIENCE, isolation_level=None)
        try:
            with self._explained("opened"):
                if not frozen:
                    self._file.execute(f"PRAGMA page_size = {_PAGE}")
                    self._file.execute("PRAGMA journal_mode = WAL")
                    self._file.execute("PRAGMA synchronous = FULL")
                self._set_up()
        except LedgerError:
            self._file.close()
            raise

    def __enter__(self) -> Self:
        """Return the ledger."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Close the file."""
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    # Writing ---------------------------------------------------------------------------------------------------------

    def append(self, entry: Entry) -> None:
        """Write an entry, whole or not at all; one of the same recording and time takes the place of the one before.

        Raises
        ------
        LedgerError
            If the disk is full, say; the entries before are still there.
        """
        content = json.dumps(entry.content(), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        reducer = _reducer(entry.serial, entry.joint)
        with self._explained("written"), self._transaction():
            self._file.execute("INSERT OR IGNORE INTO reducers (serial, joint) VALUES (?, ?)", reducer)
            self._file.execute(
                "INSERT OR REPLACE INTO entries (id, reducer, joint, time, kind, recording, content) "
                f"SELECT 1 + MAX(own.id << {_REDUCER_BITS}, COALESCE((SELECT MAX(id) FROM entries "
                f"WHERE id < (own.id + 1) << {_REDUCER_BITS}), 0)), own.id, ?, ?, ?, ?, ? "
                "FROM reducers AS own WHERE serial = ? AND joint = ?",
                (entry.joint, entry.time, entry.kind.value, entry.recording, content, *reducer),
            )

    def mark(self, serial: str, joint: str, kind: Kind, at: float = 0.0) -> None:
        """Note an exchange or a baseline at a time [s], but not before what is known by then; see `append`."""
        newest = self.latest(serial, joint)
        self.append(Entry(serial=serial, joint=joint, time=max(at, newest.time if newest else at), kind=kind))

    # Reading ---------------------------------------------------------------------------------------------------------

    def reducers(self, serial: str | None = None) -> list[Reducer]:
        """Return every reducer, or those of one serial number, by serial number, then by joint."""
        query = "SELECT serial, joint FROM reducers WHERE serial = COALESCE(?, serial) ORDER BY serial, joint"
        with self._explained("read"):
            rows = self._file.execute(query, (serial,)).fetchall()
        return [Reducer(*row) for row in rows]

    def entries(self, serial: str, joint: str = "", *, newest: int | None = None) -> list[Entry]:
        """Return the entries of a reducer since it was put in, by time.

        Parameters
        ----------
        serial : str
        joint : str
            Counts only where the serial number is empty.
        newest : int, optional
            How many at most.
        """
        query = (
            "WITH own AS (SELECT id, serial FROM reducers WHERE serial = ? AND joint = ?), "
            "fresh AS (SELECT COALESCE(MAX(time), -1e300) AS time, COALESCE(MAX(entries.id), 0) AS id "
            "FROM entries JOIN own ON reducer = own.id WHERE kind = 'exchange') "
            "SELECT own.serial, joint, entries.time, kind, content FROM entries JOIN own ON reducer = own.id, fresh "
            "WHERE (entries.time, entries.id) > (fresh.time, fresh.id) "
            "ORDER BY entries.time DESC, entries.id DESC LIMIT ?"
        )
        with self._explained("read"):
            rows = self._file.execute(query, (*_reducer(serial, joint), -1 if newest is None else newest)).fetchall()
            return [
                Entry.from_content(of, at, time, kind, json.loads(content))
                for of, at, time, kind, content in reversed(rows)
            ]

    def latest(self, serial: str, joint: str = "") -> Entry | None:
        """Return the newest entry of a reducer since it was put in; None if there is none."""
        found = self.entries(serial, joint, newest=1)
        return found[-1] if found else None

    # -----------------------------------------------------------------------------------------------------------------

    def _set_up(self) -> None:
        if self._file.execute("PRAGMA user_version").fetchone() == (VERSION,):
            return
        with self._transaction():
            (version,) = self._file.execute("PRAGMA user_version").fetchone()
            if version > VERSION:
                raise LedgerError(
                    f"{self.path} was written by a newer hd_monitor (tables of version {version}, this one knows "
                    f"{VERSION}); update hd_monitor"
                )
            if version == VERSION:
                return
            (tables,) = self._file.execute("SELECT COUNT(*) FROM sqlite_master").fetchone()
            if tables and not version:
                raise LedgerError(f"{self.path} is a database of something else; give another file")
            for statement in filter(str.strip, ";".join(_SCHEMA[version:]).split(";")):
                self._file.execute(statement)
            self._file.execute(f"PRAGMA user_version = {VERSION}")

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        """Do all that is written, or nothing."""
        self._file.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._file.execute("COMMIT")
        except BaseException:
            if self._file.in_transaction:
                self._file.execute("ROLLBACK")
            raise

    @contextmanager
    def _explained(self, what: str) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise LedgerError(f"{self.path} cannot be {what}: {error}; entries already there are kept") from None
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            if isinstance(error, LedgerError):
                raise
            raise LedgerError(f"{self.path} has an entry that cannot be read: {error!r}; restore the file") from None


def _reducer(serial: str, joint: str) -> Reducer:
    """Return what identifies a reducer: the joint only where there is no serial number."""
    return Reducer(serial, "" if serial else joint)

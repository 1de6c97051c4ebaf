"""Recordings: rosbag2 folders and single files, MCAP or SQLite, compressed or not, whole or damaged."""

import re
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import ExitStack, suppress
from itertools import starmap
from pathlib import Path
from types import TracebackType
from typing import Self

from rosbags.rosbag2 import Reader

from .batches import Batch, in_batches
from .compression import MAGIC, decompress, decompress_file
from .errors import BagError, one_line
from .salvage import DamagedMcap, DamagedSqlite, RawMessage, RawTopic, restore_length
from .whole import read_whole
from .windows import Window, windows

__all__ = ["Bag", "Window"]

STORAGE_SUFFIXES = (".mcap", ".db3")
COMPRESSED_SUFFIXES = (".zstd", ".zst")
WINDOW = 12_000_000_000
"""Recorded time [ns] that is handed over at once: long enough for bulk decoding, short enough for flat memory."""
WINDOW_MESSAGES = 16_384


class Bag:
    """An open recording.

    Parameters
    ----------
    path : path-like
        A rosbag2 folder, or a single ``.mcap`` or ``.db3`` file, also Zstandard-compressed.

    Attributes
    ----------
    path : Path
    topics : tuple of RawTopic
    start, end : int or None
        Times of recording of the first and the last message [ns]; None if the file does not say.
    notes : list of str
        What is wrong with the recording; grows while it is read.

    Raises
    ------
    BagError
        If nothing can be read from it.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.notes: list[str] = []
        self.start: int | None = None
        self.end: int | None = None
        self._stack = ExitStack()
        self._reader: Reader | None = None
        self._pieces: list[DamagedMcap | DamagedSqlite] = []
        try:
            self.topics = self._open()
        except BaseException:
            self._stack.close()
            raise
        if not any(topic.messages for topic in self.topics):
            self._stack.close()
            raise BagError(f"{self.path} holds no messages: nothing was recorded, or nothing of it was saved")

    def __enter__(self) -> Self:
        """Return the recording, which is open already."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the recording."""
        self._stack.close()

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """Yield the messages of `topics` by the time of their recording.

        Where the recording turns out to be damaged, a note is made and what is still whole goes on coming.
        """
        for batch in self._batches(topics):
            yield from starmap(RawMessage, batch.rows())

    def windows(self, topics: Collection[str], *, pause: int = 0) -> Iterator[Window]:
        """Yield the messages of `topics` by windows of recorded time; memory stays flat in the bag's length.

        A `pause` [ns] in the recording, unless 0, begins a new window.
        """
        return windows(self._batches(topics), length=WINDOW, most=WINDOW_MESSAGES, pause=pause or WINDOW)

    def _batches(self, topics: Collection[str]) -> Iterator[Batch]:
        wanted = set(topics)
        delivered: Counter[str] = Counter()
        if self._reader is not None:
            try:
                for batch in read_whole(self._reader, wanted):
                    yield batch
                    delivered += batch.counts()
                return
            except Exception as error:  # a parser of damaged files raises anything
                self._note(
                    f"{self.path.name} is damaged ({one_line(error)}); what is still whole is read piece by piece"
                )
                self._pieces = [self._piece(file) for file in self._files()]
        for piece in self._pieces:
            yield from in_batches(self._salvaged(piece, wanted, delivered))

    def _open(self) -> tuple[RawTopic, ...]:
        if not self.path.exists():
            raise BagError(f"{self.path} does not exist; give a rosbag2 folder or a .mcap or .db3 file")
        if self.path.is_file() and self.path.suffix not in STORAGE_SUFFIXES + COMPRESSED_SUFFIXES:
            if self.path.suffix == ".bag":
                raise BagError(f"{self.path} is a ROS 1 bag; convert it first: rosbags-convert --src … --dst …")
            raise BagError(f"{self.path} is no rosbag2 recording; give its folder, or its .mcap or .db3 file")
        try:
            files = self._files()
        except OSError as error:
            raise BagError(f"{self.path} cannot be read: {error.strerror}; check its permissions") from None
        if not files:
            raise BagError(f"{self.path} is no rosbag2 recording: no .mcap or .db3 file is in it")
        unsaved = [file.name for file in files if _has_unsaved_rows(file)]
        if unsaved:
            self._note(f"{', '.join(unsaved)} was not closed: what its write-ahead log holds is read too")
        else:
            try:
                return self._open_whole(files)
            except Exception as error:  # a parser of damaged files raises anything
                self._note(f"{self.path.name} is not whole ({one_line(error)}); only what is still whole is read")
        pieces = []
        for file in files:
            try:
                pieces.append(self._piece(file))
            except BagError as error:
                if len(files) == 1:
                    raise
                self._note(str(error))
        self._pieces = pieces
        if not pieces:
            raise BagError(f"{self.path}: none of its {len(files)} files can be read; give another recording")
        return _merged(topic for piece in pieces for topic in piece.topics())

    def _open_whole(self, files: list[Path]) -> tuple[RawTopic, ...]:
        single = self.path.is_file()
        reader = Reader(self._plain(files[0]) if single else self.path)
        reader.open()
        self._stack.callback(_close_quietly, reader)
        self._reader = reader
        if reader.message_count:
            self.start, self.end = reader.start_time, reader.end_time
        return _merged(RawTopic(c.topic, c.msgtype, c.msgcount) for c in reader.connections)

    def _files(self) -> list[Path]:
        if self.path.is_file():
            return [self.path]
        return sorted((file for file in self.path.iterdir() if _is_storage(file)), key=_natural_order)

    def _piece(self, file: Path) -> DamagedMcap | DamagedSqlite:
        plain = self._plain(file)
        if plain.suffix == ".mcap":
            return DamagedMcap(plain, self._note)
        whole = self._folder() / plain.name
        if restore_length(plain, whole):
            self._note(f"{plain.name} is cut off: the recording was not closed")
            plain = whole
        return DamagedSqlite(plain, self._note)

    def _plain(self, file: Path) -> Path:
        """Return `file`, or a decompressed copy of it that lives as long as the bag is open."""
        if file.suffix not in COMPRESSED_SUFFIXES:
            return file
        plain = self._folder() / file.stem
        plain.touch()
        try:
            decompress_file(file, plain)
        except Exception as error:  # the class is the decompressor's own
            self._note(f"{file.name} is damaged ({one_line(error)}): only what precedes the damage is read")
        return plain

    def _folder(self) -> Path:
        """Make a folder that lives as long as the bag is open."""
        return Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="hd-monitor-")))

    def _salvaged(
        self, piece: DamagedMcap | DamagedSqlite, wanted: Collection[str], delivered: Counter[str]
    ) -> Iterator[RawMessage]:
        """Yield what is whole in a file, but for as many messages of each topic as have been delivered already."""
        for message in piece.messages():
            if message.topic not in wanted:
                continue
            data = message.data
            if data[:4] == MAGIC:
                try:
                    data = decompress(data)
                except Exception:  # a damaged message is missing: the gap is counted further on
                    continue
            if delivered[message.topic]:
                delivered[message.topic] -= 1
                continue
            yield message._replace(data=data)

    def _note(self, sentence: str) -> None:
        if sentence not in self.notes:
            self.notes.append(sentence)


def _close_quietly(reader: Reader) -> None:
    with suppress(Exception):  # a damaged file may fail at its closing too
        reader.close()


def _is_storage(file: Path) -> bool:
    suffixes = file.suffixes[-2:] if file.suffix in COMPRESSED_SUFFIXES else file.suffixes[-1:]
    return bool(suffixes) and suffixes[0] in STORAGE_SUFFIXES and file.is_file()


def _natural_order(file: Path) -> list[tuple[int, str]]:
    """Key that puts bag_2 before bag_10."""
    return [(int(part or 0), text) for text, part in re.findall(r"(\D*)(\d*)", file.name)]


def _has_unsaved_rows(file: Path) -> bool:
    log = file.with_name(f"{file.name}-wal")
    return log.is_file() and log.stat().st_size > 0


def _merged(topics: Iterator[RawTopic]) -> tuple[RawTopic, ...]:
    counts: Counter[tuple[str, str]] = Counter()
    for topic in topics:
        counts[topic.name, topic.type] += topic.messages
    return tuple(RawTopic(name, kind, count) for (name, kind), count in sorted(counts.items()))

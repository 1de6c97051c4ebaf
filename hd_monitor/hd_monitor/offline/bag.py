"""Recordings: rosbag2 folders and single files, MCAP or SQLite, compressed or not, whole or damaged."""

import os
import re
import shutil
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path, PurePath
from typing import NamedTuple, Self

import numpy as np
import yaml

from .batches import Batch, RawMessage, RawTopic, Window, in_batches
from .compression import CHUNK_LIMIT, decompress_file
from .errors import BagError, one_line
from .salvage import McapWalk, SqliteWalk, Walk, length_before_cut
from .sqlite import WholeSqlite, has_unsaved_rows, holds_views
from .whole_mcap import WholeMcap

STORAGE_SUFFIXES = (".mcap", ".db3")
COMPRESSED_SUFFIXES = (".zstd", ".zst")


_LARGEST_METADATA = 1_000_000
"""Bytes of a metadata.yaml that are still read, in some seconds: 5000 files in a folder have no more."""


class _Part(NamedTuple):
    """A file as the user knows it, the same decompressed, and what reads it."""

    given: Path
    plain: Path
    reader: WholeMcap | WholeSqlite | Walk


class Bag:
    """An open recording.

    Parameters
    ----------
    path : path-like
        A rosbag2 folder, or a single ``.mcap`` or ``.db3`` file, also Zstandard-compressed.
    chunk_limit : int
        Bytes to which a compressed chunk or message may expand; what expands further is left out, with a note.

    Attributes
    ----------
    path : Path
    topics : tuple of RawTopic
    span : tuple of (int, int) or None
        Times of recording of the first and the last message [ns]; None if the files do not say.
    notes : list of str
        What is wrong with the recording; grows while it is read.

    Raises
    ------
    BagError
        If nothing can be read from it.
    """

    def __init__(self, path: str | Path, chunk_limit: int = CHUNK_LIMIT) -> None:
        self.path = Path(path)
        self._limit = chunk_limit
        self.notes: list[str] = []
        self.span: tuple[int, int] | None = None
        self._stack = ExitStack()
        self._parts: list[_Part] = []
        try:
            self.topics = self._open()
        except BaseException:
            self._stack.close()
            raise

    def __enter__(self) -> Self:
        """Return the recording, which is open already."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the recording."""
        self._stack.close()

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """Yield the messages of `topics` by the time of their recording.

        If the recording turns out to be damaged, a note is made and the intact messages are still yielded.
        """
        names = list(dict.fromkeys(topics))
        for batch in self._batches(names):
            for time, place, data in zip(*(column.tolist() for column in batch), strict=True):
                yield RawMessage(names[place], time, data)

    def windows(self, topics: Collection[str], *, pause: int = 0) -> Iterator[Window]:
        """Yield the messages of `topics` by the thousand; memory stays flat in the bag's length.

        A `pause` [ns] in the recording, unless 0, begins a new window.
        """
        names = list(dict.fromkeys(topics))
        for batch in self._batches(names):
            yield from batch.windows(names, pause)

    def _batches(self, names: Sequence[str]) -> Iterator[Batch]:
        for given, plain, reader in self._parts:

            def lost(place: int, cause: str, file: str = given.name) -> None:
                self._note(f"{file}: messages of {names[place]} were left out ({cause})")

            delivered = _Delivered(len(names))
            if not isinstance(reader, Walk):
                try:
                    for batch in reader.batches(names):
                        yield from batch.unpacked(self._limit, lost)
                        delivered.add(batch)
                    self._count(given.name, reader, dict(zip(names, delivered.counts.tolist(), strict=True)))
                    continue
                except Exception as error:  # a parser of damaged files raises anything
                    cause = f"{given.name} is damaged ({one_line(error)})"
                    self._note(f"{cause}; what is still whole is read piece by piece")
                    reader = self._walk(given, plain)
            for batch in in_batches(_salvaged(reader, names, delivered)):
                yield from batch.unpacked(self._limit, lost)

    def _count(self, file: str, reader: WholeMcap | WholeSqlite, delivered: Mapping[str, int]) -> None:
        """Note the topics of which a file read to its end held fewer messages than it announces."""
        announced: Counter[str] = Counter()
        for name, _, messages in reader.topics():
            announced[name] += messages
        for name, count in delivered.items():
            if count < announced[name]:
                self._note(f"{file}: of {announced[name]} messages announced on {name}, {count} were found")

    def _open(self) -> tuple[RawTopic, ...]:
        if not self.path.exists():
            raise BagError(f"{self.path} does not exist; give a rosbag2 folder or a .mcap or .db3 file")
        if self.path.is_file() and self.path.suffix not in STORAGE_SUFFIXES + COMPRESSED_SUFFIXES:
            if self.path.suffix == ".bag":
                raise BagError(f"{self.path} is a ROS 1 bag; convert it first: rosbags-convert --src … --dst …")
            raise BagError(f"{self.path} is not a rosbag2 recording; give its folder, or its .mcap or .db3 file")
        try:
            files = self._files()
        except OSError as error:
            raise BagError(f"{self.path} cannot be read: {error.strerror}; check its permissions") from None
        if not files:
            raise BagError(f"{self.path} is not a rosbag2 recording: it contains no .mcap or .db3 file")
        for file in files:
            try:
                self._parts.append(self._part(file))
            except BagError as error:
                if len(files) == 1:
                    raise
                self._note(str(error))
        if not self._parts:
            raise BagError(f"{self.path}: none of its {len(files)} files can be read; give another recording")
        readers = [part.reader for part in self._parts]
        spans = [reader.span for reader in readers if not isinstance(reader, Walk) and reader.span]
        if spans and not any(isinstance(reader, Walk) for reader in readers):
            self.span = min(spans)[0], max(end for _, end in spans)
        counts: Counter[tuple[str, str]] = Counter()
        for reader in readers:
            for name, kind, messages in reader.topics():
                counts[name, kind] += messages
        if not counts.total():
            raise BagError(f"{self.path} holds no messages: nothing was recorded, or nothing of it was saved")
        return tuple(RawTopic(*topic, count) for topic, count in sorted(counts.items()))

    def _files(self) -> list[Path]:
        """Return the storage files, in the order that the metadata gives if there are any."""
        if self.path.is_file():
            return [self.path]
        found = sorted((file for file in self.path.iterdir() if _is_storage(file)), key=_natural_order)
        if not found:
            return []
        by_name = {file.name: file for file in found}
        try:
            with (self.path / "metadata.yaml").open("rb") as file:
                content = file.read(_LARGEST_METADATA + 1)
            if len(content) > _LARGEST_METADATA:
                raise ValueError(f"it is larger than {_LARGEST_METADATA} bytes")
            metadata = yaml.safe_load(content)
            names = [PurePath(path).name for path in metadata["rosbag2_bagfile_information"]["relative_file_paths"]]
        except Exception as error:  # damaged YAML is anything
            self._note(f"{self.path.name}: metadata.yaml cannot be read ({one_line(error)}); all its files are taken")
            return found
        if missing := [name for name in names if name not in by_name]:
            listed = one_line(", ".join(missing))
            self._note(f"{self.path.name} is not whole ({listed} missing); only what is there is read")
        return [by_name[name] for name in dict.fromkeys(names) if name in by_name] or found

    def _part(self, file: Path) -> _Part:
        """Return a file, decompressed, and what reads it: in bulk if it is whole."""
        plain = self._plain(file)
        if has_unsaved_rows(plain):
            self._note(f"{file.name} was not closed: what its write-ahead log holds is read too")
        try:
            if plain.suffix != ".mcap":
                if holds_views(plain):
                    raise BagError(f"{file} computes its messages instead of storing them; give a recorded bag")
                return _Part(file, plain, WholeSqlite(plain))
            whole = WholeMcap(plain, self._limit, lambda sentence: self._note(f"{file.name}: {sentence}"))
            if whole.indexed:
                return _Part(file, plain, whole)
        except BagError:
            raise
        except Exception as error:  # a parser of damaged files raises anything
            self._note(f"{file.name} is not whole ({one_line(error)}); only what is still whole is read")
        return _Part(file, plain, self._walk(file, plain))

    def _walk(self, file: Path, plain: Path) -> Walk:
        if plain.suffix != ".mcap":
            if (length := length_before_cut(plain)) is not None:
                self._note(f"{file.name} is cut off: the recording was not closed")
                plain = self._lengthened(file, plain, length)
            return SqliteWalk(plain, file, self._limit, self._note)
        return McapWalk(plain, file, self._limit, self._note)

    def _lengthened(self, file: Path, plain: Path, length: int) -> Path:
        """Copy a SQLite file with zeros in place of what is missing: SQLite reads none that is too short."""
        try:
            whole = self._folder() / plain.name
            shutil.copyfile(plain, whole)
            os.truncate(whole, length)
        except OSError as error:
            raise BagError(
                f"{file} is cut off, and a copy of the {length / 1e6:.4g} MB that its header announces cannot be made "
                f"in {tempfile.gettempdir()} ({error.strerror}); make room there, or set TMPDIR to another folder"
            ) from None
        return whole

    def _plain(self, file: Path) -> Path:
        """Return `file`, or a decompressed copy of it that lives as long as the bag is open."""
        if file.suffix not in COMPRESSED_SUFFIXES:
            return file
        try:
            plain = self._folder() / file.stem
            decompress_file(file, plain, self._limit)
        except OSError as error:
            where = f"{file} cannot be decompressed into {tempfile.gettempdir()} ({error.strerror})"
            raise BagError(f"{where}; make room there, or set TMPDIR to another folder") from None
        except Exception as error:  # the class is the decompressor's own
            self._note(f"{file.name} is damaged ({one_line(error)}): only what precedes the damage is read")
        return plain

    def _folder(self) -> Path:
        """Make a folder that lives as long as the bag is open."""
        return Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="hd-monitor-")))

    def _note(self, sentence: str) -> None:
        if sentence not in self.notes:
            self.notes.append(sentence)


class _Delivered:
    """What of a file has been read in bulk, in order of time: it need not be given again."""

    def __init__(self, topics: int) -> None:
        self.counts = np.zeros(topics, dtype=np.intp)
        self._newest = np.zeros(topics, dtype=np.intp)  # messages of the time last read
        self._until: int | None = None

    def add(self, batch: Batch) -> None:
        """Take note of messages, at least one."""
        topics, last = self.counts.size, int(batch.times[-1])
        self.counts += np.bincount(batch.topics, minlength=topics)
        newest = np.bincount(batch.topics[batch.times == batch.times[-1]], minlength=topics)
        self._newest = newest + (self._newest if last == self._until else 0)
        self._until = last

    def covers(self, time: int, place: int) -> bool:
        """Whether the next message of this time and topic is among them; of equal times the first are."""
        if self._until is None or time != self._until:
            return self._until is not None and time < self._until
        self._newest[place] -= 1
        return bool(self._newest[place] >= 0)


def _salvaged(walk: Walk, names: Sequence[str], delivered: _Delivered) -> Iterator[tuple[int, int, bytes]]:
    """Yield what is whole in a file and has not been delivered yet."""
    places = {name: place for place, name in enumerate(names)}
    for name, time, data in walk.messages():
        place = places.get(name)
        if place is not None and not delivered.covers(time, place):
            yield time, place, data


def _is_storage(file: Path) -> bool:
    suffixes = file.suffixes[-2:] if file.suffix in COMPRESSED_SUFFIXES else file.suffixes[-1:]
    return bool(suffixes) and suffixes[0] in STORAGE_SUFFIXES and file.is_file()


def _natural_order(file: Path) -> list[tuple[int, str]]:
    """Key that puts bag_2 before bag_10."""
    return [(int(part or 0), text) for text, part in re.findall(r"(\D*)(\d*)", file.name)]

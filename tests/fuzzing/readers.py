"""Everything that reads what comes from outside, as functions of bytes, each with whole inputs to begin from."""

import json
import re
import sqlite3
import struct
from argparse import ArgumentParser
from collections.abc import Callable, Sequence
from contextlib import closing, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from tests.fuzzing.survival import trusts_a_count
from tests.hd_monitor.monitored import EPOCH, PAPER, Recording
from tests.hd_monitor.offline import mcap_files, recordings

from hd_monitor.adapters import Inputs
from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.assessment import Assessment
from hd_monitor.cli import compare
from hd_monitor.contract import Block
from hd_monitor.diagnosis.status import input_status_of, status_of
from hd_monitor.monitor import Monitor
from hd_monitor.offline.bag import Bag
from hd_monitor.offline.parameters import load_parameters, parse_override
from hd_monitor.offline.plan import Request
from hd_monitor.offline.run import replay_bag
from hd_monitor.settings import JointSettings, set_aside_foreign, split_joints
from hd_monitor.sources import INPUT_SOURCES, Quantity

CONFIG = Path(__file__).resolve().parents[2] / "config"


class Counter:
    """Takes what the decoders yield and counts the messages it stands for."""

    def __init__(self) -> None:
        self.taken = 0

    def add(self, quantity: Quantity, stamps: IntArray, *columns: FloatArray) -> None:
        """Count samples."""
        assert all(column.shape == stamps.shape for column in columns)
        self.taken += stamps.size

    def add_block(self, block: Block) -> None:
        """Count a block."""
        assert block.samples.ndim == 1
        self.taken += 1

    def reject(self, reason: str) -> None:
        """Hold the reason to one line."""
        assert "\n" not in reason


class Prepared(NamedTuple):
    """A reader, ready to run, and whole inputs."""

    read: Callable[[bytes], object]
    seeds: Sequence[bytes]


def put_into_words(assessment: Assessment) -> None:
    """Write both statuses; no number that does not exist may be among the words."""
    statuses = status_of(assessment, "joint"), input_status_of(assessment, "joint")
    for text in (status.message for status in statuses):
        assert text
        assert not re.search(r"\b(nan|inf)\b", text), text


def read_bag(path: Path) -> None:
    """Read all messages of a recording."""
    with Bag(path) as bag:
        for _ in bag.messages([topic.name for topic in bag.topics]):
            pass
        assert not any("\n" in note for note in bag.notes)


def load(path: Path) -> None:
    """Read a parameter file as every command does."""
    split_joints(set_aside_foreign(load_parameters(path))[0])


def override(text: str) -> None:
    """Read a ``-p name:=value``."""
    split_joints(set_aside_foreign(dict([parse_override(text)]))[0])


def result_of_a_replay(folder: Path) -> dict[str, Any]:
    """Return what ``replay --json`` writes of a short recording."""
    events = recordings.simulated(programme="fixed", fixed__speed=1500.0, duration=6.0)
    return replay_bag(recordings.write(folder / "bag", events), Request()).content


def comparison(folder: Path) -> Prepared:
    """Compare a result with any other."""
    before, after = folder / "before.json", folder / "after.json"
    whole = json.dumps(result_of_a_replay(folder)).encode()
    before.write_bytes(whole)
    parser = ArgumentParser()
    compare.configure(parser)
    arguments = parser.parse_args([str(before), str(after)])

    def compared(content: bytes) -> None:
        after.write_bytes(content)
        with redirect_stdout(StringIO()):
            compare.run(arguments)

    return Prepared(compared, [whole])


def messages(folder: Path) -> Prepared:
    """Decode a message as each type that any input may have."""
    chosen = [JointSettings.from_mapping({"input.source": word, "input.sensor_radius": 0.5}) for word in INPUT_SOURCES]
    chosen.append(JointSettings.from_mapping({"load.source": "wrench"}))

    def decode(data: bytes) -> None:
        for settings in chosen:
            for quantity in settings.sources:
                Inputs("joint", settings, Counter()).add(quantity, [data])

    start = recordings.START
    whole = (
        recordings.block(start, 1e-3, 7, [0.5, -0.25]),
        recordings.accel(start, 3.0),
        recordings.wrench(start, 3.0),
        recordings.imu(start, 3.0),
        recordings.joint_state(start, joint=(0.1, 0.2, 0.3), other=(0.4, 0.5, 0.6)),
    )
    return Prepared(decode, [bytes(recordings.STORE.serialize_cdr(each, each.__msgtype__)) for each in whole])


def storage_files(folder: Path) -> dict[str, bytes]:
    """Storage files of small recordings, by the end of their name; several of a kind with a word before it."""
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


def _storage(suffix: str) -> Callable[[Path], Prepared]:
    def prepare(folder: Path) -> Prepared:
        whole = [content for name, content in storage_files(folder).items() if name.endswith(suffix)]
        path = folder / f"damaged{suffix}"

        def write_and_read(content: bytes) -> None:
            path.write_bytes(content)
            read_bag(path)

        return Prepared(write_and_read, whole)

    return prepare


def _metadata(folder: Path) -> Prepared:
    made = storage_files(folder)
    bag = folder / "damaged"
    bag.mkdir()
    (bag / "bag_0.db3").write_bytes(made["rows.db3"])

    def write_and_read(content: bytes) -> None:
        (bag / "metadata.yaml").write_bytes(content)
        read_bag(bag)

    return Prepared(write_and_read, [made["metadata.yaml"]])


def write_rows(path: Path, topics: Sequence[Sequence[object]], rows: Sequence[Sequence[object]]) -> None:
    """Write a SQLite recording of topics (id, name, type) and messages (topic, time, data)."""
    path.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as database:
        database.execute("PRAGMA synchronous = OFF")
        database.execute("CREATE TABLE topics (id, name, type)")
        database.execute("CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id, timestamp, data)")
        database.executemany("INSERT INTO topics VALUES (?, ?, ?)", topics)
        database.executemany("INSERT INTO messages VALUES (NULL, ?, ?, ?)", rows)
        database.commit()


def _rows(folder: Path) -> Prepared:
    """Read rows whose cells the bytes describe: for each a kind and nine bytes at most."""
    path = folder / "rows.db3"

    def cells(data: bytes) -> list[object]:
        found: list[object] = []
        for at in range(0, len(data) - 8, 9):
            own = data[at + 1 : at + 9]
            (number,) = struct.unpack("<q", own)
            kinds = (None, 1, number, struct.unpack("<d", own)[0], own.decode("latin-1"), own)
            found.append(kinds[data[at] % len(kinds)])
        return found

    def write_and_read(data: bytes) -> None:
        found = cells(data)
        triples = [found[at : at + 3] for at in range(0, len(found) - 2, 3)]
        write_rows(path, triples[:2], triples[2:6])
        read_bag(path)

    one, time = b"\1" + bytes(8), b"\2" + struct.pack("<q", recordings.START)
    name, kind = b"\4/ab\0\0\0\0\0", b"\4string\0\0"
    return Prepared(write_and_read, [one + name + kind + one + time + b"\5" + bytes(8), 6 * (one + time + kind)])


def _parameters(folder: Path) -> Prepared:
    path = folder / "parameters.yaml"

    def write_and_load(content: bytes) -> None:
        path.write_bytes(content)
        load(path)

    return Prepared(write_and_load, [file.read_bytes() for file in sorted(CONFIG.glob("*.yaml"))])


def _overrides(folder: Path) -> Prepared:
    seeds = [b"load.torque:=12.5", b"joints:=[a, b]", b"reducer.mount:=flexspline_fixed"]
    return Prepared(lambda data: override(data.decode(errors="replace")), seeds)


_SAMPLES = 5
_ODD = struct.Struct(f"<BBH q {_SAMPLES}d")


def _monitor(folder: Path) -> Prepared:
    """Feed what the bytes describe between the blocks and joint states of an ordinary recording, and assess it."""
    recording = Recording(seconds=0.8)
    blocks = recording.blocks()
    settings = JointSettings.from_mapping(PAPER | {"analysis.period": 0.4, "analysis.harmonics": 1})

    def feed(data: bytes) -> None:
        monitor = Monitor(settings)
        odd: dict[int, list[tuple[Any, ...]]] = {}
        for at in range(0, len(data) - _ODD.size + 1, _ODD.size)[:8]:
            item = _ODD.unpack_from(data, at)
            odd.setdefault(item[0] % len(blocks), []).append(item)
        for number, block in enumerate(blocks):
            recording.feed_motion(monitor, slice(10 * number, 10 * number + 10))
            monitor.add_block(block)
            for _, kind, sequence, stamp, *values in odd.get(number, []):
                if kind % 2:
                    monitor.add(Quantity.MOTION, [stamp], *([value] for value in values[:3]))
                else:  # the period has passed the check of the decoder
                    period = min(max(abs(values[0]), 1e-6), 9.9) if values[0] == values[0] else 1e-3
                    monitor.add_block(Block(stamp, period, sequence, np.array(values[1:])))
            for assessment in monitor.advance():
                put_into_words(assessment)
        if (last := monitor.finish()) is not None:
            put_into_words(last)

    ordinary = [_ODD.pack(n, n, n, EPOCH + n * 10**8, 1e-3, 0.5, 10.0, 1.0, -1.0) for n in range(4)]
    wild = [_ODD.pack(n, n, n, EPOCH, np.inf, np.nan, 1e300, -1e300, 0.0) for n in range(4)]
    return Prepared(feed, [*ordinary, *wild, b"".join(ordinary)])


def _planted(folder: Path) -> Prepared:
    return Prepared(trusts_a_count, [struct.pack("<IIQ", 1, 8, 5)])


PLANTED = "planted fault"
READERS: dict[str, tuple[float, Callable[[Path], Prepared]]] = {
    PLANTED: (0.1, _planted),
    "messages": (2.0, messages),
    "mcap": (2.0, _storage(".mcap")),
    "mcap.zstd": (1.0, _storage(".mcap.zstd")),
    "sqlite": (1.0, _storage(".db3")),
    "sqlite rows": (1.0, _rows),
    "metadata": (0.5, _metadata),
    "parameters": (0.5, _parameters),
    "overrides": (1.0, _overrides),
    "results": (0.5, comparison),
    "monitor": (0.03, _monitor),
}
"""Name: share of the inputs, smaller for what is slow, and what prepares the reader in a folder."""

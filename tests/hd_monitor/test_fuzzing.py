"""Nothing that comes from outside ends in anything but an error of the project, in bounded time and memory.

Every run tries the same few thousand inputs. A million others, for an hour or so:

    python -m pytest tests/hd_monitor/test_fuzzing.py --hypothesis-profile=fuzz
"""

import json
import math
import sqlite3
import struct
from argparse import ArgumentParser
from collections.abc import Callable
from contextlib import closing, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import strategies as st
from tests.hd_monitor import fuzzing
from tests.hd_monitor.fuzzing import EndlessWork, damaged, survive
from tests.hd_monitor.monitored import EPOCH, Recording
from tests.hd_monitor.offline import mcap_files, recordings

from hd_monitor.adapters import Inputs
from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.cli import compare
from hd_monitor.contract import Block
from hd_monitor.diagnosis.status import status_of
from hd_monitor.monitor import Monitor
from hd_monitor.offline.bag import Bag
from hd_monitor.offline.parameters import load_parameters, parse_override
from hd_monitor.settings import JointSettings, set_aside_foreign, split_joints
from hd_monitor.sources import INPUT_SOURCES, LOAD_SOURCES, Quantity

ROOT = Path(__file__).resolve().parents[2]
START = recordings.START


def serialised(message: Any) -> bytes:
    return bytes(recordings.STORE.serialize_cdr(message, message.__msgtype__))


# Messages ----------------------------------------------------------------------------------------------------------

WHOLE = {
    "std_msgs/Float64MultiArray": recordings.block(START, 1e-3, 7, [0.5, -0.25, math.nan]),
    "geometry_msgs/AccelStamped": recordings.accel(START, 3.0),
    "geometry_msgs/WrenchStamped": recordings.wrench(START, 3.0),
    "sensor_msgs/Imu": recordings.imu(START, 3.0),
    "sensor_msgs/JointState": recordings.joint_state(START, joint=(0.1, 0.2, 0.3), other=(0.4, 0.5, 0.6)),
}
SOURCES: dict[str, dict[str, Any]] = {
    **{f"input.source: {word}": {"input.source": word, "input.sensor_radius": 0.5} for word in INPUT_SOURCES},
    **{f"load.source: {word}": {"load.source": word} for word, source in LOAD_SOURCES.items() if source},
}


class Counter:
    """Takes what the decoders yield and counts the messages it stands for."""

    def __init__(self) -> None:
        self.taken = 0

    def add(self, quantity: Quantity, stamps: IntArray, *columns: FloatArray) -> None:
        assert all(column.shape == stamps.shape for column in columns)
        self.taken += stamps.size

    def add_block(self, block: Block) -> None:
        assert block.samples.ndim == 1
        self.taken += 1

    def reject(self, reason: str) -> None:
        assert "\n" not in reason


@pytest.mark.parametrize("setting", SOURCES)
def test_damaged_messages(setting: str) -> None:
    """What is whole in a batch is taken, whatever stands beside it."""
    settings = JointSettings.from_mapping(SOURCES[setting])
    quantity = Quantity.TORQUE if setting.startswith("load") else next(iter(settings.sources))
    whole = serialised(WHOLE[settings.sources[quantity].type])

    def decode(messages: list[bytes]) -> None:
        counter = Counter()
        Inputs("joint", settings, counter).add(quantity, messages)
        assert counter.taken >= messages.count(whole)

    survive(decode, st.lists(st.just(whole) | damaged(whole), min_size=1, max_size=4), weight=4)


# Recordings --------------------------------------------------------------------------------------------------------


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


# Parameters and results --------------------------------------------------------------------------------------------


leaves = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
anything = st.recursive(
    leaves, lambda deeper: st.lists(deeper) | st.dictionaries(st.text(max_size=8), deeper), max_leaves=4
)


def _planted(content: Any, place: list[float], value: Any) -> Any:
    """Copy of JSON content with another value at a place that the numbers lead to."""
    if not place or not isinstance(content, (dict, list)) or not content:
        return value
    keys = list(content) if isinstance(content, dict) else range(len(content))
    chosen = keys[int(place[0] * len(keys))]
    copy: Any = content.copy()
    copy[chosen] = _planted(content[chosen], place[1:], value)
    return copy


places = st.lists(st.floats(0.0, 1.0, exclude_max=True), min_size=1, max_size=5)
SHIPPED = [file.read_bytes() for file in sorted((ROOT / "config").glob("*.yaml"))]
FILES = {
    "damaged": damaged(*SHIPPED),
    "of other values": st.builds(
        lambda whole, place, value: yaml.safe_dump(_planted(whole, place, value)).encode(),
        st.sampled_from([yaml.safe_load(content) for content in SHIPPED]),
        places,
        anything,
    ),
    "of other words": st.lists(
        st.sampled_from(
            ["ros__parameters: ", "joints: ", "joint: ", "/**: ", "\n", "  ", "a", "[", "]", "{", "}", "- ", "? "]
        )
        | st.sampled_from(["&a ", "*a", "<<: ", "!!set ", "!!binary ", "!!timestamp ", "!!int ", "!!python/none "])
        | st.text("0123456789:-.eE_ \t'\"#,%@`", max_size=6)
    ).map(lambda words: "".join(words).encode()),
}


@pytest.mark.parametrize("kind", FILES)
def test_parameter_files(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "parameters.yaml"

    def load(content: bytes) -> None:
        path.write_bytes(content)
        split_joints(set_aside_foreign(load_parameters(path))[0])

    survive(load, FILES[kind], weight=2)


def test_overrides() -> None:
    def override(text: str) -> None:
        split_joints(set_aside_foreign(dict([parse_override(text)]))[0])

    values = st.text(st.characters(codec="utf-8"), max_size=20) | st.text(
        "0123456789:-.eE[]{}&*!%\"'~ ,#\n", max_size=12
    )
    names = st.sampled_from(("joints", "reducer.mount", "load.torque", "input.axis", "diagnosis")) | st.text(max_size=8)
    survive(override, st.builds("{}:={}".format, names, values), weight=4)


def test_results_that_compare_reads(tmp_path: Path) -> None:
    whole = result_of_a_replay(tmp_path)
    before, after = tmp_path / "before.json", tmp_path / "after.json"
    before.write_text(json.dumps(whole), encoding="utf-8")
    parser = ArgumentParser()
    compare.configure(parser)
    arguments = parser.parse_args([str(before), str(after)])

    def compared(content: bytes) -> None:
        after.write_bytes(content)
        with redirect_stdout(StringIO()):
            compare.run(arguments)

    changed = st.builds(_planted, st.just(whole), places, anything).map(lambda content: json.dumps(content).encode())
    survive(compared, changed | damaged(json.dumps(whole).encode()), weight=2)


def result_of_a_replay(folder: Path) -> dict[str, Any]:
    from hd_monitor.offline.plan import Request
    from hd_monitor.offline.run import replay_bag

    events = recordings.simulated(programme="fixed", fixed__speed=1500.0, duration=6.0)
    return replay_bag(recordings.write(folder / "bag", events), Request()).content


# Blocks and joint states into a monitor ----------------------------------------------------------------------------

RECORDING = Recording(seconds=3.0)
treacherous = (
    st.sampled_from((0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, math.inf, -math.inf, math.nan)) | st.floats()
)
stamps = st.sampled_from((0, 1, EPOCH - 1, EPOCH, EPOCH + 10**9, EPOCH + 3 * 10**9)) | st.integers(0, 2**62)
odd_blocks = st.builds(
    Block,
    stamp=stamps,
    period=st.sampled_from((1e-3, 1e-4, 9.9)) | st.floats(1e-6, 10.0, exclude_max=True),
    sequence=st.integers(0, 40),
    samples=st.lists(treacherous, max_size=20).map(np.array),
)


def test_blocks_and_joint_states_into_a_monitor() -> None:
    """Some of an ordinary recording's blocks and joint states are odd: it is assessed all the same."""
    blocks = RECORDING.blocks()

    def run(odd: list[tuple[int, Block | tuple[int, float, float, float]]]) -> None:
        monitor = Monitor(JointSettings.from_mapping())
        chosen = dict(odd)
        for number, block in enumerate(blocks):
            RECORDING.feed_motion(monitor, slice(10 * number, 10 * number + 10))
            monitor.add_block(block)
            match chosen.get(number):
                case Block() as other:
                    monitor.add_block(other)
                case (stamp, *values):
                    monitor.add(Quantity.MOTION, [stamp], *([value] for value in values))
            for assessment in monitor.advance():
                status_of(assessment, "joint")
        last = monitor.finish()
        assert last is None or status_of(last, "joint").message

    joint = st.tuples(stamps, treacherous, treacherous, treacherous)
    survive(run, st.lists(st.tuples(st.integers(0, len(blocks) - 1), odd_blocks | joint), min_size=1, max_size=4))


# The check itself --------------------------------------------------------------------------------------------------


def _trusts_a_count(data: bytes) -> None:
    if len(data) >= 8:
        struct.unpack_from("<I", data, struct.unpack_from("<I", data, 4)[0])


def _allocates_a_count(data: bytes) -> None:
    if len(data) >= 8:
        np.ones(min(struct.unpack_from("<I", data, 4)[0], 2**26))


def _repeats_a_count(data: bytes) -> None:
    if len(data) >= 8:
        for _ in range(struct.unpack_from("<I", data, 4)[0]):
            pass


@pytest.mark.parametrize(
    ("reader", "error"),
    [(_trusts_a_count, struct.error), (_allocates_a_count, AssertionError), (_repeats_a_count, EndlessWork)],
)
def test_a_planted_fault_is_found(
    reader: Callable[[bytes], None], error: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fuzzing, "PROCESSOR_SECONDS", 0.2)
    monkeypatch.setattr(fuzzing, "MEMORY", 2**25)
    with pytest.raises(error):
        survive(reader, damaged(struct.pack("<IIQ", 1, 8, 5)), weight=4)

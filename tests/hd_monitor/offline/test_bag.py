"""Every form of a recording reads the same; a damaged one gives what is still whole, with a note."""

import random
import shutil
import sqlite3
from collections import Counter
from pathlib import Path

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.offline.bag import Bag
from hd_monitor.offline.batches import ROWS
from hd_monitor.offline.errors import BagError

BLOCKS, STATES = "/torsional_acceleration/block", "/joint_states"
BOTH = (BLOCKS, STATES)


def contents(path: Path) -> tuple[Counter[str], list[str]]:
    with Bag(path) as bag:
        counts = Counter(message.topic for message in bag.messages(BOTH))
        return counts, bag.notes


@pytest.mark.parametrize("storage", [rec.MCAP, rec.SQLITE])
@pytest.mark.parametrize("compression", [None, "file", "message", "storage"])
@pytest.mark.parametrize("form", ["folder", "file", "folder without metadata"])
def test_every_form_reads_the_same(tmp_path: Path, storage: object, compression: str | None, form: str) -> None:
    if compression == "storage" and storage is rec.SQLITE:
        pytest.skip("SQLite storage has no compression of its own")
    events = rec.small()
    path = rec.write(tmp_path / "bag", events, storage=storage, compression=compression)
    if form == "file":
        path = rec.storage_file(path)
    elif form == "folder without metadata":
        (path / "metadata.yaml").unlink()
    with Bag(path) as bag:
        types = {topic.name: topic.type for topic in bag.topics}
        messages = list(bag.messages(BOTH))
    assert types == {BLOCKS: "std_msgs/msg/Float64MultiArray", STATES: "sensor_msgs/msg/JointState"}
    expected = sorted((event.time, event.topic) for event in events)
    assert sorted((message.time, message.topic) for message in messages) == expected
    serialised = Counter(bytes(rec.STORE.serialize_cdr(e.message, e.message.__msgtype__)) for e in events)
    assert Counter(message.data for message in messages) == serialised


@pytest.mark.parametrize(("storage", "most"), [(rec.MCAP, 6000), (rec.SQLITE, ROWS)])  # MCAP: a chunk of 1 MiB
def test_windows_hold_every_message_once_and_stay_short(tmp_path: Path, storage: object, most: int) -> None:
    path = rec.write(tmp_path / "bag", rec.small(90.0), storage=storage)
    with Bag(path) as bag:
        windows = list(bag.windows(BOTH))
    assert sum(len(window.messages[STATES]) for window in windows) == 9000
    assert max(len(window.messages[STATES]) for window in windows) <= most
    assert [window.end for window in windows] == sorted(window.end for window in windows)


def test_a_pause_in_the_recording_ends_a_window(tmp_path: Path) -> None:
    events = rec.small(1.0)
    late = [rec.Event(e.time + 3_000_000_000, e.topic, e.message) for e in events]
    path = rec.write(tmp_path / "bag", events + late)
    with Bag(path) as bag:
        first, second = bag.windows(BOTH, pause=2_000_000_000)
    assert second.start - first.end > 2_000_000_000


@pytest.mark.parametrize("storage", [rec.MCAP, rec.SQLITE])
def test_a_file_cut_off_gives_what_precedes_the_cut(tmp_path: Path, storage: object) -> None:
    path = rec.write(tmp_path / "bag", rec.small(60.0), storage=storage)
    file = rec.storage_file(path)
    whole = file.read_bytes()
    for part in (0.95, 0.7):
        file.write_bytes(whole[: int(part * len(whole))])
        for form in (path, file):
            counts, notes = contents(form)
            assert 600 < counts[STATES] < 6000
            assert 60 < counts[BLOCKS] <= 600
            assert notes


@pytest.mark.parametrize("compression", [None, "storage"])
def test_a_chunk_overwritten_in_the_middle_costs_that_chunk_only(tmp_path: Path, compression: str | None) -> None:
    # Blocks of noise, so that compression leaves several chunks.
    noise = random.Random(1)
    events = rec.small(200.0)
    for number in range(2000):
        stamp = rec.START + number * 100_000_000 + 1
        message = rec.block(stamp, 1e-3, number, [noise.random() for _ in range(100)])
        events.append(rec.Event(stamp, "/other/torsional_acceleration/block", message))
    path = rec.write(tmp_path / "bag", events, compression=compression)
    file = rec.storage_file(path)
    raw = bytearray(file.read_bytes())
    middle = len(raw) // 2
    raw[middle : middle + 200_000] = b"\xff" * 200_000
    file.write_bytes(raw)
    counts, notes = contents(path)
    assert 5_000 < counts[STATES] < 20_000
    assert notes


def test_rows_in_a_write_ahead_log_are_read(tmp_path: Path) -> None:
    path = rec.write(tmp_path / "bag", rec.small(), storage=rec.SQLITE)
    file = rec.storage_file(path)
    writer = sqlite3.connect(file)
    writer.execute("PRAGMA journal_mode=WAL")
    (topic, data) = writer.execute("SELECT topic_id, data FROM messages LIMIT 1").fetchone()
    writer.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", (topic, rec.START, data))
    writer.commit()
    killed = tmp_path / "killed"
    shutil.copytree(path, killed)  # as the recorder's death would leave it: the log not merged
    writer.close()
    with Bag(killed) as bag:
        assert sum(topic.messages for topic in bag.topics) == 331
        assert any("not closed" in note for note in bag.notes)
        assert sum(1 for _ in bag.messages(BOTH)) == 331


def test_a_folder_of_several_files_is_read_in_their_order(tmp_path: Path) -> None:
    folder = tmp_path / "splits"
    folder.mkdir()
    events = sorted(rec.small(12.0), key=lambda event: event.time)
    for number in range(12):
        part = rec.write(tmp_path / f"part_{number}", events[number * 110 : number * 110 + 110])
        shutil.copy(rec.storage_file(part), folder / f"splits_{number}.mcap")
    with Bag(folder) as bag:
        times = [message.time for message in bag.messages(BOTH)]
    assert len(times) == 1320
    assert times == sorted(times)


def test_a_damaged_file_of_a_folder_does_not_affect_the_others(tmp_path: Path) -> None:
    folder = tmp_path / "splits"
    folder.mkdir()
    events = sorted(rec.small(9.0), key=lambda event: event.time)
    for number in range(3):
        part = rec.write(tmp_path / f"part_{number}", events[number * 330 : number * 330 + 330])
        shutil.copy(rec.storage_file(part), folder / f"splits_{number}.mcap")
    middle = folder / "splits_1.mcap"
    middle.write_bytes(middle.read_bytes()[:-40])
    names = [f"splits/splits_{number}.mcap" for number in range(4)]  # the last one is not there
    metadata = {"rosbag2_bagfile_information": {"relative_file_paths": names}}
    (folder / "metadata.yaml").write_text(yaml.safe_dump(metadata))
    counts, notes = contents(folder)
    assert counts == {STATES: 900, BLOCKS: 90}
    assert all(words in " ".join(notes) for words in ("splits_3.mcap missing", "splits_1.mcap is not whole"))
    assert not any("splits_0" in note or "splits_2" in note for note in notes)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda path: None, "does not exist"),
        (lambda path: path.mkdir(), "no .mcap or .db3 file"),
        (lambda path: path.write_text("hello"), "not a rosbag2 recording"),
    ],
)
def test_anything_but_a_recording_is_refused_in_one_line(tmp_path: Path, make: object, words: str) -> None:
    path = tmp_path / "thing"
    make(path)  # type: ignore[operator]
    with pytest.raises(BagError, match=words) as caught:
        Bag(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["a.mcap", "a.db3", "a.mcap.zstd", "a.db3.zstd"])
@pytest.mark.parametrize("content", [b"", b"hello, I am no bag", bytes(5000)])
def test_a_file_that_only_has_the_name_of_a_recording_is_refused(tmp_path: Path, name: str, content: bytes) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(BagError) as caught:
        Bag(file)
    assert "\n" not in str(caught.value)


def test_a_bag_without_messages_is_refused(tmp_path: Path) -> None:
    path = rec.write(tmp_path / "bag", [], silent=[(STATES, "sensor_msgs/msg/JointState")])
    with pytest.raises(BagError, match="holds no messages"):
        Bag(path)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("written")
    for name, storage in (("a.mcap", rec.MCAP), ("a.db3", rec.SQLITE)):
        bag = rec.write(folder / f"{name}_bag", rec.small(), storage=storage)
        shutil.copy(rec.storage_file(bag), folder / name)
    return folder


@settings(max_examples=60)
@given(name=st.sampled_from(["a.mcap", "a.db3"]), seed=st.integers(0, 2**32), hits=st.integers(1, 40))
def test_damage_anywhere_never_ends_in_anything_but_a_bag_error(
    tmp_path_factory: pytest.TempPathFactory, written: Path, name: str, seed: int, hits: int
) -> None:
    dice = random.Random(seed)
    raw = bytearray((written / name).read_bytes())
    for _ in range(hits):
        raw[dice.randrange(len(raw))] = dice.randrange(256)
    if dice.random() < 0.5:
        del raw[dice.randrange(len(raw)) :]
    file = tmp_path_factory.mktemp("damaged") / name
    file.write_bytes(raw)
    try:
        with Bag(file) as bag:
            for _ in bag.windows(BOTH):
                pass
    except BagError:
        pass

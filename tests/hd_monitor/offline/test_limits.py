"""Recordings made to do harm are refused or read in part, in bounded time and memory, and the notes name the cause."""

import sqlite3
import struct
import tempfile
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest
import yaml
from tests.hd_monitor.offline import mcap_files
from tests.hd_monitor.offline import recordings as rec
from tests.hd_monitor.offline.mcap_files import Sent

from hd_monitor.cli.main import main
from hd_monitor.offline.bag import Bag
from hd_monitor.offline.errors import BagError

MIB = 1 << 20
HELLO = Sent(1, 5, b"hello")


def read(path: Path, limit: int = 256 * MIB) -> tuple[list[bytes], str]:
    with Bag(path, limit) as bag:
        return [message.data for message in bag.messages(["/a"])], "; ".join(bag.notes)


@pytest.fixture
def at_most(request: pytest.FixtureRequest) -> Iterator[None]:
    """Fail where more memory than this was taken."""
    tracemalloc.start()
    yield
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < request.param


def inflated(path: Path, monkeypatch: pytest.MonkeyPatch, compression: str, tail: bytes, *, announced: bool) -> Path:
    """Write a chunk whose content goes on with `tail`, be that announced or not."""
    pack, record = mcap_files.PACK[compression], mcap_files.message_record
    if announced:
        monkeypatch.setattr(mcap_files, "message_record", lambda message: record(message) + tail)
    else:
        monkeypatch.setitem(mcap_files.PACK, compression, lambda content: pack(content + tail))
    return mcap_files.write(path, [[HELLO]], ["/a"], compression=compression, checksum=False)


@pytest.mark.parametrize("at_most", [4 * MIB], indirect=True)
@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_what_a_chunk_expands_to_beyond_its_announced_size_is_not_even_decompressed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, compression: str, at_most: None
) -> None:
    tail = bytes(64 * MIB)
    tracemalloc.stop()
    path = inflated(tmp_path / "a.mcap", monkeypatch, compression, tail, announced=False)
    tracemalloc.start()
    data, notes = read(path)
    assert data == [HELLO.data]
    assert "holds more than the" in notes


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_chunk_beyond_the_limit_is_left_out_and_the_others_are_read(tmp_path: Path, compression: str) -> None:
    chunks = [[HELLO], [Sent(1, 7, bytes(2 * MIB))], [Sent(1, 9, b"bye")]]
    path = mcap_files.write(tmp_path / "a.mcap", chunks, ["/a"], compression=compression)
    data, notes = read(path, MIB)
    assert data == [b"hello", b"bye"]
    assert notes.startswith("a.mcap: a chunk was left out (")
    assert "--chunk-limit permits 1048576" in notes
    assert "of 3 messages announced on /a, 2 were found" in notes
    path.write_bytes(path.read_bytes()[:-8])  # without its end, it is walked through
    data, notes = read(path, MIB)
    assert data == [b"hello", b"bye"]
    assert "--chunk-limit permits 1048576" in notes


def test_a_chunk_of_zeros_ends_where_the_records_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = inflated(tmp_path / "a.mcap", monkeypatch, "zstd", bytes(32 * MIB), announced=True)
    data, notes = read(path)
    assert data == [HELLO.data]
    assert "do not fill it" in notes


@pytest.mark.parametrize("record", [mcap_files.message_record(HELLO._replace(data=b"")), struct.pack("<BQ", 0x80, 0)])
def test_a_chunk_of_a_million_records_is_read_in_parts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, record: bytes
) -> None:
    path = inflated(tmp_path / "a.mcap", monkeypatch, "zstd", record * (8 * MIB // len(record)), announced=True)
    with Bag(path) as bag:
        assert max(len(window.messages["/a"]) for window in bag.windows(["/a"])) <= 1 << 16
        assert not bag.notes


def test_chunks_that_all_overlap_are_not_held_together_beyond_the_limit(tmp_path: Path) -> None:
    chunks = [[Sent(1, number, bytes(MIB)), Sent(1, 100, bytes([number]))] for number in range(6)]
    path = mcap_files.write(tmp_path / "a.mcap", chunks, ["/a"], compression="zstd")
    data, notes = read(path, 2 * MIB)
    assert sorted(data) == sorted(message.data for chunk in chunks for message in chunk)
    assert "overlap in time" in notes


@pytest.mark.parametrize("name", ["a.mcap.zstd", "a.db3.zstd"])
@pytest.mark.parametrize("make", [bytes, lambda size: b"no recording" * (size // 12)])
def test_a_compressed_file_is_named_as_the_user_knows_it(
    tmp_path: Path, name: str, make: Callable[[int], bytes]
) -> None:
    path = tmp_path / name
    path.write_bytes(mcap_files.zstd.compress(make(4 * MIB)))
    with pytest.raises(BagError, match="does not begin as") as caught:
        Bag(path)
    assert str(caught.value).startswith(f"{path} ")


@pytest.mark.parametrize("storage", [rec.MCAP, rec.SQLITE])
def test_notes_on_a_compressed_file_name_what_the_user_has(tmp_path: Path, storage: object) -> None:
    plain = rec.storage_file(rec.write(tmp_path / "bag", rec.small(60.0), storage=storage)).read_bytes()
    path = tmp_path / f"cut.{'mcap' if storage is rec.MCAP else 'db3'}.zst"
    path.write_bytes(mcap_files.zstd.compress(plain[: len(plain) * 4 // 5]))
    with Bag(path) as bag:
        assert sum(1 for _ in bag.messages(["/joint_states"])) > 1000
    assert bag.notes
    assert all(path.name in note and tempfile.gettempdir() not in note for note in bag.notes)


def test_a_file_that_finds_no_room_says_where(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.mcap.zstd"
    path.write_bytes(mcap_files.zstd.compress(bytes(MIB)))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "not there"))
    with pytest.raises(BagError, match=r"a\.mcap\.zstd cannot be decompressed into .*TMPDIR"):
        Bag(path)


def test_a_file_cut_off_whose_copy_finds_no_room_says_where(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = rec.storage_file(rec.write(tmp_path / "bag", rec.small(0.2), storage=rec.SQLITE))
    content = bytearray(path.read_bytes())
    struct.pack_into(">H", content, 16, 1)  # stands for pages of 65536 bytes
    struct.pack_into(">I", content, 28, 2**32 - 1)
    path.write_bytes(content)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "not there"))
    with pytest.raises(BagError, match=r"is cut off, and a copy of the 2\.815e\+08 MB .* cannot be made in .*TMPDIR"):
        Bag(path)


MESSAGES = {
    "a view": "CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) "
    "SELECT x AS id, 1 AS topic_id, x AS timestamp, x'00' AS data FROM c",
    "huge values": "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
    "data BLOB AS (zeroblob(1000000000)))",
}


def database(path: Path, messages: str) -> Path:
    with closing(sqlite3.connect(path)) as writer:
        writer.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
        writer.execute("INSERT INTO topics VALUES (1, '/a', 'std_msgs/msg/String')")
        writer.execute(messages)
        if "TABLE" in messages:
            writer.execute("INSERT INTO messages (topic_id, timestamp) VALUES (1, 1)")
        writer.commit()
    return path


def test_a_view_that_never_ends_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BagError, match="computes its messages instead of storing them"):
        Bag(database(tmp_path / "a.db3", MESSAGES["a view"]))


def test_values_larger_than_their_file_are_not_made(tmp_path: Path) -> None:
    data, notes = read(database(tmp_path / "a.db3", MESSAGES["huge values"]))
    assert not data
    assert "too big" in notes


def test_a_tree_whose_branches_all_lead_to_the_same_rows_is_given_up(tmp_path: Path) -> None:
    path = rec.storage_file(rec.write(tmp_path / "bag", rec.small(12.0), storage=rec.SQLITE))
    with closing(sqlite3.connect(path)) as writer:
        (page,) = writer.execute("PRAGMA page_size").fetchone()
        (root,) = writer.execute("SELECT rootpage FROM sqlite_master WHERE name = 'messages'").fetchone()
    raw = bytearray(path.read_bytes())
    start = (root - 1) * page
    assert raw[start] == 5  # an interior page: pointers to its children, each with a key
    (cells,) = struct.unpack_from(">H", raw, start + 3)
    (leaf,) = struct.unpack_from(">I", raw, start + struct.unpack_from(">H", raw, start + 12)[0])
    middle = len(raw) // page + 1
    for level in range(2):  # two more levels: the first page's children are copies of it
        copy = bytearray(raw[start : start + page])
        for cell in range(cells):
            at = struct.unpack_from(">H", copy, 12 + 2 * cell)[0]
            struct.pack_into(">I", copy, at, leaf if level == 0 else middle)
        struct.pack_into(">I", copy, 8, leaf if level == 0 else middle)
        raw += copy
    for cell in range(cells):
        struct.pack_into(">I", raw, start + struct.unpack_from(">H", raw, start + 12 + 2 * cell)[0], middle + 1)
    struct.pack_into(">I", raw, start + 8, middle + 1)
    struct.pack_into(">I", raw, 28, len(raw) // page)
    path.write_bytes(raw)
    with Bag(path) as bag:
        assert sum(1 for _ in bag.messages(["/joint_states"])) < len(raw)
    assert "more rows than it has room for" in "; ".join(bag.notes)


@pytest.mark.parametrize(
    "name", ["..", "../../out.mcap", "/etc/passwd", "../bag/../out.mcap", ".", "", "metadata.yaml"]
)
def test_names_in_the_metadata_never_lead_out_of_the_folder(tmp_path: Path, name: str) -> None:
    mcap_files.write(tmp_path / "out.mcap", [[HELLO._replace(data=b"secret")]], ["/a"])
    folder = tmp_path / "bag"
    folder.mkdir()
    mcap_files.write(folder / "in.mcap", [[HELLO]], ["/a"])
    information = {"rosbag2_bagfile_information": {"relative_file_paths": [name, "in.mcap"]}}
    (folder / "metadata.yaml").write_text(yaml.safe_dump(information))
    data, notes = read(folder)
    assert data == [HELLO.data]
    assert "missing" in notes


def test_metadata_of_any_size_is_not_parsed(tmp_path: Path) -> None:
    mcap_files.write(tmp_path / "in.mcap", [[HELLO]], ["/a"])
    (tmp_path / "metadata.yaml").write_text("[" * 2_000_000)
    data, notes = read(tmp_path)
    assert data == [HELLO.data]
    assert "metadata.yaml cannot be read (it is larger than 1000000 bytes)" in notes


def test_messages_that_are_announced_but_not_there_are_noted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    statistics = mcap_files._statistics
    monkeypatch.setattr(mcap_files, "_statistics", lambda messages, *counts: statistics([*messages, HELLO], *counts))
    data, notes = read(mcap_files.write(tmp_path / "a.mcap", [[HELLO]], ["/a"]))
    assert data == [HELLO.data]
    assert notes == "a.mcap: of 2 messages announced on /a, 1 were found"


def test_a_channel_in_another_serialisation_is_named_with_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    string = mcap_files._string
    monkeypatch.setattr(mcap_files, "_string", lambda text: string("json" if text == "cdr" else text))
    path = mcap_files.write(tmp_path / "a.mcap", [[HELLO._replace(data=b"{}")]], ["/a"])
    for _ in range(2):
        with Bag(path) as bag:
            assert [topic.type for topic in bag.topics] == [f"{mcap_files.TYPE} in json"]
        path.write_bytes(path.read_bytes()[:-8])


@pytest.mark.parametrize("text", ["0", "-1", "1.5", "much"])
def test_a_limit_that_is_no_size_is_refused(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["replay", "bag", f"--chunk-limit={text}"])
    assert "whole number of MiB" in capsys.readouterr().err

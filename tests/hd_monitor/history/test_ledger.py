import json
import os
import resource
import signal
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from tests.hd_monitor.history.entries import direction, entry

from hd_monitor.history.entry import Kind
from hd_monitor.history.ledger import _SCHEMA, VERSION, Ledger, LedgerError

ROOT = Path(__file__).resolve().parents[3]

WRITER = """
import sys
from pathlib import Path
from hd_monitor.history.ledger import Ledger, LedgerError
from tests.hd_monitor.history.entries import entry
ledger, number = Ledger(Path(sys.argv[1])), int(sys.argv[2])
print("open", flush=True)
while True:
    try:
        ledger.append(entry(time=float(number)))
    except LedgerError as error:
        print(error, flush=True)
        break
    print(number, flush=True)
    number += 1
"""


@pytest.fixture
def path(tmp_path):
    return tmp_path / "ledger.sqlite"


def writer(path, first=0, **options):
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([*filter(None, sys.path), str(ROOT)])}
    return subprocess.Popen(
        [sys.executable, "-c", WRITER, str(path), str(first)],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        **options,
    )


# What is written is read ----------------------------------------------------------------------------------------------


def test_an_entry_is_read_as_it_was_written(path):
    written = entry(evidence=(direction(), direction("reverse")), recording="bag", torque=3.5, relative=True)
    with Ledger(path) as ledger:
        ledger.append(written)
    with Ledger(path) as ledger:
        (read,) = ledger.entries("S1")
    assert repr(read) == repr(written)  # NaN of the temperature included
    assert read.evidence == written.evidence


def test_reducers_are_kept_apart_by_serial_number_and_without_one_by_joint(path):
    with Ledger(path) as ledger:
        for serial, joint in (("S1", "arm"), ("S1", "wrist"), ("S2", "arm"), ("", "arm"), ("", "wrist")):
            ledger.append(entry(serial=serial, joint=joint))
        assert [str(reducer) for reducer in ledger.reducers()] == [
            "joint arm (no serial number)",
            "joint wrist (no serial number)",
            "S1",
            "S2",
        ]
        assert [found.joint for found in ledger.entries("S1")] == ["arm", "wrist"]
        assert [found.joint for found in ledger.entries("", "wrist")] == ["wrist"]
        assert ledger.entries("S3") == []
        assert ledger.latest("S3") is None


def test_entries_come_by_time_and_the_newest_can_be_had_alone(path):
    with Ledger(path) as ledger:
        for time in (3.0, 1.0, 2.0):
            ledger.append(entry(time=time))
        assert [found.time for found in ledger.entries("S1")] == [1.0, 2.0, 3.0]
        assert [found.time for found in ledger.entries("S1", newest=2)] == [2.0, 3.0]
        assert ledger.latest("S1") == ledger.entries("S1")[-1]


def test_an_exchange_hides_what_was_before(path):
    with Ledger(path) as ledger:
        ledger.append(entry(time=1.0))
        ledger.mark("S1", "arm", Kind.EXCHANGE)
        assert ledger.entries("S1") == []
        ledger.append(entry(time=1.0))  # of the new one, within the same second
        ledger.append(entry(time=0.5, recording="an old bag"))
        ledger.append(entry(time=2.0))
        assert [found.time for found in ledger.entries("S1")] == [1.0, 2.0]


def test_a_recording_replayed_again_takes_the_place_of_its_entry(path):
    with Ledger(path) as ledger:
        for index in (0.06, 0.07):
            ledger.append(entry(index=(0.02, index), recording="bag"))
        (found,) = ledger.entries("S1")
    assert found.index == (0.02, 0.07)


def test_entries_of_a_later_version_with_more_in_them_are_read(path):
    with Ledger(path) as ledger:
        ledger.append(entry())
    with sqlite3.connect(path) as file:
        file.execute("""UPDATE entries SET content = json_set(content, '$.humidity', 0.4)""")
    file.close()
    with Ledger(path) as ledger:
        assert repr(ledger.latest("S1")) == repr(entry())


# What cannot be used --------------------------------------------------------------------------------------------------


def test_a_newer_schema_is_refused(path):
    Ledger(path).close()
    with sqlite3.connect(path) as file:
        file.execute("PRAGMA user_version = 99")
    file.close()
    with pytest.raises(LedgerError, match=r"newer hd_monitor \(tables of version 99"):
        Ledger(path)


@pytest.mark.parametrize("version", [1, 2])
def test_an_older_schema_is_brought_up_to_date(path, version):
    content = json.dumps(entry().content())
    rows = [
        ("evidence", 1, 1.0),
        ("evidence", 2, 1.0),
        ("exchange", 1, 1.0),
        ("evidence", 1, 1.0),
        ("evidence", 2, 2.0),
    ]
    with closing(sqlite3.connect(path)) as file, file:
        file.executescript("".join(_SCHEMA[:version]) + f"PRAGMA user_version = {version};")
        file.execute("INSERT INTO reducers VALUES (1, 'S1', ''), (2, 'S2', '')")
        file.executemany(
            "INSERT INTO entries (kind, reducer, time, joint, recording, content) VALUES (?, ?, ?, 'arm', '', ?)",
            [(*row, content) for row in rows],
        )
    with Ledger(path) as ledger:
        assert ledger._file.execute("PRAGMA user_version").fetchone() == (VERSION,)
        assert len(ledger.entries("S1")) == 1  # of the new one: the order within a second is kept
        assert [found.time for found in ledger.entries("S2")] == [1.0, 2.0]
        indexes = ledger._file.execute("SELECT name FROM sqlite_master WHERE type = 'index' AND tbl_name = 'entries'")
        assert {name for (name,) in indexes} == {"by_time", "one_of_a_recording", "exchanges"}
        ledger.append(entry(time=1.0))
        assert len(ledger.entries("S1")) == 2


def test_the_entries_of_a_reducer_lie_together(path):
    with Ledger(path) as ledger:
        for turn in range(40):
            for serial in ("S1", "S2", "S3"):
                ledger.append(entry(serial=serial, time=float(turn)))
        rows = ledger._file.execute("SELECT reducer FROM entries ORDER BY rowid").fetchall()
    assert rows == sorted(rows)


def test_other_files_are_refused_and_left_as_they_are(path, tmp_path):
    path.write_text("no database, but a text that is longer than its header" * 9, encoding="utf-8")
    before = path.read_bytes()
    with pytest.raises(LedgerError, match="cannot be opened: file is not a database"):
        Ledger(path)
    assert path.read_bytes() == before
    other = tmp_path / "other.sqlite"
    with sqlite3.connect(other) as file:
        file.execute("CREATE TABLE topics (id)")
    file.close()
    with pytest.raises(LedgerError, match="a database of something else"):
        Ledger(other)


def test_a_missing_ledger_is_named_where_it_is_only_read(path):
    with pytest.raises(LedgerError, match=r"does not exist; give the file of history\.path"):
        Ledger(path, read_only=True)
    assert not path.exists()


def test_a_ledger_on_a_disk_that_cannot_be_written_is_read(path, monkeypatch):
    with Ledger(path) as ledger:
        ledger.append(entry())
    monkeypatch.setattr(os, "access", lambda place, mode: False)
    with Ledger(path, read_only=True) as ledger:
        assert ledger.entries("S1") == [entry()]
        assert [file.name for file in path.parent.iterdir()] == [path.name]  # no log beside it
        with pytest.raises(LedgerError, match="readonly"):
            ledger.append(entry())


def test_a_place_where_no_ledger_can_be_says_why(tmp_path):
    with pytest.raises(LedgerError, match="cannot be opened: No such file or directory; choose another place"):
        Ledger(tmp_path / "missing" / "ledger.sqlite")


def test_a_spoilt_entry_is_named(path):
    with Ledger(path) as ledger:
        ledger.append(entry())
        ledger._file.execute("UPDATE entries SET content = '{}'")
        with pytest.raises(LedgerError, match="an entry that cannot be read"):
            ledger.entries("S1")


# What it survives -----------------------------------------------------------------------------------------------------


def test_killed_at_any_moment_it_keeps_every_entry_that_was_written(path):
    first = 0
    for kills in range(12):
        with writer(path, first) as process:
            lines = [process.stdout.readline() for _ in range(2 + kills)]
            process.send_signal(signal.SIGKILL)
            lines += process.stdout.readlines()
        told = int([line for line in lines if line.endswith("\n")][-1])
        with Ledger(path) as ledger:
            found = [int(read.time) for read in ledger.entries("S1")]
            (intact,) = ledger._file.execute("PRAGMA integrity_check").fetchone()
        assert intact == "ok"
        assert found[: told + 1] == list(range(told + 1))
        assert len(found) <= told + 2  # written, but not yet told
        first = len(found)


def test_a_full_disk_costs_the_entry_and_nothing_else(path):
    def little_room():
        resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, 400_000))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    with writer(path, preexec_fn=little_room) as process:
        _, *numbers, complaint = process.stdout.read().splitlines()
    assert "cannot be written" in complaint
    assert "entries already there are kept" in complaint
    with Ledger(path) as ledger:
        assert [int(found.time) for found in ledger.entries("S1")] == list(map(int, numbers))
        ledger.append(entry(time=1e6))  # there is room again
        assert ledger.entries("S1")[-1].time == 1e6


def test_several_writers_share_the_file(path):
    Ledger(path).close()

    def write(serial):
        with Ledger(path) as ledger:
            for time in range(20):
                ledger.append(replace(entry(), serial=serial, time=float(time)))

    threads = [threading.Thread(target=write, args=(f"S{number}",)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with Ledger(path) as ledger:
        assert [len(ledger.entries(f"S{number}")) for number in range(4)] == [20] * 4

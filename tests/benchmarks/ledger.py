"""How fast does a large ledger answer?

    python tests/benchmarks/ledger.py [--joints 10000] [--entries 1000] [--ask 20] FILE

writes the entries of so many joints by turns, as they come in from running robots, unless the file is there already,
and prints how long the questions of a node take: the newest entry, those that it reads at its start, and all, for the
baseline; then that of `hd-monitor history`. Each is asked with nothing of the file in memory, in wall-clock time. An
entry takes 1.4 kB.
"""

import argparse
import json
import os
import random
import sqlite3
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from hd_monitor.history.entry import Entry
from hd_monitor.history.ledger import Ledger
from hd_monitor.history.rating import baseline_of
from hd_monitor.offline.history import read_histories
from hd_monitor.ros.memory import NEWEST

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.hd_monitor.history.entries import direction, entry

SECONDS = 300.0
"""From one entry of a joint to the next."""


def alike(**more: object) -> Entry:
    """Return an entry as joint states alone make it."""
    made: Entry = entry(relative=True, evidence=(direction(), direction("reverse")), seconds=SECONDS, **more)
    return made


def build(path: Path, joints: int, entries: int) -> None:
    """Write the file, in bulk: what it holds is what single entries would have left."""
    content = json.dumps(alike().content(), separators=(",", ":"))
    Ledger(path).close()
    file = sqlite3.connect(path)
    for pragma in ("synchronous = OFF", "journal_mode = OFF", "cache_size = -600000"):
        file.execute(f"PRAGMA {pragma}")
    serials = [(number + 1, f"S{number}", "") for number in range(joints)]
    file.executemany("INSERT INTO reducers (id, serial, joint) VALUES (?, ?, ?)", serials)

    def rows() -> Iterator[tuple[int, int, str, float, str, str, str]]:
        for turn in range(entries):
            for reducer in range(1, joints + 1):
                own = (reducer << 32) + turn + 1
                yield own, reducer, "arm", SECONDS * turn + reducer % 300, "evidence", "", content

    file.executemany(
        "INSERT INTO entries (id, reducer, joint, time, kind, recording, content) VALUES (?, ?, ?, ?, ?, ?, ?)", rows()
    )
    file.commit()
    file.close()


def milliseconds(question: Callable[[], object]) -> float:
    """Time a question takes [ms]."""
    start = time.perf_counter()
    question()
    return 1e3 * (time.perf_counter() - start)


def forget(path: Path) -> None:
    """Have the system drop what it holds of a file in memory."""
    file = os.open(path, os.O_RDONLY)
    os.fsync(file)
    os.posix_fadvise(file, 0, 0, os.POSIX_FADV_DONTNEED)
    os.close(file)


def main() -> None:
    """Print the times."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--joints", type=int, default=10_000)
    parser.add_argument("--entries", type=int, default=1000)
    parser.add_argument("--ask", type=int, default=20, help="joints asked for, at random")
    options = parser.parse_args()
    if not options.file.exists():
        took = milliseconds(lambda: build(options.file, options.joints, options.entries))
        print(f"{options.joints} joints x {options.entries} entries written in {took / 1e3:.0f} s")
    size = options.file.stat().st_size / 1e9
    asked = random.Random(1).sample(range(options.joints), options.ask)
    with Ledger(options.file) as ledger:
        questions: dict[str, Callable[[str], object]] = {
            "the newest entry": ledger.latest,
            f"the newest {NEWEST}": lambda serial: ledger.entries(serial, newest=NEWEST),
            "all, and their baseline": lambda serial: baseline_of(ledger.entries(serial)),
            "all that hd-monitor history says": lambda serial: read_histories(ledger, serial),
            "one more written": lambda serial: ledger.append(alike(serial=serial, time=1e9)),
        }
        for name, ask in questions.items():
            forget(options.file)
            times = sorted(milliseconds(partial(ask, f"S{number}")) for number in asked)
            print(f"{size:.1f} GB, {name}: median {statistics.median(times):.1f} ms, longest {times[-1]:.1f} ms")


if __name__ == "__main__":
    main()

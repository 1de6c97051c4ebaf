"""How much faster than real time recordings replay, and how their memory grows: ratios to the recording's length.

    python tests/benchmarks/replay_speed.py [--seconds 600]

Ratios are to CPU time, so that whatever else the machine does counts little; replay keeps one core busy. Each is the
best of at least three runs and eight seconds: a machine that shares its processor is seldom at its full speed.
"read" is what reading the file and decoding its messages alone would allow; "replay" is everything up to the verdict.
"bulk" is the time that a library takes to give all messages one by one (mcap for MCAP, rosbags for SQLite) over the
time that we take to give them in bulk, nothing decoded.
Wanted: blocks at least 1000 times, single samples at 1 kHz at least 100 times, memory flat in the recording's length.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from hd_monitor.process import set_up_process

set_up_process()  # as every command does, before numpy comes

from mcap.reader import make_reader
from rosbags.rosbag2 import Reader, StoragePlugin, Writer

from hd_monitor.adapters import Inputs
from hd_monitor.offline.bag import Bag
from hd_monitor.offline.plan import Request, plan
from hd_monitor.offline.replay import replay
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from tests.hd_monitor.offline import recordings as rec

MEASURE_MEMORY = """
import sys
from pathlib import Path
from hd_monitor.offline.run import replay_bag
from hd_monitor.offline.plan import Request
replay_bag(Path(sys.argv[1]), Request())
lines = Path("/proc/self/status").read_text().splitlines()
print(next(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024)
"""


class Nowhere:
    """A sink that drops everything."""

    def add(self, quantity: Any, stamps: Any, *columns: Any) -> None: ...

    def add_block(self, block: Any) -> None: ...

    def reject(self, reason: str) -> None: ...


def messages(seconds: float, publish: str) -> Iterator[rec.Event]:
    """Yield what a rig sends that goes through all speeds again and again."""
    settings = RigSettings.from_mapping(
        {"programme": "dwell", "duration": seconds, "publish": publish, "defect": "flexspline", "block_size": 100}
    )
    for stretch in Simulation(settings):
        yield from rec.events_of(stretch)


def record(path: Path, seconds: float, publish: str, storage: StoragePlugin) -> Path:
    """Write a recording without holding it in memory."""
    with Writer(path, version=9, storage_plugin=storage) as writer:
        connections: dict[str, Any] = {}
        for event in messages(seconds, publish):
            kind = event.message.__msgtype__
            if event.topic not in connections:
                connections[event.topic] = writer.add_connection(event.topic, kind, typestore=rec.STORE)
            writer.write(connections[event.topic], event.time, rec.STORE.serialize_cdr(event.message, kind))
    return path


def time_reading(path: Path) -> float:
    """CPU seconds that reading and decoding take."""
    start = time.process_time()
    with Bag(path) as bag:
        (item,) = plan(bag, Request())
        inputs = Inputs(item.joint, item.settings, Nowhere())
        for window in bag.windows(item.topics.values()):
            for quantity, topic in item.topics.items():
                inputs.add(quantity, window.messages.get(topic, []))
    return time.process_time() - start


def time_bulk(path: Path) -> float:
    """CPU seconds that giving all messages in bulk takes."""
    start = time.process_time()
    with Bag(path) as bag:
        for _ in bag.windows([topic.name for topic in bag.topics]):
            pass
    return time.process_time() - start


def time_library(path: Path) -> float:
    """CPU seconds that a library takes to give all messages one by one."""
    start = time.process_time()
    storage = rec.storage_file(path)
    if storage.suffix == ".mcap":
        with storage.open("rb") as file:
            for _ in make_reader(file).iter_messages():
                pass
    else:
        with Reader(path) as reader:
            for _ in reader.messages():
                pass
    return time.process_time() - start


def time_replay(path: Path) -> float:
    """CPU seconds that the replay takes up to the verdict."""
    start = time.process_time()
    with Bag(path) as bag:
        for _ in replay(bag, plan(bag, Request())):
            pass
    return time.process_time() - start


def best_of(run: Callable[[Path], float], path: Path) -> float:
    """Least CPU seconds that a run takes."""
    taken: list[float] = []
    while len(taken) < 3 or sum(taken) < 8.0:
        taken.append(run(path))
    return min(taken)


def memory(path: Path) -> float:
    """Largest size [MiB] of a process that replays."""
    done = subprocess.run([sys.executable, "-c", MEASURE_MEMORY, str(path)], capture_output=True, text=True, check=True)
    return float(done.stdout)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=600.0, help="length of the recordings [s]")
    seconds = parser.parse_args().seconds
    print(f"{'recording':34}{'read':>12}{'replay':>12}{'wanted':>12}{'bulk':>10}")
    with tempfile.TemporaryDirectory() as folder:
        for publish, wanted in (("block", 1000), ("samples", 100)):
            for storage in (StoragePlugin.MCAP, StoragePlugin.SQLITE3):
                name = f"{publish} at 1 kHz, {storage.name.lower()}, {seconds:.0f} s"
                path = record(Path(folder) / f"{publish}_{storage.name}", seconds, publish, storage)
                read, whole = best_of(time_reading, path), best_of(time_replay, path)
                bulk = best_of(time_library, path) / best_of(time_bulk, path)
                ratios = f"{seconds / read:>10.0f} ×{seconds / whole:>10.0f} ×{wanted:>10} ×{bulk:>8.1f} ×"
                print(f"{name:34}{ratios}", flush=True)
        # From 150 s on: a monitor's evidence reaches back two minutes and fills up first.
        grown = []
        for length in (150.0, 600.0):
            path = record(Path(folder) / f"memory_{length:.0f}", length, "block", StoragePlugin.MCAP)
            grown.append(memory(path))
            print(f"memory for {length:.0f} s of blocks: {grown[-1]:.0f} MiB, the interpreter's included")
        print(f"four times the length takes {grown[1] / grown[0]:.2f} times the memory")


if __name__ == "__main__":
    main()

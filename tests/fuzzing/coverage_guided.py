"""A million hostile inputs, guided by the branches that they reach, with a row for each reader.

    pip install atheris
    python tests/fuzzing/coverage_guided.py                          all readers, a million inputs in all
    python tests/fuzzing/coverage_guided.py mcap --inputs 50000      one of them

Options that are not listed are libFuzzer's, as -max_total_time=3600. An input that some reader does not survive is
written into the working directory, its traceback is printed, and the exit status is 1. The first row is a fault that is
planted, which must be found.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

with atheris.instrument_imports(include=["hd_monitor", "tests.fuzzing"]):
    from tests.fuzzing.readers import PLANTED, READERS
    from tests.fuzzing.survival import MEMORY, bounded

from hd_monitor.errors import HdMonitorError

_ONE = "--one"
_COUNTS = {"inputs": "number_of_executed_units", "memory": "peak_rss_mb"}


def fuzz(name: str, options: Sequence[str]) -> None:
    """Fuzz a reader with libFuzzer's options; ends the process."""
    with tempfile.TemporaryDirectory(prefix="hd-monitor-fuzzing-") as folder:
        corpus = Path(folder) / "corpus"
        corpus.mkdir()
        prepared = READERS[name][1](Path(folder))
        for number, seed in enumerate(prepared.seeds):
            (corpus / str(number)).write_bytes(seed)

        def survive(data: bytes) -> None:
            with bounded(), suppress(HdMonitorError):
                prepared.read(data)

        atheris.Setup([name, *options, str(corpus)], survive)
        atheris.Fuzz()


def row(name: str, inputs: int, options: Sequence[str]) -> tuple[str, bool]:
    """Fuzz a reader in a process of its own; return its row of the table, and whether it did as it should."""
    begun = time.monotonic()
    words = [f"-runs={inputs}", "-len_control=0", "-print_final_stats=1", "-rss_limit_mb=2048", *options]
    done = subprocess.run([sys.executable, __file__, _ONE, name, *words], capture_output=True, check=False)
    said = done.stderr.decode(errors="replace") + done.stdout.decode(errors="replace")
    found = {key: re.search(rf"stat::{word}: +(\d+)", said) for key, word in _COUNTS.items()}
    counts = {key: int(match[1]) if match else 0 for key, match in found.items()}
    right = bool(done.returncode) == (name == PLANTED)
    if not right:
        print(said[-8000:], file=sys.stderr)
    ends = "found" if done.returncode else "survived"
    spent = time.monotonic() - begun
    return f"| {name} | {counts['inputs']} | {spent:.0f} s | {counts['memory']} MB | {ends} |", right


def main() -> int:
    """Fuzz the readers named, or all of them; return the exit status."""
    if sys.argv[1:2] == [_ONE]:
        fuzz(sys.argv[2], sys.argv[3:])
        return 0
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("readers", nargs="*", choices=[*READERS, []], help="all of them if none is given")
    parser.add_argument("--inputs", type=int, default=1_000_000, help="in all, shared among the readers")
    arguments, options = parser.parse_known_args()
    chosen = arguments.readers or list(READERS)
    whole = sum(READERS[name][0] for name in chosen)
    print(f"| reader | inputs | time | memory at its peak, {MEMORY >> 20} MiB an input | faults |", flush=True)
    print("|---|---|---|---|---|", flush=True)
    failed = False
    for name in chosen:
        text, right = row(name, round(arguments.inputs * READERS[name][0] / whole), options)
        print(text, flush=True)
        failed |= not right
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())

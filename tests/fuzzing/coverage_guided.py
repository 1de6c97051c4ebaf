"""A fuzzer that is guided by the branches which inputs reach: for a night, or until a new branch is rare.

    pip install atheris
    python tests/fuzzing/coverage_guided.py mcap -max_total_time=3600 corpus/

The first argument is what is read; the others are libFuzzer's. An input that survives extends the corpus; one that
does not is written beside it, and ends the run with its traceback.
"""

import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

with atheris.instrument_imports(include=["hd_monitor"]):
    from hd_monitor.adapters import Inputs
    from hd_monitor.errors import HdMonitorError
    from hd_monitor.monitor import Monitor
    from hd_monitor.offline.bag import Bag
    from hd_monitor.offline.parameters import load_parameters
    from hd_monitor.settings import JointSettings, set_aside_foreign, split_joints
    from hd_monitor.sources import INPUT_SOURCES

from tests.fuzzing.survival import bounded

FOLDER = Path(tempfile.mkdtemp(prefix="hd-monitor-fuzzing-"))


def _message(data: bytes) -> None:
    for word in INPUT_SOURCES:
        settings = JointSettings.from_mapping({"input.source": word, "input.sensor_radius": 0.5})
        for quantity in settings.sources:
            Inputs("joint", settings, Monitor(settings)).add(quantity, [data])


def _recording(suffix: str) -> Callable[[bytes], None]:
    def read(data: bytes) -> None:
        path = FOLDER / f"recording{suffix}"
        path.write_bytes(data)
        with Bag(path) as bag:
            for _ in bag.messages([topic.name for topic in bag.topics]):
                pass

    return read


def _parameters(data: bytes) -> None:
    path = FOLDER / "parameters.yaml"
    path.write_bytes(data)
    split_joints(set_aside_foreign(load_parameters(path))[0])


READERS: dict[str, Callable[[bytes], None]] = {
    "message": _message,
    "mcap": _recording(".mcap"),
    "sqlite": _recording(".db3"),
    "parameters": _parameters,
}


def main() -> None:
    """Fuzz the reader that the first argument names."""
    if len(sys.argv) < 2 or sys.argv[1] not in READERS:
        raise SystemExit(f"what to read, one of {', '.join(READERS)}, is missing; {__doc__}")
    read = READERS[sys.argv.pop(1)]

    def survive(data: bytes) -> None:
        with bounded(), suppress(HdMonitorError):
            read(data)

    atheris.Setup(sys.argv, survive)
    atheris.Fuzz()


if __name__ == "__main__":
    main()

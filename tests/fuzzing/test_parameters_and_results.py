"""Files of parameters and results of any content are read, or refused."""

import json
from argparse import ArgumentParser
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import strategies as st
from tests.fuzzing.survival import damaged, survive
from tests.hd_monitor.offline import recordings

from hd_monitor.cli import compare
from hd_monitor.offline.parameters import load_parameters, parse_override
from hd_monitor.offline.plan import Request
from hd_monitor.offline.run import replay_bag
from hd_monitor.settings import set_aside_foreign, split_joints

ROOT = Path(__file__).resolve().parents[2]


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
    events = recordings.simulated(programme="fixed", fixed__speed=1500.0, duration=6.0)
    return replay_bag(recordings.write(folder / "bag", events), Request()).content

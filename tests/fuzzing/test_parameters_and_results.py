"""Files of parameters and results of any content are read, or refused."""

import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import strategies as st
from tests.fuzzing.readers import CONFIG, comparison, load, override
from tests.fuzzing.survival import damaged, survive

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
SHIPPED = [file.read_bytes() for file in sorted(CONFIG.glob("*.yaml"))]
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

    def write_and_load(content: bytes) -> None:
        path.write_bytes(content)
        load(path)

    survive(write_and_load, FILES[kind], weight=2)


def test_overrides() -> None:
    values = st.text(st.characters(codec="utf-8"), max_size=20) | st.text(
        "0123456789:-.eE[]{}&*!%\"'~ ,#\n", max_size=12
    )
    names = st.sampled_from(("joints", "reducer.mount", "load.torque", "input.axis", "diagnosis")) | st.text(max_size=8)
    survive(override, st.builds("{}:={}".format, names, values), weight=4)


def test_results_that_compare_reads(tmp_path: Path) -> None:
    read, (whole,) = comparison(tmp_path)
    changed = st.builds(_planted, st.just(json.loads(whole)), places, anything).map(
        lambda content: json.dumps(content).encode()
    )
    survive(read, changed | damaged(whole), weight=2)

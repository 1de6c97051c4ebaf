"""The page on result files has every key that the commands write, and its example is what they write."""

import json
import re
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from hd_monitor.cli.main import main
from hd_monitor.identification.checks.something_else import SomethingElse
from hd_monitor.identification.sensorless.torque_share import TorqueShare
from hd_monitor.offline import comparison

pytest.importorskip("rosbags")
from hd_sim_node import bag_command

PAGE = (Path(__file__).resolve().parents[2] / "msgs_doc" / "results.md").read_text(encoding="utf-8")


def keys_below(heading: str) -> list[str]:
    """Keys of the first table below a heading, in their order."""
    table = re.search(
        rf"^#+ {re.escape(heading)}\n[^#]*?^\| key \| value \|\n\|---\|---\|\n(.*?)\n\n", PAGE + "\n", re.M | re.S
    )
    assert table is not None, heading
    return [key for row in table[1].splitlines() for key in re.findall(r"`([^`]+)`", row.split("|")[1])]


def commands() -> list[list[str]]:
    block = PAGE.partition("### Example")[2].split("```")[1]
    return [line.split() for line in block.strip().splitlines()]


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Run the page's own commands and return what they write."""
    simulate, replay = commands()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("results"))
        assert simulate[0] == "hd-sim-bag"
        assert bag_command.main(simulate[1:]) == 0
        assert replay[0] == "hd-monitor"
        assert main(replay[1:]) == 0
        content: dict[str, Any] = json.loads(Path(replay[-1]).read_text(encoding="utf-8"))
    return content


@pytest.fixture(scope="module")
def compared(written: dict[str, Any]) -> dict[str, Any]:
    return comparison.as_dict(comparison.compare(written, written), "run", "run")


def test_every_key_of_a_replay_is_documented(written: dict[str, Any]) -> None:
    joint = written["joints"][0]
    assert sorted(written) == sorted(keys_below("replay"))
    assert sorted(joint) == sorted(keys_below("Each joint"))
    assert sorted(joint["verdict"]) == sorted(keys_below("Verdict"))
    assert sorted(joint["timeline"][-1]) == sorted([*keys_below("Verdict"), *keys_below("Each entry of timeline")])
    assert sorted(joint["lines"][0]) == sorted(keys_below("Each entry of lines"))
    assert {f.name for f in fields(SomethingElse)} == set(keys_below("Each entry of something_else"))
    assert {f.name for f in fields(TorqueShare)} | {"reading"} == set(keys_below("Each entry of torque_shares"))
    assert sorted(joint["rms_curve"][0]) == sorted(keys_below("Each entry of rms_curve"))
    assert sorted(joint["quality"]) == sorted(keys_below("Quality"))


def test_every_key_of_a_comparison_is_documented(compared: dict[str, Any]) -> None:
    joint = compared["joints"][0]
    assert sorted(compared) == sorted(keys_below("compare"))
    assert sorted(joint) == sorted(keys_below("Each compared joint"))
    assert sorted(joint["indexes"][0]) == sorted(keys_below("Each entry of indexes"))
    assert sorted(joint["before"]) == sorted(keys_below("Verdict"))


@pytest.fixture(scope="module")
def identified(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Identify from joint states alone, since only that mode has directions; strokes give it two."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("identified"))
        effort = ["--set", "joint_states.effort:=reaction", "--set", "joint_states.effort_noise:=0.3"]
        rig = ["--programme", "strokes", "--duration", "40", "--seed", "1", "--publish", "none", *effort]
        rig += ["--out", "strokes"]
        assert bag_command.main(rig) == 0
        assert main(["identify", "strokes", "-p", "input.source:=joint_effort", "--json", "strokes.json"]) == 0
        content: dict[str, Any] = json.loads(Path("strokes.json").read_text(encoding="utf-8"))
    return content


def test_every_key_of_an_identification_is_documented(identified: dict[str, Any]) -> None:
    joint = identified["joints"][0]
    assert sorted(identified) == sorted(keys_below("identify"))
    assert sorted(joint) == sorted(keys_below("Each identified joint"))
    assert sorted(joint["directions"][0]) == sorted(keys_below("Each entry of directions"))
    assert sorted(joint["teeth"]) == sorted(keys_below("Teeth"))
    spline = joint["flexspline"]
    assert sorted(spline) == sorted(keys_below("Each identified spline"))
    assert sorted(spline["index"]) == ["high", "low", "std", "value"]
    assert set(joint["quality"]) == set(keys_below("Quality")) - {"rate", "last_fault"}
    for nested in (*spline["harmonics"][:1], joint["teeth"]["ranked"][0]):
        assert all(f"`{key}`" in PAGE for key in nested)


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """All plain values in nested lists and mappings; a list's entries by one path, since the example has fewer."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from leaves(item, f"{path}.{key}")
    elif isinstance(value, list):
        for item in value:
            yield from leaves(item, f"{path}[]")
    else:
        yield path, value


def test_the_example_is_what_the_commands_write(written: dict[str, Any]) -> None:
    example = json.loads(PAGE.partition("```json\n")[2].partition("```")[0])
    kinds = {path: type(value) for path, value in leaves(written)}
    assert {path: type(value) for path, value in leaves(example)}.items() <= kinds.items()
    shown, verdict = example["joints"][0]["verdict"], written["joints"][0]["verdict"]
    for name in ("component", "level", "level_name", "fault_code", "samples", "gaps"):
        assert shown[name] == verdict[name]
    for name in ("flexspline_index", "circular_spline_index"):
        assert shown[name] == pytest.approx(verdict[name], rel=0.02)
    assert shown["travel_deg"] == pytest.approx(verdict["travel_deg"], rel=0.05)

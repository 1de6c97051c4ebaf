"""A parameter file means offline what it means to the node."""

from pathlib import Path
from typing import Any

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.offline.parameters import load_parameters, parse_override, read_yaml


def load(tmp_path: Path, text: str, node: str | None = None) -> dict[str, Any]:
    file = tmp_path / "params.yaml"
    file.write_text(text, encoding="utf-8")
    return load_parameters(file, node)


BODY = "{ros__parameters: {diagnosis: {warn_index: 0.02}}}"
BASE = "  ros__parameters:\n    diagnosis.warn_index: 0.03\n    diagnosis: {error_index: 0.09}\n"


@pytest.mark.parametrize(
    "name", ["/**", "hd_monitor_node", "/hd_monitor_node", "/arm/hd_monitor_node", "/**/hd_monitor_node", "other"]
)
def test_the_only_node_there_is_is_meant(tmp_path: Path, name: str) -> None:
    assert load(tmp_path, f'"{name}": {BODY}') == {"diagnosis.warn_index": 0.02}


def test_a_namespace_may_stand_above_the_node(tmp_path: Path) -> None:
    assert load(tmp_path, f"arm:\n  hd_monitor_node: {BODY}") == {"diagnosis.warn_index": 0.02}
    assert load(tmp_path, f"/arm:\n  hd_monitor_node: {BODY}", "/arm/hd_monitor_node") == {"diagnosis.warn_index": 0.02}


def test_later_sections_override_earlier_ones(tmp_path: Path) -> None:
    text = f"/**:\n{BASE}hd_monitor_node: {BODY}\n/**/other: {{ros__parameters: {{x: 1}}}}"
    assert load(tmp_path, text) == {"diagnosis.warn_index": 0.02, "diagnosis.error_index": 0.09}


def test_one_star_stands_for_one_level(tmp_path: Path) -> None:
    text = f"/*/hd_monitor_node: {BODY}"
    assert load(tmp_path, text, "/arm/hd_monitor_node") == {"diagnosis.warn_index": 0.02}
    with pytest.raises(ParameterError, match="none of /a/b/hd_monitor_node"):
        load(tmp_path, text, "/a/b/hd_monitor_node")


def test_two_monitors_must_be_distinguished(tmp_path: Path) -> None:
    text = f"/left/hd_monitor_node: {BODY}\n/right/hd_monitor_node:\n{BASE}"
    with pytest.raises(ParameterError, match="--node"):
        load(tmp_path, text)
    assert load(tmp_path, text, "right/hd_monitor_node")["diagnosis.warn_index"] == 0.03


def test_bare_parameters_are_taken_as_they_are(tmp_path: Path) -> None:
    assert load(tmp_path, "diagnosis: {warn_index: 0.02}") == {"diagnosis.warn_index": 0.02}


def test_numbers_are_read_as_ros_reads_them(tmp_path: Path) -> None:
    assert load(tmp_path, "a: 5e-2\nb: 1E3\nc: 10\nd: yes\ne: '5e-2'") == {
        "a": 0.05,
        "b": 1000.0,
        "c": 10,
        "d": True,
        "e": "5e-2",
    }


@pytest.mark.parametrize("text", ["a: [1", "- 1\n- 2", "just words"])
def test_anything_but_a_parameter_file_is_refused_in_one_line(tmp_path: Path, text: str) -> None:
    with pytest.raises(ParameterError) as caught:
        load(tmp_path, text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("/**: {ros__parameters: hello}", "ros__parameters of /\\*\\* is 'hello'"),
        ("/**: {ros__parameters: [1, 2]}", r"is \[1, 2\]"),
        ("load: &a {torque: *a}", "no aliases"),
        ("load: " + "[" * 5000, "nested too deeply"),
        ("load: " + "{a: " * 5000, "nested too deeply"),
        ("a: 1\n" * 1_000_000, "is larger than 4 MB"),
        ("load: 2001-13-01", "not valid YAML: month must be in 1..12"),
    ],
    ids=lambda text: text[:30],
)
def test_what_no_node_could_read_is_refused_with_its_cause(tmp_path: Path, text: str, cause: str) -> None:
    with pytest.raises(ParameterError, match=cause) as caught:
        load(tmp_path, text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("repeated", ["{x: *a%d, y: *a%d}", "[*a%d, *a%d]", "{<<: [*a%d, *a%d]}"])
def test_aliases_that_grow_without_end_are_refused_where_aliases_are_read(tmp_path: Path, repeated: str) -> None:
    file = tmp_path / "paper.yaml"
    file.write_text("\n".join(["a0: &a0 {x: 1}"] + [f"a{n + 1}: &a{n + 1} {repeated % (n, n)}" for n in range(40)]))
    with pytest.raises(ParameterError, match="an alias repeats itself"):
        read_yaml(file)
    file.write_text("a: &a\n  b: *a")
    with pytest.raises(ParameterError, match="an alias repeats itself"):
        read_yaml(file)
    file.write_text("a: &a {b: 1}\nc: *a\nd: {<<: *a}")
    assert read_yaml(file) == {"a": {"b": 1}, "c": {"b": 1}, "d": {"b": 1}}


def test_an_empty_file_sets_nothing(tmp_path: Path) -> None:
    assert load(tmp_path, "# nothing\n") == {}


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="cannot be read"):
        load_parameters(tmp_path / "none.yaml")


def test_overrides_are_written_as_on_the_ros_command_line() -> None:
    assert parse_override("diagnosis.warn_index:=5e-2") == ("diagnosis.warn_index", 0.05)
    assert parse_override("joints:=[a, b]") == ("joints", ["a", "b"])
    assert parse_override("reducer.serial:=") == ("reducer.serial", None)
    for wrong in ("diagnosis.warn_index=1", ":=1", "x:=[1"):
        with pytest.raises(ParameterError):
            parse_override(wrong)

"""Other tools read what the node says: each is held to its own rules, as its source has them."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from tests.msgs_doc.test_pages import documented_keys, everything_known, relative

from hd_monitor.diagnosis.status import Status, input_status_of, status_of
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings

CONFIG = Path(__file__).resolve().parents[2] / "config"


def statuses() -> list[Status]:
    """Statuses in as many states as differ in their values, one with a name that has quotes in it."""
    nothing = Monitor(JointSettings.from_mapping({"reducer.serial": "HD-7"}))
    quoting = Monitor(JointSettings.from_mapping())
    quoting.reject('joint "bob\'s" is not in joint_states')
    states = [nothing.silence(0), everything_known(), relative(everything_known()), quoting.silence(0)]
    return [write(state, "elbow") for state in states for write in (status_of, input_status_of)]


# diagnostic_aggregator -----------------------------------------------------------------------------------------------


def groups_of(name: str) -> list[str]:
    """Groups of the shipped file that take a status: a GenericAnalyzer's regex has to match all of its name."""
    yaml = pytest.importorskip("yaml")
    analyzers = yaml.safe_load((CONFIG / "aggregator.yaml").read_text())["analyzers"]["ros__parameters"]
    groups = {name: group for name, group in analyzers.items() if isinstance(group, dict)}
    assert {group["type"] for group in groups.values()} == {"diagnostic_aggregator/GenericAnalyzer"}
    return [group["path"] for group in groups.values() if any(re.fullmatch(regex, name) for regex in group["regex"])]


@pytest.mark.parametrize("node", ["/hd_monitor_node", "/cell/arm/elbow_watch"])
@pytest.mark.parametrize("joint", ["joint", "shoulder_pan_joint", "joint input"])
def test_every_status_is_in_one_group_of_the_aggregator(node: str, joint: str) -> None:
    assert groups_of(f"{node}: {joint} reducer") == ["Reducers"]
    assert groups_of(f"{node}: {joint} input") == ["Inputs"]
    assert groups_of(f"{node}: {joint}") == ["Inputs"] * joint.endswith(" input")


# diagnostic_remote_logging -------------------------------------------------------------------------------------------


def is_number(text: str) -> bool:
    """Whether a stream reads all of a text as a number, in which case it is written as one."""
    return re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", text) is not None


def line(status: Status) -> str:
    """Write a status as InfluxDB's line protocol does: only blanks in keys are escaped, texts stand in quotes."""
    fields = [("level", str(status.level)), ("message", status.message), *status.values]
    written = [f"{key.replace(' ', chr(92) + ' ')}={v if is_number(v) else chr(34) + v + chr(34)}" for key, v in fields]
    return f"hd_monitor_node,name=elbow {','.join(written)} 1795257240669542511"


def fields_of(text: str) -> dict[str, str]:
    """Read the fields of a line as InfluxDB does, with their types."""
    row = re.fullmatch(r"hd_monitor_node,name=elbow (?P<fields>.*) \d+", text)
    assert row
    field = r'(?:(?P<key>(?:\\ |[^ ,=])+)=(?:"(?P<text>[^"]*)"|(?P<number>[-+.eE\d]+)))'
    assert re.fullmatch(rf"{field}(,{re.sub(r'[?]P<[a-z]+>', '?:', field)})*", row["fields"])
    return {m["key"]: "text" if m["number"] is None else "number" for m in re.finditer(field, row["fields"])}


def test_a_field_of_influxdb_has_one_type_for_life() -> None:
    types: dict[str, str] = {}
    for status in statuses():
        read = fields_of(line(status))
        assert set(read) == {key.replace(" ", "\\ ") for key in ("level", "message", *dict(status.values))}
        for key, kind in read.items():
            assert types.setdefault(key, kind) == kind, key
    assert types["flexspline\\ index\\ (%)"] == types["level"] == "number"


# Grafana -------------------------------------------------------------------------------------------------------------


def test_every_field_of_the_dashboard_is_a_documented_value() -> None:
    dashboard: dict[str, Any] = json.loads((CONFIG / "grafana.json").read_text())
    queries = [target["query"] for panel in dashboard["panels"] for target in panel["targets"]]
    asked = {field for query in queries for field in re.findall(r'r\._field == "([^"]+)"', query)}
    assert len(queries) == 7
    assert asked <= {"level", *documented_keys("reducer"), *documented_keys("input")}
    assert {"flexspline index (%)", "circular spline transmission error (arcmin)", "fault_code"} <= asked

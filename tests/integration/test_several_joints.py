"""One node watches several joints, each with inputs, reducer and verdict of its own."""

from typing import Any

import pytest

from .conftest import QUICK, Bench
from .test_verdicts import settled

pytestmark = pytest.mark.ros


def rig_of(bench: Bench, joint: str, *parameters: str) -> Any:
    return bench.rig(
        f"joint_states.name:={joint}",
        f"torsional_acceleration/block->{joint}/torsional_acceleration/block",
        f"__node->rig_{joint}",
        *parameters,
        *QUICK,
    )


def of(bench: Bench, joint: str) -> Any:
    return bench.until_status(
        lambda s: s.name == f"/hd_monitor_node: {joint} reducer" and settled(s), f"a verdict on the {joint}"
    )


def test_two_joints_with_different_reducers(bench: Bench, peer: Any) -> None:
    bench.monitor(
        "joints:=[shoulder, elbow]",
        "reducer.serial:=none",
        "shoulder.reducer.serial:=S-1",
        "elbow.reducer.flexspline_teeth:=200",
        "elbow.reducer.circular_spline_teeth:=202",
        "elbow.reducer.mount:=flexspline_fixed",
    )
    rig_of(bench, "shoulder", "defect:=circular_spline")
    rig_of(
        bench,
        "elbow",
        "defect:=flexspline",
        "reducer.flexspline_teeth:=200",
        "reducer.circular_spline_teeth:=202",
        "reducer.mount:=flexspline_fixed",
    )
    shoulder, elbow = of(bench, "shoulder"), of(bench, "elbow")
    assert (shoulder.component, shoulder.hardware_id) == ("circular_spline", "S-1")
    assert (elbow.component, elbow.hardware_id) == ("flexspline", "none")
    assert (shoulder.values["joint"], elbow.values["joint"]) == ("shoulder", "elbow")
    topics = {name for name, _ in peer.node.get_topic_names_and_types()}
    assert {"/shoulder/zoom_spectrum", "/shoulder/rms_curve", "/elbow/zoom_spectrum", "/elbow/rms_curve"} <= topics
    assert "/zoom_spectrum" not in topics


def test_one_joint_without_input_leaves_the_other_alone(bench: Bench) -> None:
    bench.monitor("joints:=[shoulder, elbow]", "shoulder.input.startup_timeout:=2.0")
    rig_of(bench, "elbow", "defect:=flexspline")
    assert of(bench, "elbow").component == "flexspline"
    lost = bench.until_input(
        lambda s: s.values["joint"] == "shoulder" and s.fault_code == "HD_INPUT_LOST", "the other's lost input"
    )
    assert "/shoulder/torsional_acceleration/block" in lost.values["reason"]


def test_sensorless_joint_beside_one_with_a_sensor(bench: Bench, peer: Any) -> None:
    bench.monitor("joints:=[shoulder, elbow]", "shoulder.input.source:=joint_effort")
    bench.until(lambda: bench.statuses, "a status")
    topics = {name for name, _ in peer.node.get_topic_names_and_types()}
    assert "/elbow/torsional_acceleration/block" in topics
    assert "/shoulder/torsional_acceleration/block" not in topics

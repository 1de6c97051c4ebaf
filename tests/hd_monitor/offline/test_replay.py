"""Replay says the same however the messages are stored, bundled or interleaved, and names what is missing."""

import itertools
from pathlib import Path
from typing import Any

import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.diagnosis.inputs import InputCode
from hd_monitor.diagnosis.status import status_of
from hd_monitor.diagnosis.verdict import Component, FaultCode
from hd_monitor.offline import batches
from hd_monitor.offline.bag import Bag
from hd_monitor.offline.errors import BagError
from hd_monitor.offline.plan import Request, plan
from hd_monitor.offline.replay import Replayed, replay

FAST: dict[str, Any] = {"programme": "fixed", "fixed__speed": 1200.0, "duration": 12.0}


def run(path: Path, **request: Any) -> list[Replayed]:
    with Bag(path) as bag:
        return list(replay(bag, plan(bag, Request(**request))))


def statuses(said: list[Replayed]) -> list[Any]:
    return [(s.assessment.stamp, status_of(s.assessment, s.plan.joint)) for s in said]


@pytest.fixture(scope="module")
def rig() -> list[rec.Event]:
    return rec.simulated(**FAST, defect="flexspline")


@pytest.fixture(scope="module")
def recording(rig: list[rec.Event], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return rec.write(tmp_path_factory.mktemp("rig") / "bag", rig)


def test_a_defect_is_named(recording: Path) -> None:
    last = run(recording)[-1]
    assert last.last
    assert last.assessment.verdict.component is Component.FLEXSPLINE


def test_one_assessment_a_period_with_rising_stamps(recording: Path) -> None:
    stamps = [said.assessment.stamp for said in run(recording) if not said.last]
    assert len(stamps) >= 10
    assert {later - earlier for earlier, later in itertools.pairwise(stamps)} == {1_000_000_000}


def test_storage_and_compression_change_nothing(recording: Path, rig: list[rec.Event], tmp_path: Path) -> None:
    expected = statuses(run(recording))
    assert statuses(run(rec.write(tmp_path / "sqlite", rig, storage=rec.SQLITE))) == expected
    assert statuses(run(rec.write(tmp_path / "packed", rig, compression="storage"))) == expected


@pytest.mark.parametrize("messages", [7, 10**6])
def test_how_messages_are_bundled_changes_nothing(
    recording: Path, rig: list[rec.Event], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, messages: int
) -> None:
    expected = statuses(run(recording))
    database = rec.write(tmp_path / "sqlite", rig, storage=rec.SQLITE)
    monkeypatch.setattr(batches, "ROWS", messages)
    assert statuses(run(database)) == expected


def test_recording_delays_change_nothing_but_the_order(rig: list[rec.Event], recording: Path, tmp_path: Path) -> None:
    late = [e._replace(time=e.time + 300_000_000) if e.topic == "/joint_states" else e for e in rig]
    assert statuses(run(rec.write(tmp_path / "late", late))) == statuses(run(recording))


def test_blocks_and_single_samples_agree(tmp_path: Path) -> None:
    both = rec.write(tmp_path / "both", rec.simulated(**FAST, defect="circular_spline", publish="both"))
    by_source = [
        statuses(run(both, parameters={"input.source": source}))[-1][1] for source in ("block", "accel_stamped")
    ]
    assert by_source[0] == by_source[1]
    assert by_source[0].value("component") == "circular_spline"


def test_several_joints_in_one_pass(tmp_path: Path) -> None:
    left = rec.simulated(prefix="/arm/elbow", joint="elbow", **FAST, defect="flexspline")
    right = rec.simulated(prefix="/arm/wrist", joint="wrist", **FAST, defect="none", seed=2)
    events = [e._replace(topic="/arm/joint_states") if e.topic.endswith("joint_states") else e for e in (*left, *right)]
    path = rec.write(tmp_path / "arm", events)
    for request in ({}, {"joints": ["elbow", "wrist"]}, {"parameters": {"joints": ["elbow", "wrist"]}}):
        last = {said.plan.joint: said.assessment.verdict.component for said in run(path, **request) if said.last}
        assert last == {"elbow": Component.FLEXSPLINE, "wrist": Component.NONE}
    only = run(path, parameters={"joints": ["elbow", "wrist"]}, joints=["wrist"])
    assert {said.plan.joint for said in only} == {"wrist"}


def test_a_pause_in_the_recording_shows_as_lost_input(rig: list[rec.Event], tmp_path: Path) -> None:
    path = rec.write(tmp_path / "pause", [e for e in rig if not 4 < (e.time - rec.START) / 1e9 < 9])
    said = [(said.assessment.input.code, said.assessment.verdict.fault_code) for said in run(path)]
    assert InputCode.LOST in dict(said)
    assert said[-1] == (InputCode.OK, FaultCode.FLEXSPLINE)


def test_a_clock_set_back_is_counted_and_survived(rig: list[rec.Event], tmp_path: Path) -> None:
    again = rec.simulated(**FAST, defect="flexspline", start=rec.START - 3600 * 10**9)
    shifted = [e._replace(time=e.time + (3600 + 13) * 10**9) for e in again]
    last = run(rec.write(tmp_path / "clock", [*rig, *shifted]))[-1].assessment
    assert last.quality.clock_jumps >= 1
    assert last.verdict.component is Component.FLEXSPLINE


def test_a_missing_input_is_refused_with_what_is_there(rig: list[rec.Event], tmp_path: Path) -> None:
    blocks_only = rec.write(tmp_path / "blocks", [e for e in rig if "block" in e.topic])
    with pytest.raises(BagError, match=r"no joint_states .* was recorded: it holds /torsional_acceleration/block"):
        run(blocks_only)
    states_only = rec.write(tmp_path / "states", [e for e in rig if "block" not in e.topic])
    with pytest.raises(BagError, match=r"set input\.source to joint_effort"):
        run(states_only)


def test_a_joint_that_is_not_recorded_leaves_a_complaint_with_the_names(recording: Path) -> None:
    last = run(recording, joints=["elbow"])[-1].assessment
    assert last.quality.motion_messages == 0
    assert "'elbow' is not in joint_states, which carries joint" in last.quality.last_fault


def test_a_force_torque_sensor_takes_the_place_of_efforts(tmp_path: Path) -> None:
    rig = rec.simulated(**FAST, defect="flexspline", joint_states__effort="none")
    stamps = range(rec.START, rec.START + 12 * 10**9, 13_000_000)
    torques = [rec.Event(stamp, "/ft_sensor/wrench", rec.wrench(stamp, -10.0)) for stamp in stamps]
    parameters = {"load.source": "wrench", "load.topic": "ft_sensor/wrench", "load.axis": "-x", "load.torque": 30.0}
    said = run(rec.write(tmp_path / "bag", rig + torques), parameters=parameters)
    last = said[-1].assessment
    assert last.verdict.component is Component.FLEXSPLINE
    assert last.torque_source == "wrench"
    assert last.identification is not None
    assert last.identification.index.flexspline == pytest.approx(0.103, rel=0.05)
    delayed = [event._replace(time=event.time + 300_000_000) for event in torques]
    assert statuses(run(rec.write(tmp_path / "delayed", rig + delayed), parameters=parameters)) == statuses(said)
    with pytest.raises(BagError, match=r"no ft_sensor/wrench \(geometry_msgs/WrenchStamped\) was recorded"):
        run(rec.write(tmp_path / "without", rig), parameters=parameters)

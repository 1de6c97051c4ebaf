"""A transition into an error leaves a recording from which the same verdict follows."""

import json
from pathlib import Path
from typing import Any

import pytest

from hd_monitor.cli.main import main

from .conftest import ERROR, QUICK, Bench
from .test_verdicts import settled

pytestmark = pytest.mark.ros


PUBLISHED = {
    "block": ("publish:=block",),
    "accel_stamped": ("publish:=samples",),
    "imu": ("publish:=none", "publish_imu:=true"),
}


@pytest.mark.parametrize("source", PUBLISHED)
def test_the_replay_of_a_snapshot_gives_its_verdict(bench: Bench, tmp_path: Path, source: str) -> None:
    from rosbags.highlevel import AnyReader

    ledger = tmp_path / "ledger.sqlite"
    bench.monitor(f"input.source:={source}", f"history.path:={ledger}", "reducer.serial:=A7")
    bench.rig("defect:=circular_spline", *PUBLISHED[source], "time_scale:=3.0", *QUICK[1:])
    bench.until_status(lambda s: settled(s) and s.level == ERROR, "a settled error")
    folder = tmp_path / "ledger.sqlite.snapshots" / "A7"
    bench.until(lambda: list(folder.glob("*-HD_CIRCULAR_SPLINE")), "a snapshot")
    (snapshot, *_) = sorted(folder.glob("*-HD_CIRCULAR_SPLINE"))
    out = tmp_path / "out.json"
    data, parameters = snapshot / "data.mcap", snapshot / "parameters.yaml"
    assert main(["replay", str(data), "--params", str(parameters), "--json", str(out)]) == 0
    replayed: dict[str, Any] = json.loads(out.read_text())["joints"][0]["verdict"]
    reducer, _ = json.loads((snapshot / "status.json").read_text())
    assert replayed["fault_code"] == reducer["fault_code"] == "HD_CIRCULAR_SPLINE"
    assert (replayed["component"], replayed["level"]) == (reducer["component"], reducer["level"])
    with AnyReader([data]) as reader:  # the definitions in the file are enough for others to read it
        states: list[Any] = [reader.deserialize(m, c.msgtype) for c, _, m in reader.messages() if "joint" in c.topic]
        assert {name for state in states for name in state.name} == {"joint"}
        assert len(reader.topics) == 2


def test_without_a_ledger_there_is_none(bench: Bench, tmp_path: Path) -> None:
    bench.monitor()
    bench.rig("defect:=flexspline", *QUICK)
    bench.until_status(settled, "a settled verdict")
    assert not list(tmp_path.rglob("*.mcap"))

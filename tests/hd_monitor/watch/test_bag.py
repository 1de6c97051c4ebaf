"""A recording on the screen: the very verdict of a replay, or the statuses that were recorded."""

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor import contract
from hd_monitor.offline.errors import BagError
from hd_monitor.offline.plan import Request
from hd_monitor.offline.run import replay_bag
from hd_monitor.watch import bag
from hd_monitor.watch.app import WatchApp
from hd_monitor.watch.bag import BagSource
from hd_monitor.watch.state import View

from .statuses import Fixed, defective, inputs, screen_after, sound, use

T = rec.TYPES


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    events = rec.simulated(programme="fixed", fixed__speed=1200.0, duration=12.0, defect="flexspline")
    return rec.write(tmp_path_factory.mktemp("rig") / "bag", events)


def read(source: BagSource) -> list[View]:
    """Look until the recording has been read; the last view is the result."""
    views = [source.begin()]
    while views[-1].progress != 1.0:
        views.append(source.update(views[-1], time.monotonic()))
    assert source.update(views[-1], 0.0).joints == views[-1].joints
    source.close()
    return views


def test_a_recording_gives_the_verdict_of_its_replay(recording: Path) -> None:
    view = read(BagSource(recording, Request()))[-1]
    (joint,) = view.joints.values()
    (replayed,) = replay_bag(recording, Request()).content["joints"]
    verdict, status = replayed["verdict"], replayed["status"]
    assert (joint.component, int(joint.level), joint.code) == ("flexspline", 2, verdict["fault_code"])
    assert joint.values == status
    assert joint.input is not None
    assert joint.input.values["fault_code"] == replayed["input"]["fault_code"]
    assert joint.curves[contract.RMS_CURVE].y == pytest.approx([point["rms"] for point in replayed["rms_curve"]])
    assert len(joint.curves[contract.ZOOM_SPECTRUM].x) == contract.ZOOM_BINS
    assert joint.before == "no verdict"
    assert 5.0 < (joint.stamp - joint.since) / 1e9 < 12.0


def test_the_screen_lives_while_a_recording_is_read(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bag, "_AT_ONCE", 0.0)  # a look for each assessment
    views = read(BagSource(recording, Request()))
    progress = [view.progress or 0.0 for view in views]
    assert progress == sorted(progress)
    assert len(views) > 10
    assert 0.0 < progress[len(views) // 2] < 1.0
    assert "99%" in screen_after(WatchApp(Fixed(views[-2])))
    text = screen_after(WatchApp(Fixed(views[-1])), size=(200, 60))
    assert "bag, replayed" in text
    assert "joint: ERROR, flexspline" in text
    assert "Missing  nothing" in text


def test_an_app_reads_a_recording_to_its_end(recording: Path) -> None:
    source = BagSource(recording, Request())
    app = WatchApp(source)

    async def until_read(pilot: Any) -> None:
        while app.view.progress != 1.0 and app.failure is None:
            await pilot.pause(0.05)

    use(app, until_read)
    source.close()
    assert [joint.component for joint in app.view.ranked] == ["flexspline"]


def test_parameters_hold_in_a_recording_too(recording: Path) -> None:
    request = Request(parameters={"diagnosis.warn_index": 0.2, "diagnosis.error_index": 0.3, "reducer.serial": "HD-7"})
    (joint,) = read(BagSource(recording, request))[-1].joints.values()
    assert (joint.component, joint.reducer and joint.reducer.hardware_id) == ("none", "HD-7")


def diagnostics(stamp: int, *statuses: Any) -> Any:
    pair, status = T["diagnostic_msgs/msg/KeyValue"], T["diagnostic_msgs/msg/DiagnosticStatus"]
    return T["diagnostic_msgs/msg/DiagnosticArray"](
        rec.header(stamp),
        [
            status(s.level, s.name, s.message, s.hardware_id, [pair(key, value) for key, value in s.values.items()])
            for s in statuses
        ],
    )


def spectrum() -> Any:
    dimension, layout = T["std_msgs/msg/MultiArrayDimension"], T["std_msgs/msg/MultiArrayLayout"]
    data = np.concatenate((np.linspace(56.0, 60.0, 50), np.ones(50)))
    dimensions = [dimension("frequency_amplitude", 2, 100), dimension("bin", 50, 50)]
    return T["std_msgs/msg/Float64MultiArray"](layout(dimensions, 0), data)


def test_recorded_statuses_are_shown_where_nothing_can_be_replayed(tmp_path: Path) -> None:
    times = [rec.START + second * 10**9 for second in range(20)]
    events = [rec.Event(times[0], "/diagnostics", diagnostics(times[0], sound(), inputs()))]
    events += [rec.Event(time, "/diagnostics", diagnostics(time, defective(), inputs())) for time in times[1:]]
    events += [rec.Event(time, "/arm/zoom_spectrum", spectrum()) for time in times]
    foreign = T["diagnostic_msgs/msg/DiagnosticStatus"](2, "/camera: driver input", "no frames", "", [])
    events.append(
        rec.Event(times[-1], "/diagnostics", T["diagnostic_msgs/msg/DiagnosticArray"](rec.header(0), [foreign]))
    )
    view = read(BagSource(rec.write(tmp_path / "bag", events), Request()))[-1]
    (joint,) = view.joints.values()
    assert (joint.key.node, joint.key.joint, joint.component) == ("/arm/hd_monitor_node", "elbow", "flexspline")
    assert (joint.since, joint.stamp, joint.before) == (times[1], times[-1], "OK, none")
    assert joint.curves[contract.ZOOM_SPECTRUM].x[0] == 56.0
    text = screen_after(WatchApp(Fixed(view)))
    assert "bag, recorded statuses" in text
    assert "elbow: ERROR, flexspline" in text


def test_a_recording_without_inputs_or_statuses_is_refused(tmp_path: Path) -> None:
    events = [rec.Event(rec.START, "/temperature", rec.temperature(rec.START, 31.0))]
    with pytest.raises(BagError, match="joint_states"):
        BagSource(rec.write(tmp_path / "bag", events), Request())

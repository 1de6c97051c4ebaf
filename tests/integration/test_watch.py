"""The terminal view over DDS: a real monitor comes up, names a part, and goes."""

import time
from collections.abc import Iterator
from typing import Any

import pytest
from tests.hd_monitor.watch.statuses import Fixed, screen_after, use

from hd_monitor import contract
from hd_monitor.watch.app import WatchApp
from hd_monitor.watch.state import Key, View

from .conftest import Bench
from .test_several_joints import rig_of

pytestmark = pytest.mark.ros

NODE = "/hd_monitor_node"


@pytest.fixture
def source() -> Iterator[Any]:
    from hd_monitor.watch.live import LiveSource

    source = LiveSource()
    yield source
    source.close()


def test_a_monitor_of_two_joints_from_its_first_status_to_its_end(bench: Bench, source: Any) -> None:
    view: View = source.begin()
    assert "0 joints" in screen_after(WatchApp(Fixed(view)))
    monitor = bench.monitor("joints:=[shoulder, elbow]", "elbow.reducer.serial:=EL-7")
    rig_of(bench, "elbow", "defect:=flexspline")
    elbow, shoulder = Key(NODE, "elbow"), Key(NODE, "shoulder")

    def named() -> bool:
        nonlocal view
        view = source.update(view, time.monotonic())
        curves = (contract.ZOOM_SPECTRUM, contract.RMS_CURVE)
        if not {elbow, shoulder} <= set(view.joints):  # a transition is told of one joint alone
            return False
        joint = view.joints[elbow]
        return joint.component == "flexspline" and all(name in joint.curves for name in curves)

    bench.until(named, "both joints, the defect and its curves in the view")
    assert [joint.key for joint in view.ranked] == [elbow, shoulder]
    assert view.joints[shoulder].code == "HD_WAITING"
    text = screen_after(WatchApp(Fixed(view)), size=(200, 60))
    assert "elbow: ERROR, flexspline" in text
    assert "EL-7 · /hd_monitor_node" in text
    assert "2 joints: 1 ERROR, 1 WAITING" in text

    bench.stop(monitor)

    def gone() -> bool:
        nonlocal view
        view = source.update(view, view.now + 60.0)  # the next look without a status is a minute after the last one
        return all(view.silent_for(joint) for joint in view.joints.values())

    bench.until(gone, "both joints to be gone")
    text = screen_after(WatchApp(Fixed(view)))
    assert "2 joints: 2 GONE" in text
    assert "elbow: GONE, flexspline" in text


def test_the_app_itself_listens(peer: Any, source: Any) -> None:
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

    app = WatchApp(source)
    publisher = peer.publisher(DiagnosticArray, "/diagnostics")
    values = [KeyValue(key="fault_code", value="HD_OK"), KeyValue(key="component", value="none")]
    status = DiagnosticStatus(level=DiagnosticStatus.OK, name="/n: elbow reducer", message="sound", values=values)
    foreign = DiagnosticStatus(level=DiagnosticStatus.ERROR, name="/camera: driver input", message="no frames")
    publisher.publish(DiagnosticArray(status=[status, foreign]))

    async def until_heard(pilot: Any) -> None:
        while not app.view.joints and app.failure is None:
            await pilot.pause(0.1)

    use(app, until_heard)
    assert [joint.key for joint in app.view.ranked] == [Key("/n", "elbow")]

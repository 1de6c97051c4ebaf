"""Every kind of input leads to the same verdict, in any namespace."""

from typing import Any

import pytest

from .conftest import ERROR, OK, QUICK, Bench, TorqueSensor
from .test_verdicts import settled

pytestmark = pytest.mark.ros

SLOWER = tuple("time_scale:=3.0" if word.startswith("time_scale") else word for word in QUICK)
"""One message a sample: three thousand messages a second are enough for a shared machine."""


def test_accel_stamped(bench: Bench) -> None:
    bench.monitor("input.source:=accel_stamped")
    bench.rig("defect:=circular_spline", "publish:=samples", *SLOWER)
    status = bench.until_status(settled, "a settled verdict")
    assert status.component == "circular_spline"
    assert status.number("gaps") == 0
    assert bench.inputs[-1].number("lost samples") == 0


def test_imu(bench: Bench) -> None:
    bench.monitor("input.source:=imu", "input.axis:=-z", "input.sensor_radius:=0.4")
    bench.rig(
        "defect:=flexspline", "publish_imu:=true", "sensor.imu_axis:=-z", "sensor.radius:=0.4", *SLOWER[:1], *SLOWER[2:]
    )
    status = bench.until_status(settled, "a settled verdict")
    assert status.component == "flexspline"


def test_force_torque_sensor(bench: Bench, peer: Any) -> None:
    sensor = TorqueSensor(peer)
    bench.monitor("load.source:=wrench", "load.axis:=-x", "load.torque:=30.0")
    bench.rig("defect:=flexspline", "joint_states.effort:=none", *QUICK)

    def named() -> bool:
        sensor.measure()
        return any(settled(status) for status in bench.statuses)

    bench.until(named, "a settled verdict")
    status = next(status for status in bench.statuses if settled(status))
    assert (status.component, status.level) == ("flexspline", ERROR)
    assert status.values["torque source"] == "wrench"
    assert status.number("flexspline index (%)") == pytest.approx(10.3, abs=0.5)


def test_namespace(bench: Bench, peer: Any) -> None:
    bench.monitor("__ns->/cell/arm")
    bench.rig("defect:=flexspline", "__ns->/cell/arm", *QUICK)
    status = bench.until_status(settled, "a settled verdict")
    assert status.component == "flexspline"
    assert status.name == "/cell/arm/hd_monitor_node: joint reducer"
    published = {name for name, _ in peer.node.get_publisher_names_and_types_by_node("hd_monitor_node", "/cell/arm")}
    assert {"/diagnostics", "/cell/arm/zoom_spectrum", "/cell/arm/rms_curve"} <= published


def test_another_node_name(bench: Bench) -> None:
    bench.monitor("__node->elbow_watch", "input.timeout:=0.5")
    status = bench.until_status(lambda s: True, "a status")
    assert status.name == "/elbow_watch: joint reducer"


def test_loss_is_counted_and_survived(bench: Bench) -> None:
    bench.monitor()
    bench.rig("defect:=both", "transport.loss:=0.05", "transport.duplicates:=0.05", "transport.late:=0.05", *QUICK)
    bench.until_input(lambda s: s.number("lost samples") > 0 and s.number("duplicates") > 0, "losses")
    assert bench.until_status(settled, "a settled verdict").component == "both"


def test_output_counting_backwards(bench: Bench) -> None:
    bench.monitor()
    bench.rig("defect:=flexspline", "joint_states.reversed:=true", *QUICK)
    assert bench.until_status(settled, "a settled verdict").component == "flexspline"


def test_joint_states_alone(bench: Bench) -> None:
    bench.monitor("input.source:=joint_effort", "input.expected_rate:=5000.0")
    words = [word for word in QUICK if not word.startswith("wait_for")]  # it would wait forever for the vibration
    bench.rig(
        "defect:=flexspline", "publish:=none", "joint_states.effort:=reaction", "joint_states.rate:=500.0", *words
    )
    status = bench.until_status(lambda s: s.component != "undetermined", "a verdict")
    assert (status.component, status.level) == ("flexspline", OK)
    assert status.values["index kind"] == "relative"
    assert status.number("flexspline share (%)") > 3 * status.number("circular spline share (%)")
    assert not [key for key in status.values if key.endswith("index (%)")]

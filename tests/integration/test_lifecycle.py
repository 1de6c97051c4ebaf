"""The node is a managed one that comes up active, and keeps its evidence while it is inactive."""

from typing import Any

import pytest

from .conftest import Bench, Feeder

pytestmark = pytest.mark.ros


def change(peer: Any, label: str) -> bool:
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState

    request = ChangeState.Request(transition=Transition(label=label))
    return bool(peer.call(ChangeState, "hd_monitor_node/change_state", request).success)


def state(peer: Any) -> str:
    from lifecycle_msgs.srv import GetState

    return str(peer.call(GetState, "hd_monitor_node/get_state", GetState.Request()).current_state.label)


def trigger(peer: Any, service: str) -> Any:
    from std_srvs.srv import Trigger

    return peer.call(Trigger, f"hd_monitor_node/{service}", Trigger.Request())


def feed_until(bench: Bench, feeder: Feeder, samples: int) -> None:
    def counted() -> bool:
        feeder.send(2)
        return bool(bench.statuses) and bench.statuses[-1].number("samples") >= samples

    bench.until(counted, f"{samples} samples")


def test_comes_up_active(bench: Bench, peer: Any) -> None:
    bench.monitor()
    assert state(peer) == "active"


def test_inactive_is_silent_and_active_goes_on(bench: Bench, peer: Any, feeder: Feeder) -> None:
    bench.monitor()
    feed_until(bench, feeder, 1000)
    assert change(peer, "deactivate")
    assert state(peer) == "inactive"
    bench.until(lambda: not feeder.blocks.get_subscription_count(), "the end of the subscription")
    bench.forget()
    assert change(peer, "activate")
    status = bench.until_status(lambda s: True, "a status after the activation")
    assert status.number("samples") >= 1000
    feed_until(bench, feeder, int(status.number("samples")) + 1000)


def test_nothing_is_published_while_inactive(bench: Bench, peer: Any) -> None:
    bench.monitor()
    bench.until(lambda: bench.statuses, "a status")
    assert change(peer, "deactivate")
    bench.forget()
    # An answer of the node comes behind whatever it had published before.
    for _ in range(3):
        assert state(peer) == "inactive"
    assert not bench.statuses


def test_cleanup_drops_the_evidence(bench: Bench, peer: Any, feeder: Feeder) -> None:
    bench.monitor()
    feed_until(bench, feeder, 1000)
    for label in ("deactivate", "cleanup"):
        assert change(peer, label)
    assert state(peer) == "unconfigured"
    bench.forget()
    for label in ("configure", "activate"):
        assert change(peer, label)
    assert bench.until_status(lambda s: True, "a status").number("samples") == 0


def test_without_autostart_it_waits_for_its_manager(bench: Bench, peer: Any) -> None:
    bench.monitor("autostart:=false")
    assert state(peer) == "unconfigured"
    for label in ("configure", "activate"):
        assert change(peer, label)
    bench.until(lambda: bench.statuses, "a status")


def test_shutdown_from_active(bench: Bench, peer: Any) -> None:
    bench.monitor()
    assert state(peer) == "active"
    assert change(peer, "shutdown")
    assert state(peer) == "finalized"


def test_ctrl_c_ends_it_with_status_0(bench: Bench) -> None:
    process = bench.monitor()
    bench.until(lambda: bench.statuses, "a status")
    assert process.interrupt() == 0
    assert "Traceback" not in process.output


def test_reset_forgets_the_evidence(bench: Bench, peer: Any) -> None:
    from .conftest import QUICK
    from .test_verdicts import settled

    bench.monitor()
    bench.rig("defect:=flexspline", *QUICK)
    bench.until_status(settled, "a settled verdict")
    response = trigger(peer, "reset")
    assert (response.success, response.message) == (True, "done for joint")
    bench.forget()
    bench.until_status(lambda s: s.component == "undetermined", "a verdict without evidence")
    bench.until_status(settled, "a new verdict")


def test_latch_holds_until_it_is_reset(bench: Bench, peer: Any) -> None:
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    from .conftest import QUICK
    from .test_verdicts import settled

    bench.monitor("diagnosis.latch:=true", "analysis.memory:=5.0")
    bench.rig("defect:=flexspline", *QUICK)
    bench.until_status(settled, "a settled verdict")
    request = SetParameters.Request(parameters=[Parameter("defect", value="none").to_parameter_msg()])
    assert peer.call(SetParameters, "hd_sim_node/set_parameters", request).results[0].successful
    held = bench.until_status(
        lambda s: s.message.startswith("latched: ") and "now: Both splines are sound" in s.message,
        "a latched verdict beside a sound reducer",
    )
    assert held.component == "flexspline"
    assert trigger(peer, "reset_latch").success
    bench.until_status(lambda s: s.component == "none", "the present verdict")

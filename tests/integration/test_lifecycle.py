"""The node is a managed one that comes up active, and keeps its evidence while it is inactive."""

from pathlib import Path
from typing import Any

import pytest
from tests.managed import change_state, set_parameter, state

from .conftest import Bench, Feeder, feed_until

pytestmark = pytest.mark.ros

NODE = "hd_monitor_node"


def trigger(peer: Any, service: str) -> Any:
    from std_srvs.srv import Trigger

    return peer.call(Trigger, f"hd_monitor_node/{service}", Trigger.Request())


def test_comes_up_active(bench: Bench, peer: Any) -> None:
    bench.monitor()
    assert state(peer, NODE) == "active"


def test_inactive_is_silent_and_active_continues(bench: Bench, peer: Any, feeder: Feeder) -> None:
    bench.monitor()
    feed_until(bench, feeder, 1000)
    assert change_state(peer, NODE, "deactivate")
    assert state(peer, NODE) == "inactive"
    bench.until(lambda: not feeder.blocks.get_subscription_count(), "the end of the subscription")
    bench.forget()
    assert change_state(peer, NODE, "activate")
    status = bench.until_status(lambda s: True, "a status after the activation")
    assert status.number("samples") >= 1000
    feed_until(bench, feeder, int(status.number("samples")) + 1000)


def test_nothing_is_published_while_inactive(bench: Bench, peer: Any) -> None:
    bench.monitor()
    bench.until(lambda: bench.statuses, "a status")
    assert change_state(peer, NODE, "deactivate")
    bench.forget()
    # An answer of the node comes behind whatever it had published before.
    for _ in range(3):
        assert state(peer, NODE) == "inactive"
    assert not bench.statuses


def test_cleanup_drops_the_evidence(bench: Bench, peer: Any, feeder: Feeder) -> None:
    bench.monitor()
    feed_until(bench, feeder, 1000)
    for label in ("deactivate", "cleanup"):
        assert change_state(peer, NODE, label)
    assert state(peer, NODE) == "unconfigured"
    bench.forget()
    for label in ("configure", "activate"):
        assert change_state(peer, NODE, label)
    assert bench.until_status(lambda s: True, "a status").number("samples") == 0


def test_without_autostart_it_waits_for_its_manager(bench: Bench, peer: Any) -> None:
    bench.monitor("autostart:=false")
    assert state(peer, NODE) == "unconfigured"
    for label in ("configure", "activate"):
        assert change_state(peer, NODE, label)
    bench.until(lambda: bench.statuses, "a status")


def test_shutdown_from_active(bench: Bench, peer: Any) -> None:
    bench.monitor()
    assert state(peer, NODE) == "active"
    assert change_state(peer, NODE, "shutdown")
    assert state(peer, NODE) == "finalized"


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
    bench.until_status(lambda s: s.fault_code == "HD_WAITING", "no verdict yet")
    bench.until_status(settled, "a new verdict")


def test_latch_holds_until_it_is_reset(bench: Bench, peer: Any) -> None:
    from .conftest import QUICK
    from .test_verdicts import settled

    bench.monitor("diagnosis.latch:=true", "analysis.memory:=5.0")
    bench.rig("defect:=flexspline", *QUICK)
    bench.until_status(settled, "a settled verdict")
    assert set_parameter(peer, "hd_sim_node", "defect", "none").successful
    held = bench.until_status(
        lambda s: s.message.startswith("latched: ") and "now: Both splines are sound" in s.values["reason"],
        "a latched verdict beside a sound reducer",
    )
    assert held.component == "flexspline"
    assert trigger(peer, "reset_latch").success
    bench.until_status(lambda s: s.component == "none", "the present verdict")


def test_the_self_test_answers_with_the_statuses_and_publishes_them(bench: Bench, peer: Any, feeder: Feeder) -> None:
    from diagnostic_msgs.srv import SelfTest

    bench.monitor("reducer.serial:=A7")
    feed_until(bench, feeder, 1000)
    answer = peer.call(SelfTest, "hd_monitor_node/self_test", SelfTest.Request())
    assert [status.name for status in answer.status] == [
        "/hd_monitor_node: joint reducer",
        "/hd_monitor_node: joint input",
    ]
    worst = max(status.level for status in answer.status)
    assert (answer.id, answer.passed) == ("A7", bytes([worst == b"\0"]))


def test_every_transition_leads_where_it_should(bench: Bench, peer: Any) -> None:
    bench.monitor("autostart:=false")
    way = (
        ("configure", "inactive"),
        ("cleanup", "unconfigured"),
        ("configure", "inactive"),
        ("activate", "active"),
        ("deactivate", "inactive"),
        ("activate", "active"),
        ("deactivate", "inactive"),
        ("cleanup", "unconfigured"),
        ("configure", "inactive"),
        ("activate", "active"),
    )
    for label, there in way:
        assert change_state(peer, NODE, label), label
        assert state(peer, NODE) == there
    bench.forget()
    bench.until(lambda: bench.statuses, "a status at the end of the way")


@pytest.mark.parametrize(("way", "last"), [((), "unconfigured"), (("configure",), "inactive")])
def test_shutdown_from_the_other_states(bench: Bench, peer: Any, way: tuple[str, ...], last: str) -> None:
    process = bench.monitor("autostart:=false")
    for label in way:
        assert change_state(peer, NODE, label)
    assert state(peer, NODE) == last
    assert change_state(peer, NODE, "shutdown")
    assert state(peer, NODE) == "finalized"
    assert process.interrupt() == 0


def test_a_transition_that_makes_no_sense_is_refused(bench: Bench, peer: Any) -> None:
    bench.monitor()
    for label in ("configure", "cleanup", "activate"):
        assert not change_state(peer, NODE, label)
        assert state(peer, NODE) == "active"


def test_two_monitors_side_by_side_share_a_ledger(bench: Bench, tmp_path: Path) -> None:
    from .conftest import QUICK
    from .test_verdicts import settled

    path = tmp_path / "ledger.sqlite"
    watches = [bench.monitor(f"__node->watch_{one}", f"history.path:={path}") for one in "ab"]
    bench.rig("defect:=circular_spline", "wait_for_subscribers:=2", *(word for word in QUICK if "wait_for" not in word))
    a = bench.until_status(lambda s: s.name == "/watch_a: joint reducer" and settled(s), "a verdict of the first")
    b = bench.until_status(lambda s: s.name == "/watch_b: joint reducer" and settled(s), "a verdict of the second")
    assert (a.component, b.component) == ("circular_spline", "circular_spline")
    assert not [line for watch in watches for line in watch.output.splitlines() if "the history is not kept" in line]

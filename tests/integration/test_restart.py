"""A node that was killed shows what it last said, with its age, until new motion bears a verdict."""

import time
from collections.abc import Iterator
from itertools import batched, groupby
from pathlib import Path
from typing import Any

import pytest
from tests.hd_monitor.ros.test_memory import swinging

from hd_monitor.diagnosis.verdict import Component
from hd_monitor.history.ledger import Ledger

from .conftest import Bench, Shown

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SERIAL = "HD-0042"


def said(status: Shown) -> tuple[str, str, int]:
    return status.component, status.fault_code, status.level


def in_turn(statuses: list[Shown]) -> list[tuple[str, str, int]]:
    """Return what the statuses said, each once for as long as it stood."""
    return [what for what, _ in groupby(map(said, statuses))]


def wait_for_entry(bench: Bench, path: Path, component: Component) -> None:
    def written() -> bool:
        with Ledger(path) as ledger:
            newest = ledger.latest(SERIAL)
        return newest is not None and newest.verdict is not None and newest.verdict.component is component

    bench.until(written, f"an entry that names {component}")


def restart(bench: Bench, killed: Any, *parameters: str) -> None:
    """Kill a monitor and start it again; wait until it has told for a while how old its verdict is."""
    bench.kill(killed)
    bench.forget()
    bench.monitor(*parameters)
    first = bench.until_status(lambda s: True, "a status").number("evidence age (s)")
    bench.until_status(lambda s: s.number("evidence age (s)") >= first + 2.0, "an older verdict")
    ages = [status.number("evidence age (s)") for status in bench.statuses]
    assert ages == sorted(ages)


def test_with_a_sensor_the_last_verdict_stands_until_new_motion_bears_another(bench: Bench, tmp_path: Path) -> None:
    path = tmp_path / "ledger.sqlite"
    watching = f"history.path:={path}", f"reducer.serial:={SERIAL}"
    moving = "programme:=strokes", "wait_for_subscribers:=1"
    killed = bench.monitor(*watching)
    rig = bench.rig("defect:=flexspline", *moving)
    bad = said(bench.until_status(lambda s: s.component == "flexspline", "a verdict"))
    wait_for_entry(bench, path, Component.FLEXSPLINE)
    bench.stop(rig)
    restart(bench, killed, *watching)
    assert in_turn(bench.statuses) == [bad]
    bench.rig("defect:=none", *moving)
    new = bench.until_status(lambda s: s.component == "none", "a verdict on the new motion")
    assert in_turn(bench.statuses) == [bad, ("none", "HD_OK", 0)]
    assert new.number("evidence age (s)") == 0.0


def test_from_joint_states_alone_the_evidence_goes_on_counting_too(bench: Bench, peer: Any, tmp_path: Path) -> None:
    from sensor_msgs.msg import JointState

    path = tmp_path / "ledger.sqlite"
    watching = f"history.path:={path}", f"reducer.serial:={SERIAL}", "input.source:=joint_effort"
    began = time.time() - 600.0
    killed = bench.monitor(*watching)
    states = peer.publisher(JointState, "joint_states")

    def feed(start: float, seconds: float) -> Iterator[bool]:
        for some in batched(swinging(start, seconds), 100):
            for message in some:
                states.publish(message)
            yield False
        while True:
            yield True

    fed = feed(began, 60.0)
    bench.until(lambda: next(fed), "the joint states to be sent")
    bad = said(bench.until_status(lambda s: s.component == "circular_spline", "a verdict"))
    wait_for_entry(bench, path, Component.CIRCULAR_SPLINE)
    restart(bench, killed, *watching)
    assert in_turn(bench.statuses) == [bad]
    assert bench.statuses[-1].number("evidence age (s)") > 500.0
    bench.until(lambda: states.get_subscription_count() == 1, "the new monitor's subscription")
    fed = feed(began + 100.0, 5.0)  # far less than a verdict takes from nothing
    bench.until(lambda: next(fed), "the joint states to be sent")
    bench.until_status(lambda s: s.number("evidence age (s)") < 100.0, "new evidence")
    assert in_turn(bench.statuses) == [bad]

"""The policy for SROS 2 allows the two nodes what they do, and no more than their contract has."""

from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from .conftest import MONITOR, RIG, Bench

pytestmark = pytest.mark.ros

POLICY = Path(__file__).resolve().parents[2] / "config" / "security_policy.xml"
OPTIONAL = {"torsional_acceleration", "imu/data_raw", "wrench", "temperature", "clock"}
"""Inputs that some parameters name."""


def allowed(node: str, action: str) -> set[str]:
    """Full names of topics or services that the policy allows a node to publish, subscribe or reply."""
    (profile,) = ElementTree.parse(POLICY).iterfind(f".//profile[@node='{node}']")
    return {
        f"/{(entry.text or '').replace('~', node)}"
        for entries in profile.iterfind(f"*[@{action}]")
        for entry in entries
    }


def used(peer: Any, node: str, what: str) -> set[str]:
    return {name for name, _ in getattr(peer.node, f"get_{what}_names_and_types_by_node")(node, "/")}


@pytest.mark.parametrize(
    ("module", "node", "parameters"),
    [(MONITOR, "hd_monitor_node", ()), (RIG, "hd_sim_node", ("publish:=both",))],
    ids=["monitor", "rig"],
)
def test_a_node_may_do_what_it_does_and_little_more(
    bench: Bench, peer: Any, module: str, node: str, parameters: tuple[str, ...]
) -> None:
    start = bench.monitor if module == MONITOR else bench.rig
    start(*parameters)
    optional = {f"/{name}" for name in OPTIONAL}
    bench.until(lambda: node in peer.node.get_node_names(), f"{node} in the graph")
    for what, action in (("publisher", "publish"), ("subscriber", "subscribe"), ("service", "reply")):
        may = allowed(node, action)
        least = may - optional if action == "subscribe" else may
        bench.until(partial(_does, peer, node, what, least), f"all that {node} may {action}: {least}")
        assert used(peer, node, what) <= may
    assert not used(peer, node, "client")


def _does(peer: Any, node: str, what: str, least: set[str]) -> bool:
    return least <= used(peer, node, what)

"""What the node showed is what replay says of a recording of the same messages: every status, value by value."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.diagnosis.status import Status, input_status_of, status_of
from hd_monitor.offline.bag import Bag
from hd_monitor.offline.parameters import load_parameters
from hd_monitor.offline.plan import Request, plan
from hd_monitor.offline.replay import replay
from hd_monitor.settings import split_joints
from hd_monitor.sources import Source

from .conftest import MONITOR, RIG, Bench, Shown, TorqueSensor, arguments_of

pytestmark = pytest.mark.ros

PARAMETERS = """
/**/hd_monitor_node:
  ros__parameters:
    reducer: {serial: HD-0042}
    input: {source: SOURCE}
    load: {source: LOAD, axis: -x}
    diagnosis: {warn_index: 4e-2, error_index: 0.09, confirm_count: 3, confirm_window: 4}
"""
RIG_PARAMETERS = (
    "wait_for_subscribers:=3",  # the monitor, the recorder and the gate
    "programme:=sweep",
    "duration:=16.0",
    "defect:=flexspline",
    "sensor.noise:=0.5",
    "sensor.jitter:=0.0001",
    "sensor.spike_rate:=0.3",
    "transport.loss:=0.01",
    "joint_states.loss:=0.01",
    "joint_states.jitter:=0.0001",
)
PACES = {"block": 5.0, "samples": 1.5}
"""Simulated seconds in a second; one message a sample, to three processes, keeps two processors busy."""


class Recorder:
    """Subscribes to serialised messages and keeps them with the time of their arrival, as ``ros2 bag record`` does."""

    def __init__(self, peer: Any, sources: list[Source]) -> None:
        self._peer = peer
        self._subscriptions = {source: self._subscribe(source, 100_000) for source in sources}
        self.messages: list[tuple[int, Source, bytes]] = []

    def _subscribe(self, source: Source, depth: int) -> Any:
        from hd_monitor.ros.subscriptions import DrainedSubscription

        return DrainedSubscription(self._peer.node, source.topic, source.type, depth=depth, reliability="reliable")

    def matched(self) -> bool:
        """Whether every topic has a publisher that is known here."""
        return all(self._peer.node.count_publishers(source.topic) for source in self._subscriptions)

    def open_gate(self) -> None:
        """Subscribe once more: the rig that waits for it starts now."""
        for source in self._subscriptions:
            self._subscribe(source, 1)

    def drain(self) -> None:
        for source, subscription in self._subscriptions.items():
            self.messages += [(time.time_ns(), source, data) for data in subscription.drain()]

    def write(self, path: Path) -> Path:
        from rosbags.rosbag2 import StoragePlugin, Writer

        with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            connections = {
                source: writer.add_connection(
                    f"/{source.topic}", source.type.replace("/", "/msg/"), typestore=rec.STORE
                )
                for source in self._subscriptions
            }
            for arrived, source, data in self.messages:
                writer.write(connections[source], arrived, data)
        return path


def plain(status: Shown | Status) -> tuple[int, str, str, dict[str, str]]:
    return status.level, status.message, status.hardware_id, dict(status.values)


@pytest.mark.parametrize(
    ("source", "publish", "load"),
    [("block", "block", "auto"), ("accel_stamped", "samples", "auto"), ("block", "block", "wrench")],
)
def test_every_live_status_is_replayed_value_by_value(
    bench: Bench,
    peer: Any,
    start_module: Callable[..., Any],
    tmp_path: Path,
    source: str,
    publish: str,
    load: str,
) -> None:
    parameters = tmp_path / "parameters.yaml"
    parameters.write_text(PARAMETERS.replace("SOURCE", source).replace("LOAD", load))
    sensor = TorqueSensor(peer)
    sources = list(split_joints(load_parameters(parameters))["joint"].sources.values())
    recorder = Recorder(peer, sources)
    start_module(MONITOR, "--ros-args", "--params-file", str(parameters))
    rig = start_module(RIG, *arguments_of((*RIG_PARAMETERS, f"publish:={publish}", f"time_scale:={PACES[publish]}")))

    # A publisher that has found a subscriber may not yet have been found by it. What it sends in that time comes later,
    # on one topic perhaps seconds later than on the other; the node then rightly gives up waiting, of which a recording
    # made elsewhere knows nothing. So the rig starts when monitor and recorder know all publishers.
    bench.until(recorder.matched, "the rig's publishers")
    bench.until_input(
        lambda s: s.values["reason"].count("but sends nothing") == len(sources), "a monitor that knows all publishers"
    )
    recorder.open_gate()

    def ended() -> bool:
        sensor.measure()
        recorder.drain()
        return "has ended" in rig.output

    bench.until(ended, "the end of the programme")
    bench.until(lambda: bench.inputs[-1].fault_code == "HD_INPUT_LOST", "the end of the data")
    recorder.drain()

    # What the node says by its own clock, before data came and after it ended, is of its inputs alone.
    pairs = list(zip(bench.statuses, bench.inputs, strict=True))
    live = [
        (plain(reducer), plain(inputs))
        for reducer, inputs in pairs
        if inputs.fault_code == "HD_INPUT_OK" and inputs.number("joint states") > 0
    ]
    with Bag(recorder.write(tmp_path / "bag")) as bag:
        plans = plan(bag, Request(parameters=load_parameters(parameters)))
        said = [(s.assessment, s.plan.joint) for s in replay(bag, plans)]
    replayed = [(plain(status_of(*one)), plain(input_status_of(*one))) for one in said]

    assert live[-1][0][3]["torque source"] == ("wrench" if load == "wrench" else "effort")
    assert len({reducer[3]["samples"] for reducer, _ in live}) >= 3, "too few different statuses to compare"
    # The node shows the newest assessment once a second, so that several may pass between two statuses: each shown
    # one must be among the replayed, in the same order.
    place = 0
    for status in live:
        assert status in replayed[place:], f"live status without its like from place {place} on: {status}"
        place = replayed.index(status, place)
    assert live[-1] == replayed[-1]

    level, message, serial, values = plain(bench.statuses[-1])
    assert (level, message, serial) == replayed[-1][0][:3], "the verdict did not outlive the end of the data"
    assert float(values["evidence age (s)"]) > 0.0
    assert {key: replayed[-1][0][3][key] for key in values} | {"evidence age (s)": values["evidence age (s)"]} == values

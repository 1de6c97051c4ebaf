"""Every path in the viewers' layouts leads to numbers in a recording of the demo."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from .conftest import QUICK, Bench

pytestmark = pytest.mark.ros

CONFIG = Path(__file__).resolve().parents[2] / "config"


def foxglove_paths() -> Iterator[str]:
    for panel in json.loads((CONFIG / "foxglove.json").read_text())["configById"].values():
        if "topicToRender" in panel:
            yield panel["topicToRender"] + ".status[:].level"
        yield from (path["value"] for path in panel.get("paths", []))
        if "xAxisPath" in panel:
            yield panel["xAxisPath"]["value"]


def plotjuggler_paths() -> Iterator[str]:
    """Yield the curves' names as message paths: PlotJuggler puts a slash before a field."""
    for curve in ElementTree.parse(CONFIG / "plotjuggler.xml").iter("curve"):
        topic, _, field = curve.attrib["name"].rpartition("/")
        yield f"{topic}.{field}"


def values_at(message: Any, path: str) -> list[Any]:
    """Follow a message path: fields, and slices whose last place is included."""
    found = [message]
    for field, first, last in re.findall(r"(\w+)(?:\[(\d*):(\d*)\])?", path):
        found = [getattr(one, field) for one in found]
        if f"{field}[" in path:
            found = [x for one in found for x in list(one)[int(first or 0) : int(last) + 1 if last else None]]
    return found


def record(bench: Bench, peer: Any, topics: set[str], folder: Path) -> None:
    """Record what the demo's nodes publish on some topics until each has come."""
    from diagnostic_msgs.msg import DiagnosticArray
    from rclpy.serialization import serialize_message
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore
    from std_msgs.msg import Float64, Float64MultiArray

    types = {"/diagnostics": DiagnosticArray, "/zoom_spectrum": Float64MultiArray}
    received = {topic: peer.collect(types.get(topic, Float64), topic, match=False) for topic in topics}
    bench.monitor()
    bench.rig("defect:=flexspline", *QUICK)
    bench.until(lambda: all(received.values()), "every topic of the layouts")
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic, messages in received.items():
            kind = types.get(topic, Float64)
            name = f"{kind.__module__.partition('.')[0]}/msg/{kind.__name__}"
            connection = writer.add_connection(topic, name, typestore=store)
            for number, message in enumerate(messages):
                writer.write(connection, number, serialize_message(message))


def test_every_path_leads_to_numbers(bench: Bench, peer: Any, tmp_path: Path) -> None:
    from rosbags.highlevel import AnyReader

    paths = [*foxglove_paths(), *plotjuggler_paths()]
    topics = {path.partition(".")[0] for path in paths}
    assert len(topics) == 6
    record(bench, peer, topics, tmp_path / "bag")
    with AnyReader([tmp_path / "bag"]) as reader:
        messages = {c.topic: reader.deserialize(data, c.msgtype) for c, _, data in reader.messages()}
    for path in paths:
        topic, _, fields = path.partition(".")
        values = values_at(messages[topic], fields)
        assert values, path
        assert all(isinstance(float(value), float) for value in values), path
    zoom = messages["/zoom_spectrum"]
    assert len(values_at(zoom, "data[0:49]")) == len(values_at(zoom, "data[50:99]")) == 50

"""Recordings for the tests: messages serialised and bags written by rosbags, an implementation apart from ours."""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

typesys = pytest.importorskip("rosbags.typesys")
rosbag2 = pytest.importorskip("rosbags.rosbag2")

STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
TYPES = STORE.types
MCAP, SQLITE = rosbag2.StoragePlugin.MCAP, rosbag2.StoragePlugin.SQLITE3
START = 1_700_000_000_000_000_000
"""Stamp of the first sample [ns]."""


class Event(NamedTuple):
    """A message to record: time of recording [ns], topic and message."""

    time: int
    topic: str
    message: Any


def header(stamp: int) -> Any:
    return TYPES["std_msgs/msg/Header"](TYPES["builtin_interfaces/msg/Time"](*divmod(stamp, 10**9)), "rig")


def joint_state(stamp: int, **joints: tuple[float, float, float]) -> Any:
    columns = np.array(list(joints.values()), dtype=np.float64).reshape(-1, 3).T
    return TYPES["sensor_msgs/msg/JointState"](header(stamp), list(joints), *(column.copy() for column in columns))


def joint_states(stamp: int, names: Sequence[str], *arrays: Sequence[float]) -> Any:
    columns = [np.array(array, dtype=np.float64) for array in arrays]
    return TYPES["sensor_msgs/msg/JointState"](header(stamp), list(names), *columns)


def block(stamp: int, period: float, sequence: int, samples: Any) -> Any:
    size = len(samples)
    dimension = TYPES["std_msgs/msg/MultiArrayDimension"]("torsional_acceleration", size, size)
    data = np.array([*divmod(stamp, 10**9), period, sequence, *samples])
    return TYPES["std_msgs/msg/Float64MultiArray"](TYPES["std_msgs/msg/MultiArrayLayout"]([dimension], 4), data)


def accel(stamp: int, angular: float) -> Any:
    vector = TYPES["geometry_msgs/msg/Vector3"]
    body = TYPES["geometry_msgs/msg/Accel"](vector(0.0, 0.55 * angular, 0.0), vector(0.0, 0.0, angular))
    return TYPES["geometry_msgs/msg/AccelStamped"](header(stamp), body)


def wrench(stamp: int, torque: float) -> Any:
    vector = TYPES["geometry_msgs/msg/Vector3"]
    body = TYPES["geometry_msgs/msg/Wrench"](vector(0.0, 0.0, 5.0), vector(torque, 0.3, -0.2))
    return TYPES["geometry_msgs/msg/WrenchStamped"](header(stamp), body)


def temperature(stamp: int, celsius: float) -> Any:
    return TYPES["sensor_msgs/msg/Temperature"](header(stamp), celsius, 0.0)


def imu(stamp: int, tangential: float) -> Any:
    vector, nine = TYPES["geometry_msgs/msg/Vector3"], np.zeros(9)
    orientation = TYPES["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    zero = vector(0.0, 0.0, 0.0)
    linear = vector(0.0, tangential, 9.81)
    return TYPES["sensor_msgs/msg/Imu"](header(stamp), orientation, nine, zero, nine, linear, nine)


def write(
    path: Path,
    events: Iterable[Event],
    *,
    storage: Any = MCAP,
    compression: str | None = None,
    silent: Sequence[tuple[str, str]] = (),
) -> Path:
    """Write a bag folder; `silent` are (topic, type) pairs without messages."""
    writer = rosbag2.Writer(path, version=9, storage_plugin=storage)
    if compression:
        writer.set_compression(rosbag2.CompressionMode[compression.upper()], rosbag2.CompressionFormat.ZSTD)
    with writer:
        connections: dict[str, Any] = {}
        for topic, kind in silent:
            writer.add_connection(topic, kind, typestore=STORE)
        for time, topic, message in sorted(events, key=lambda event: event.time):
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=STORE)
            writer.write(connections[topic], time, STORE.serialize_cdr(message, kind))
    return path


def small(seconds: float = 3.0) -> list[Event]:
    """Two topics with a known count of messages: 10 blocks and 100 joint states a second."""
    events = []
    for number in range(round(10 * seconds)):
        stamp = START + number * 100_000_000
        samples = np.sin(np.arange(100) + number)
        events.append(Event(stamp, "/torsional_acceleration/block", block(stamp, 1e-3, number, samples)))
    for number in range(round(100 * seconds)):
        stamp = START + number * 10_000_000
        events.append(Event(stamp, "/joint_states", joint_state(stamp, joint=(0.01 * number, 1.0, 10.0))))
    return events


def simulated(prefix: str = "", joint: str = "joint", start: int = START, **parameters: Any) -> list[Event]:
    """Everything that a simulated rig sends, each message recorded when it was sent."""
    from hd_sim_node.settings import RigSettings
    from hd_sim_node.simulation import Simulation

    given = {name.replace("__", "."): value for name, value in parameters.items()}
    rig = Simulation(RigSettings.from_mapping(given))
    return [event for stretch in rig for event in events_of(stretch, prefix=prefix, joint=joint, start=start)]


def events_of(stretch: Any, *, prefix: str = "", joint: str = "joint", start: int = START) -> list[Event]:
    """What a simulated rig sends in one stretch of its time, each message recorded when it was sent."""
    events = []
    for due, topic, row in stretch.schedule():
        if topic == "torsional_acceleration/block":
            b = stretch.blocks[row]
            message = block(start + b.stamp, b.period, b.sequence, b.samples)
        elif topic == "torsional_acceleration":
            message = accel(start + int(stretch.stamps[row]), float(stretch.samples[row]))
        else:
            j = stretch.joint
            columns = [column for column in (j.position, j.velocity, j.effort) if column is not None]
            values = [[float(column[row])] for column in columns] + [[]] * (3 - len(columns))
            message = joint_states(start + int(j.stamps[row]), [joint], *values)
        events.append(Event(start + due, f"{prefix}/{topic}", message))
    return events


def storage_file(folder: Path) -> Path:
    """Find the one storage file of a bag folder."""
    (file,) = (path for path in folder.iterdir() if path.name != "metadata.yaml")
    return file


Writer = Callable[..., Path]

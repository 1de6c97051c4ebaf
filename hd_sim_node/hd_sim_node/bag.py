"""The simulated rig straight into a rosbag2 bag: the node's messages without ROS and without waiting for a clock."""

import heapq
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rosbags.interfaces import Connection, Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer, WriterError
from rosbags.typesys import Stores, get_typestore

from hd_monitor import contract
from hd_monitor.cdr import record_layout
from hd_monitor.contract import NANOSECONDS
from hd_monitor.errors import HdMonitorError

from .imu import imu_readings
from .settings import RigSettings
from .simulation import Simulation, Stretch

STORAGES = {"mcap": StoragePlugin.MCAP, "sqlite3": StoragePlugin.SQLITE3}
COMPRESSIONS = {"none": CompressionMode.NONE, "file": CompressionMode.FILE, "message": CompressionMode.MESSAGE}

_STORE = get_typestore(Stores.ROS2_JAZZY)
_FOREVER = QosTime(sec=9_223_372_036, nsec=854_775_807)
_QOS = Qos(
    QosHistory.KEEP_LAST,
    10,
    QosReliability.RELIABLE,
    QosDurability.VOLATILE,
    _FOREVER,
    _FOREVER,
    QosLiveliness.AUTOMATIC,
    _FOREVER,
    False,
)


class BagError(HdMonitorError):
    """The bag cannot be written."""


class BagSummary(NamedTuple):
    """What has been written."""

    path: Path
    duration: float
    """Simulated time [s]."""
    messages: dict[str, int]
    """By topic."""


def write_bag(
    rigs: RigSettings | Sequence[RigSettings],
    path: str | Path,
    *,
    storage: str = "mcap",
    compression: str = "none",
    start: int = 0,
    namespace: str = "",
    progress: Callable[[float], object] | None = None,
) -> BagSummary:
    """Simulate one rig or several and write what the nodes would publish.

    Parameters
    ----------
    rigs : RigSettings or sequence of RigSettings
        A rig without an end runs through its programme once. Of several, each has its vibration topics below its
        joint's name, and all share ``joint_states``.
    path : path-like
        Folder to be made.
    storage : str
        ``'mcap'`` or ``'sqlite3'``.
    compression : str
        ``'none'``, ``'file'`` or ``'message'`` (Zstandard).
    start : int
        Stamp of the start [ns].
    namespace : str
        Stands before every topic.
    progress : callable, optional
        Called now and then with the fraction done.

    Returns
    -------
    BagSummary

    Raises
    ------
    BagError
        If the folder exists or cannot be written, or joints share a name.
    ParameterError
        If a rig is refused.
    """
    rigs = [rigs] if isinstance(rigs, RigSettings) else list(rigs)
    names = [rig["joint_states.name"] for rig in rigs]
    if len(set(names)) != len(names):
        raise BagError(f"joint_states.name is {' and '.join(names)}: several rigs need joints of different names")
    rigs = [_with_an_end(rig) for rig in rigs]
    below = [f"{name}/" if len(rigs) > 1 else "" for name in names]
    streams = [_Recorder(Simulation(rig), start, prefix) for rig, prefix in zip(rigs, below, strict=True)]
    end = max(rig.duration for rig in rigs)
    prefix = "/" + namespace.strip("/") + "/" if namespace.strip("/") else "/"
    try:
        writer = Writer(path, version=9, storage_plugin=STORAGES[storage])
        writer.set_compression(COMPRESSIONS[compression], CompressionFormat.ZSTD)
        with writer:
            connections: dict[str, Connection] = {}
            counts: dict[str, int] = {}
            for number, (due, topic, kind, data) in enumerate(heapq.merge(*streams, key=lambda message: message[0])):
                if topic not in connections:
                    connections[topic] = writer.add_connection(
                        prefix + topic, kind, typestore=_STORE, offered_qos_profiles=[_QOS]
                    )
                writer.write(connections[topic], start + due, data)
                counts[topic] = counts.get(topic, 0) + 1
                if progress is not None and number % 5000 == 0:
                    progress(due / NANOSECONDS / end)
    except (WriterError, OSError) as error:
        raise BagError(f"{path} cannot be written: {error}") from error
    return BagSummary(Path(path), end, {prefix + topic: count for topic, count in counts.items()})


def _with_an_end(rig: RigSettings) -> RigSettings:
    if math.isfinite(rig.duration):
        return rig
    return RigSettings.from_mapping({**rig.values, "duration": rig.programme.cycle_duration})


class _Recorder:
    """The messages of one rig, serialised, in the order of going out."""

    def __init__(self, simulation: Simulation, epoch: int, below: str) -> None:
        self._simulation = simulation
        self._epoch = epoch
        self._encoders = {topic: ENCODERS[topic](simulation.settings) for topic in simulation.topics}
        self._names = {t: t if t == contract.JOINT_STATES else below + t for t in simulation.topics}

    def __iter__(self) -> Iterator[tuple[int, str, str, bytes]]:
        """Yield (due [ns] since the start, topic, message type, message)."""
        for stretch in self._simulation:
            encoded = {topic: encoder.encode(stretch, self._epoch) for topic, encoder in self._encoders.items()}
            for due, topic, row in stretch.schedule():
                yield due, self._names[topic], self._encoders[topic].message_type, encoded[topic][row]


class _Encoder:
    """Serialises a stretch's messages of one topic at once: copies of one message with the values put in."""

    message_type = ""

    def __init__(self, settings: RigSettings) -> None:
        self._settings = settings

    def encode(self, stretch: Stretch, epoch: int) -> list[bytes]:
        """Return the messages, one a row."""
        raise NotImplementedError

    def _copies(self, message: Any, count: int) -> np.ndarray[Any, Any]:
        template = bytes(_STORE.serialize_cdr(message, self.message_type))
        return np.frombuffer(bytearray(template * count), dtype=record_layout(template, self.message_type))

    @staticmethod
    def _cut(rows: np.ndarray[Any, Any]) -> list[bytes]:
        length, joined = rows.dtype.itemsize, rows.tobytes()
        return [joined[at : at + length] for at in range(0, len(joined), length)]

    def _header(self) -> Any:
        stamp = _STORE.types["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
        frame = "" if self.message_type.endswith("JointState") else self._settings["sensor.frame_id"]
        return _STORE.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)

    @staticmethod
    def _vector(kind: str = "Vector3", **values: float) -> Any:
        return _STORE.types[f"geometry_msgs/msg/{kind}"](**(dict.fromkeys("xyz", 0.0) | values))


class _SampleEncoder(_Encoder):
    message_type = "geometry_msgs/msg/AccelStamped"

    def encode(self, stretch: Stretch, epoch: int) -> list[bytes]:
        accel = _STORE.types["geometry_msgs/msg/Accel"](linear=self._vector(), angular=self._vector())
        message = _STORE.types[self.message_type](header=self._header(), accel=accel)
        rows = self._copies(message, stretch.samples.size)
        rows["seconds"], rows["nanoseconds"] = divmod(stretch.stamps + epoch, NANOSECONDS)
        rows["angular"][:, 2] = stretch.samples
        rows["linear"][:, 1] = self._settings["sensor.radius"] * stretch.samples
        return self._cut(rows)


class _ImuEncoder(_Encoder):
    message_type = "sensor_msgs/msg/Imu"

    def encode(self, stretch: Stretch, epoch: int) -> list[bytes]:
        unknown, nothing = np.zeros(9), np.zeros(9)
        unknown[0] = -1.0
        message = _STORE.types[self.message_type](
            header=self._header(),
            orientation=self._vector("Quaternion", w=1.0),
            orientation_covariance=unknown,
            angular_velocity=self._vector(),
            angular_velocity_covariance=nothing,
            linear_acceleration=self._vector(),
            linear_acceleration_covariance=nothing,
        )
        settings = self._settings
        readings = imu_readings(
            stretch.motion,
            stretch.samples,
            radius=settings["sensor.radius"],
            axis=settings["sensor.imu_axis"],
            surroundings=settings.surroundings,
        )
        rows = self._copies(message, stretch.samples.size)
        rows["seconds"], rows["nanoseconds"] = divmod(stretch.stamps + epoch, NANOSECONDS)
        rows["linear"], rows["angular"] = readings
        return self._cut(rows)


class _JointEncoder(_Encoder):
    message_type = "sensor_msgs/msg/JointState"

    def encode(self, stretch: Stretch, epoch: int) -> list[bytes]:
        joint = stretch.joint
        if not len(joint):
            return []
        values = {name: getattr(joint, name) for name in ("position", "velocity", "effort")}
        message = _STORE.types[self.message_type](
            header=self._header(),
            name=[self._settings["joint_states.name"]],
            **{name: np.zeros(0 if value is None else 1) for name, value in values.items()},
        )
        rows = self._copies(message, len(joint))
        rows["seconds"], rows["nanoseconds"] = divmod(joint.stamps + epoch, NANOSECONDS)
        for name, value in values.items():
            if value is not None:
                rows[name][:, 0] = value
        return self._cut(rows)


class _BlockEncoder(_Encoder):
    message_type = "std_msgs/msg/Float64MultiArray"

    def encode(self, stretch: Stretch, epoch: int) -> list[bytes]:
        packed = [contract.pack_block(block._replace(stamp=block.stamp + epoch)) for block in stretch.blocks]
        dimension = _STORE.types["std_msgs/msg/MultiArrayDimension"](**packed[0][0]._asdict())
        layout = _STORE.types["std_msgs/msg/MultiArrayLayout"](dim=[dimension], data_offset=contract.BLOCK_OFFSET)
        message = _STORE.types[self.message_type](layout=layout, data=packed[0][1])
        rows = self._copies(message, len(packed))
        rows["data"] = [data for _, data in packed]
        return self._cut(rows)


ENCODERS: dict[str, type[_Encoder]] = {
    contract.TORSIONAL_ACCELERATION_BLOCK: _BlockEncoder,
    contract.TORSIONAL_ACCELERATION: _SampleEncoder,
    contract.IMU: _ImuEncoder,
    contract.JOINT_STATES: _JointEncoder,
}
"""By topic."""

"""The simulation's arrays as serialised messages: the same for the node and for a bag, a stretch at once."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from hd_monitor import contract
from hd_monitor.arrays import IntArray
from hd_monitor.cdr import record_layout
from hd_monitor.contract import NANOSECONDS

from .imu import imu_readings
from .settings import RigSettings
from .simulation import Stretch

MESSAGE_TYPES = {
    contract.TORSIONAL_ACCELERATION_BLOCK: "std_msgs/msg/Float64MultiArray",
    contract.TORSIONAL_ACCELERATION: "geometry_msgs/msg/AccelStamped",
    contract.IMU: "sensor_msgs/msg/Imu",
    contract.JOINT_STATES: "sensor_msgs/msg/JointState",
}
"""By topic."""


class Library(NamedTuple):
    """A library of ROS messages."""

    make: Callable[..., Any]
    """Makes a message of a type, as ``make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=1.0)``; arrays are numpy's."""
    serialise: Callable[[Any, str], bytes | memoryview]
    """Serialises a message of a type (CDR)."""


class Encoder:
    """Serialises a rig's messages: copies of one message a topic, into which numpy puts the values.

    Parameters
    ----------
    settings : RigSettings
    library : Library
    """

    def __init__(self, settings: RigSettings, library: Library) -> None:
        self._settings = settings
        self._library = library
        self._rows = {
            contract.TORSIONAL_ACCELERATION_BLOCK: self._blocks,
            contract.TORSIONAL_ACCELERATION: self._samples,
            contract.IMU: self._imu,
            contract.JOINT_STATES: self._joint_states,
        }

    def encode(self, stretch: Stretch, epoch: int) -> dict[str, list[bytes]]:
        """Serialise the messages of a stretch by topic, one a row; `epoch` [ns] is the stamp of the start."""
        encoded = {}
        for topic in stretch.dispatch:
            rows = self._rows[topic](stretch, epoch)
            length, joined = rows.dtype.itemsize, rows.tobytes()
            encoded[topic] = [joined[at : at + length] for at in range(0, len(joined), length)]
        return encoded

    def _samples(self, stretch: Stretch, epoch: int) -> np.ndarray[Any, Any]:
        accel = self._library.make("geometry_msgs/msg/Accel", linear=self._vector(), angular=self._vector())
        rows = self._copies(contract.TORSIONAL_ACCELERATION, stretch.stamps + epoch, accel=accel)
        rows["angular"][:, 2] = stretch.samples
        rows["linear"][:, 1] = self._settings.mounting.radius * stretch.samples
        return rows

    def _imu(self, stretch: Stretch, epoch: int) -> np.ndarray[Any, Any]:
        unknown = np.append(-1.0, np.zeros(8))  # REP-145: no orientation, gravity included
        rows = self._copies(
            contract.IMU,
            stretch.stamps + epoch,
            orientation=self._library.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0),
            orientation_covariance=unknown,
            angular_velocity=self._vector(),
            angular_velocity_covariance=np.zeros(9),
            linear_acceleration=self._vector(),
            linear_acceleration_covariance=np.zeros(9),
        )
        rows["linear"], rows["angular"] = imu_readings(
            stretch.motion,
            stretch.samples,
            radius=self._settings.mounting.radius,
            axis=self._settings.mounting.imu_axis,
            surroundings=self._settings.surroundings,
        )
        return rows

    def _joint_states(self, stretch: Stretch, epoch: int) -> np.ndarray[Any, Any]:
        values = {name: getattr(stretch.joint, name) for name in ("position", "velocity", "effort")}
        rows = self._copies(
            contract.JOINT_STATES,
            stretch.joint.stamps + epoch,
            name=[self._settings.joint.name],
            **{name: np.zeros(0 if value is None else 1) for name, value in values.items()},
        )
        for name, value in values.items():
            if value is not None:
                rows[name][:, 0] = value
        return rows

    def _blocks(self, stretch: Stretch, epoch: int) -> np.ndarray[Any, Any]:
        packed = [contract.pack_block(block._replace(stamp=block.stamp + epoch)) for block in stretch.blocks]
        dimension = self._library.make("std_msgs/msg/MultiArrayDimension", **packed[0][0]._asdict())
        layout = self._library.make("std_msgs/msg/MultiArrayLayout", dim=[dimension], data_offset=contract.BLOCK_OFFSET)
        rows = self._copies(contract.TORSIONAL_ACCELERATION_BLOCK, len(packed), layout=layout, data=packed[0][1])
        rows["data"] = [data for _, data in packed]
        return rows

    def _copies(self, topic: str, stamps: IntArray | int, **fields: Any) -> np.ndarray[Any, Any]:
        """Repeat a message once for each stamp [ns] of its header, or `stamps` times if it has none."""
        stamped, kind = not isinstance(stamps, int), MESSAGE_TYPES[topic]
        if stamped:
            stamp = self._library.make("builtin_interfaces/msg/Time", sec=0, nanosec=0)
            frame = "" if topic == contract.JOINT_STATES else self._settings.mounting.frame_id
            fields["header"] = self._library.make("std_msgs/msg/Header", stamp=stamp, frame_id=frame)
        template = bytes(self._library.serialise(self._library.make(kind, **fields), kind))
        layout, count = record_layout(template, kind), stamps if isinstance(stamps, int) else stamps.size
        rows = np.frombuffer(bytearray(template * count), dtype=layout)
        if stamped:
            rows["seconds"], rows["nanoseconds"] = divmod(stamps, NANOSECONDS)
        return rows

    def _vector(self) -> Any:
        return self._library.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)

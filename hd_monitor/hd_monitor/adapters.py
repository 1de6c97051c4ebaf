"""From serialised messages to a monitor's arrays: the one path of the node's and of replay's input.

An :class:`Inputs` knows which message types its joint listens to and what of each message belongs to the joint. Both
shells hand it the bytes as they come from the middleware or from a bag, so that they cannot differ in what they see.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from . import cdr, contract
from .arrays import FloatArray, IntArray
from .cdr_layout import Fault
from .errors import LayoutError, ParameterError
from .settings import JointSettings

UNNAMED_JOINT = "joint"
"""Name of a joint that the parameters do not name; it takes the only joint there is in joint_states."""

_AXES = {"x": 0, "y": 1, "z": 2}


class Sink(Protocol):
    """What an adapter feeds: the input side of :class:`hd_monitor.monitor.Monitor`."""

    def add_vibration(self, stamps: IntArray, values: FloatArray) -> None:
        """Take samples of θ'' [rad/s²] with their stamps [ns]."""

    def add_block(self, block: contract.Block) -> None:
        """Take a block of samples of θ'' [rad/s²]."""

    def add_motion(self, stamps: IntArray, position: FloatArray, velocity: FloatArray, effort: FloatArray) -> None:
        """Take joint states [rad, rad/s, N·m] with their stamps [ns]."""

    def reject(self, reason: str) -> None:
        """Count a message that says nothing, and remember why."""


class Source(NamedTuple):
    """A topic that a joint listens to: relative name and ROS message type, as ``package/Type``."""

    topic: str
    type: str


VIBRATION_SOURCES: Mapping[str, Source] = {
    "block": Source(contract.TORSIONAL_ACCELERATION_BLOCK, "std_msgs/Float64MultiArray"),
    "accel_stamped": Source(contract.TORSIONAL_ACCELERATION, "geometry_msgs/AccelStamped"),
    "imu": Source(contract.IMU, "sensor_msgs/Imu"),
}
"""Vibration topic of each ``input.source``; the sensorless sources have none besides the motion's."""

MOTION_SOURCE = Source(contract.JOINT_STATES, "sensor_msgs/JointState")


class Inputs:
    """The inputs of one joint, as serialised messages.

    Parameters
    ----------
    joint : str
        Name of the joint in the parameters.
    settings : JointSettings
    sink : Sink
        Usually the joint's monitor.

    Raises
    ------
    ParameterError
        If an IMU is the source and the radius at which it sits is 0.
    """

    def __init__(self, joint: str, settings: JointSettings, sink: Sink) -> None:
        self._sink = sink
        self._wanted = settings.input.joint_name
        self._joint = joint
        self._joint_seen = False
        axis = settings.input.axis
        self._axis, self._sign = _AXES[axis[-1]], -1.0 if axis.startswith("-") else 1.0
        self._radius = settings.input.sensor_radius
        self._source = settings.input.source
        if self._source == "imu" and self._radius <= 0.0:
            raise ParameterError(
                f"input.sensor_radius = {self._radius:g} m with input.source = 'imu': a tangential acceleration "
                "becomes an angular one by dividing by the radius; give the distance of the IMU from the joint's axis"
            )

    def add_vibration(self, messages: Sequence[bytes]) -> None:
        """Feed messages of the joint's vibration topic, in the order of their arrival."""
        if messages:
            self._decoders[self._source](self, messages)

    def add_motion(self, messages: Sequence[bytes]) -> None:
        """Feed serialised JointState messages, in the order of their arrival."""
        groups, faults = cdr.decode_joint_states(messages)
        if len(groups) == 1 and not faults and (column := self._column(groups[0].names)) is not None:
            group = groups[0]
            self._joint_seen = True
            self._sink.add_motion(
                group.stamps, group.position[:, column], group.velocity[:, column], group.effort[:, column]
            )
            return
        self._add_mixed_motion(groups, faults, len(messages))

    def _add_mixed_motion(self, groups: list[cdr.JointStates], faults: list[Fault], total: int) -> None:
        columns = [self._column(group.names) for group in groups]
        mine = np.zeros(total, dtype=np.bool_)
        stamps = np.zeros(total, dtype=np.int64)
        values = np.empty((3, total))
        for group, column in zip(groups, columns, strict=True):
            if column is not None:
                mine[group.place] = True
                stamps[group.place] = group.stamps
                for row, array in zip(values, (group.position, group.velocity, group.effort), strict=True):
                    row[group.place] = array[:, column]
        # Several publishers may share the topic, each with its own joints: the others' messages are no fault. They
        # are as long as the joint has not been seen at all, since its name may be misspelt.
        first = int(np.flatnonzero(mine)[0]) if mine.any() else total
        strangers = [
            Fault(place, self._absent(group.names))
            for group, column in zip(groups, columns, strict=True)
            if column is None and not self._joint_seen
            for place in group.place.tolist()
            if place < first
        ]
        for fault in sorted(faults + strangers):
            self._sink.reject(fault.reason)
        if mine.any():
            self._joint_seen = True
            self._sink.add_motion(stamps[mine], values[0][mine], values[1][mine], values[2][mine])

    def _column(self, names: tuple[str, ...]) -> int | None:
        wanted = self._wanted or self._joint
        if wanted in names:
            return names.index(wanted)
        if not self._wanted and self._joint == UNNAMED_JOINT and len(names) == 1:
            return 0
        return None

    def _absent(self, names: tuple[str, ...]) -> str:
        there = ", ".join(names) if names else "no joint at all"
        if not self._wanted and self._joint == UNNAMED_JOINT:
            return f"joint_states carries {there}; set input.joint_name (or joints) to the one to watch"
        wanted = self._wanted or self._joint
        return f"joint {wanted!r} is not in joint_states, which carries {there}; check the name"

    def _add_accel_stamped(self, messages: Sequence[bytes]) -> None:
        samples = cdr.decode_accel_stamped(messages)
        self._add_samples(samples, samples.angular[:, 2])

    def _add_imu(self, messages: Sequence[bytes]) -> None:
        samples = cdr.decode_imu(messages)
        self._add_samples(samples, samples.linear[:, self._axis] * (self._sign / self._radius))

    def _add_samples(self, samples: cdr.Samples, values: FloatArray) -> None:
        for reason in samples.faults:
            self._sink.reject(reason)
        if samples.stamps.size:
            self._sink.add_vibration(samples.stamps, np.ascontiguousarray(values))

    def _add_blocks(self, messages: Sequence[bytes]) -> None:
        for item in _in_order(*cdr.decode_multi_arrays(messages)):
            if isinstance(item, str):
                self._sink.reject(item)
            else:
                self._sink.add_block(item)

    _decoders: Mapping[str, Callable[["Inputs", Sequence[bytes]], None]] = {
        "block": _add_blocks,
        "accel_stamped": _add_accel_stamped,
        "imu": _add_imu,
    }


def _in_order(groups: list[cdr.MultiArrays], faults: list[Fault]) -> Iterator[contract.Block | str]:
    """Yield the blocks, and what is wrong with those that are none, in the order of the messages."""
    items: list[tuple[int, contract.Block | str]] = list(faults)
    for group in groups:
        places = group.place.tolist()
        try:
            blocks = contract.unpack_blocks(group.dimensions, group.data_offset, group.data)
        except LayoutError as error:
            items.extend((place, str(error)) for place in places)
            continue
        items.extend(
            (place, str(block) if isinstance(block, LayoutError) else block)
            for place, block in zip(places, blocks, strict=True)
        )
    if len(groups) > 1 or faults:
        items.sort(key=lambda item: item[0])
    for _, item in items:
        yield item

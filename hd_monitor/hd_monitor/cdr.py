"""Bulk decoding of serialised (CDR) messages into arrays, without an object per message.

Messages of one topic nearly always have the same layout: the same frame name, the same joints, the same block length.
So one message is parsed as a template, and all others of its length whose layout bytes agree with it are read by
numpy at once; whatever differs becomes the next template. A message that cannot be read becomes a fault and does not
affect the batch.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import FloatArray, IntArray
from .cdr_layout import Fault, Layout, Template, groups_of
from .contract import NANOSECONDS, Dimension
from .errors import LayoutError


class Samples(NamedTuple):
    """Stamped vectors, one row a message."""

    stamps: IntArray
    """Header stamps [ns], shape (N,)."""
    linear: FloatArray
    """Linear acceleration [m/s²], or force [N] of a WrenchStamped; shape (N, 3)."""
    angular: FloatArray
    """Angular acceleration [rad/s²] of an AccelStamped, angular velocity [rad/s] of an Imu, torque [N·m] of a
    WrenchStamped; shape (N, 3)."""
    faults: tuple[str, ...]
    """The reason for each message that could not be read."""


class JointStates(NamedTuple):
    """Consecutive JointState messages with the same joints; NaN where a message carries no such array."""

    place: IntArray
    """Positions of the messages in the batch, rising, shape (N,)."""
    names: tuple[str, ...]
    stamps: IntArray
    """Header stamps [ns], shape (N,)."""
    position: FloatArray
    """Position [rad], shape (N, joints)."""
    velocity: FloatArray
    """Velocity [rad/s], shape (N, joints)."""
    effort: FloatArray
    """Effort [N·m], shape (N, joints)."""


class MultiArrays(NamedTuple):
    """Float64MultiArray messages with the same layout."""

    place: IntArray
    """Positions of the messages in the batch, rising, shape (N,)."""
    dimensions: tuple[Dimension, ...]
    data_offset: int
    data: FloatArray
    """Shape (N, values)."""


class ReceivedStatus(NamedTuple):
    """A diagnostic_msgs/DiagnosticStatus."""

    name: str
    level: int
    """0 OK, 1 WARN, 2 ERROR, 3 STALE."""
    message: str
    hardware_id: str
    values: Mapping[str, str]
    """By key; of a repeated key the last one."""


class Diagnostics(NamedTuple):
    """A diagnostic_msgs/DiagnosticArray."""

    stamp: int
    """Header stamp [ns]."""
    statuses: tuple[ReceivedStatus, ...]


def _stamps(rows: npt.NDArray[np.void]) -> IntArray:
    return rows["seconds"].astype(np.int64) * NANOSECONDS + rows["nanoseconds"].astype(np.int64)


def _parse_vectors(message: bytes) -> Layout[None]:
    template = Template(message)
    template.stamp()
    template.doubles("linear", 3)
    template.doubles("angular", 3)
    return template.layout(None)


def _parse_imu(message: bytes) -> Layout[None]:
    template = Template(message)
    template.stamp()
    template.doubles("orientation, covariance", 4 + 9)
    template.doubles("angular", 3)
    template.doubles("angular covariance", 9)
    template.doubles("linear", 3)
    template.doubles("linear covariance", 9)
    return template.layout(None)


def _parse_temperature(message: bytes) -> Layout[None]:
    template = Template(message)
    template.stamp()
    template.doubles("temperature", 1)
    template.doubles("variance", 1)
    return template.layout(None)


def _parse_joint_state(message: bytes) -> Layout[tuple[str, ...]]:
    template = Template(message)
    template.stamp()
    count = template.count()
    if count > len(message):
        raise LayoutError(f"a joint state announces {count} joints; it is damaged or of another type")
    names = tuple(template.text(decisive=True) for _ in range(count))
    for name in ("position", "velocity", "effort"):
        values = template.count()
        if values not in (0, count):
            raise LayoutError(
                f"a joint state has {count} names but {values} values of {name}; it must have one per joint, or none"
            )
        template.doubles(name, values)
    return template.layout(names)


def _parse_multi_array(message: bytes) -> Layout[tuple[tuple[Dimension, ...], int]]:
    template = Template(message)
    count = template.count()
    if count > len(message):
        raise LayoutError(f"an array announces {count} dimensions; it is damaged or of another type")
    dimensions = tuple(
        Dimension(template.text(decisive=True), template.count(), template.count()) for _ in range(count)
    )
    offset = template.count()
    template.doubles("data", template.count())
    return template.layout((dimensions, offset))


def _samples(messages: Sequence[bytes], parse: Callable[[bytes], Layout[None]]) -> Samples:
    faults: list[Fault] = []
    total = len(messages)
    stamps = np.zeros(total, dtype=np.int64)
    linear, angular = np.empty((total, 3)), np.empty((total, 3))
    good = np.zeros(total, dtype=np.bool_)
    for place, rows, _ in groups_of(messages, parse, faults):
        good[place] = True
        stamps[place] = _stamps(rows)
        linear[place], angular[place] = rows["linear"], rows["angular"]
    reasons = tuple(fault.reason for fault in sorted(faults))
    return Samples(stamps[good], linear[good], angular[good], reasons)


def decode_vectors(messages: Sequence[bytes]) -> Samples:
    """Decode serialised ``geometry_msgs/AccelStamped`` or ``WrenchStamped`` messages, in their order.

    Parameters
    ----------
    messages : sequence of bytes
        Messages with their 4-byte CDR header, of either byte order.

    Returns
    -------
    Samples
        Unreadable messages are left out of the arrays and listed in `faults`.
    """
    return _samples(messages, _parse_vectors)


def decode_imu(messages: Sequence[bytes]) -> Samples:
    """Decode serialised ``sensor_msgs/Imu`` messages, in their order; see :func:`decode_vectors`."""
    return _samples(messages, _parse_imu)


def decode_temperatures(messages: Sequence[bytes]) -> tuple[IntArray, FloatArray, tuple[str, ...]]:
    """Decode serialised ``sensor_msgs/Temperature`` messages, in their order.

    Returns
    -------
    stamps, values : ndarray, shape (N,)
        Header stamps [ns] and temperatures [°C].
    faults : tuple of str
        The reason for each message that could not be read.
    """
    faults: list[Fault] = []
    readings = sorted(
        (at, stamp, value)
        for place, rows, _ in groups_of(messages, _parse_temperature, faults)
        for at, stamp, value in zip(
            place.tolist(), _stamps(rows).tolist(), rows["temperature"][:, 0].tolist(), strict=True
        )
    )
    stamps = np.array([stamp for _, stamp, _ in readings], dtype=np.int64)
    values = np.array([value for _, _, value in readings], dtype=np.float64)
    return stamps, values, tuple(fault.reason for fault in sorted(faults))


def decode_joint_states(messages: Sequence[bytes]) -> tuple[list[JointStates], list[Fault]]:
    """Decode serialised ``sensor_msgs/JointState`` messages.

    Parameters
    ----------
    messages : sequence of bytes
        Messages with their 4-byte CDR header, of either byte order.

    Returns
    -------
    groups : list of JointStates
        One for each set of joint names (and arrays present); their `place` gives the messages' order.
    faults : list of Fault
        The messages that could not be read.
    """
    faults: list[Fault] = []
    groups = []
    for place, rows, names in groups_of(messages, _parse_joint_state, faults):
        arrays = []
        for name in ("position", "velocity", "effort"):
            values = rows[name].astype(np.float64)
            arrays.append(values if values.shape[1] == len(names) else np.full((len(rows), len(names)), np.nan))
        groups.append(JointStates(place, names, _stamps(rows), *arrays))
    return groups, sorted(faults)


def decode_multi_arrays(messages: Sequence[bytes]) -> tuple[list[MultiArrays], list[Fault]]:
    """Decode serialised ``std_msgs/Float64MultiArray`` messages; see :func:`decode_joint_states`."""
    faults: list[Fault] = []
    groups = [
        MultiArrays(place, dimensions, offset, rows["data"].astype(np.float64))
        for place, rows, (dimensions, offset) in groups_of(messages, _parse_multi_array, faults)
    ]
    return groups, sorted(faults)


def decode_diagnostics(message: bytes) -> Diagnostics:
    """Decode a serialised ``diagnostic_msgs/DiagnosticArray``, of which no two are alike.

    Raises
    ------
    LayoutError
        If the message ends before its contents do, or is not plain CDR.
    """
    template = Template(message)
    stamp = template.time()
    statuses = []
    for _ in range(template.count()):
        level, name, text, hardware_id = template.byte(), template.text(), template.text(), template.text()
        values = {template.text(): template.text() for _ in range(template.count())}
        statuses.append(ReceivedStatus(name, level, text, hardware_id, values))
    return Diagnostics(stamp, tuple(statuses))

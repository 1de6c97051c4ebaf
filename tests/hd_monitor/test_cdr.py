"""Bulk decoding gives, message for message, what an independent CDR implementation (rosbags) wrote."""

import contextlib
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor import cdr
from hd_monitor.errors import LayoutError

typesys = pytest.importorskip("rosbags.typesys")
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
T = STORE.types

frames = st.text(max_size=12).filter(lambda text: "\0" not in text)
seconds = st.integers(0, 2**31 - 1)
nanoseconds = st.integers(0, 999_999_999)
doubles = st.floats(allow_nan=True, allow_infinity=True)
headers = st.tuples(seconds, nanoseconds, frames)
triples = st.tuples(doubles, doubles, doubles)


def header(sec: int, nanosec: int, frame: str) -> Any:
    return T["std_msgs/msg/Header"](T["builtin_interfaces/msg/Time"](sec, nanosec), frame)


def vector(values: tuple[float, float, float]) -> Any:
    return T["geometry_msgs/msg/Vector3"](*values)


def raw(message: Any, kind: str, *, little_endian: bool = True) -> bytes:
    return bytes(STORE.serialize_cdr(message, kind, little_endian=little_endian))


def accel(head: tuple[int, int, str], linear: Any, angular: Any, *, little_endian: bool = True) -> bytes:
    body = T["geometry_msgs/msg/Accel"](vector(linear), vector(angular))
    message = T["geometry_msgs/msg/AccelStamped"](header(*head), body)
    return raw(message, "geometry_msgs/msg/AccelStamped", little_endian=little_endian)


def wrench(head: tuple[int, int, str], force: Any, torque: Any, *, little_endian: bool = True) -> bytes:
    body = T["geometry_msgs/msg/Wrench"](vector(force), vector(torque))
    message = T["geometry_msgs/msg/WrenchStamped"](header(*head), body)
    return raw(message, "geometry_msgs/msg/WrenchStamped", little_endian=little_endian)


def imu(head: tuple[int, int, str], linear: Any, angular: Any, *, little_endian: bool = True) -> bytes:
    covariance = np.arange(9.0)
    message = T["sensor_msgs/msg/Imu"](
        header(*head),
        T["geometry_msgs/msg/Quaternion"](0.1, 0.2, 0.3, 0.4),
        covariance,
        vector(angular),
        covariance,
        vector(linear),
        covariance,
    )
    return raw(message, "sensor_msgs/msg/Imu", little_endian=little_endian)


def temperature(head: tuple[int, int, str], value: float, *, little_endian: bool = True) -> bytes:
    message = T["sensor_msgs/msg/Temperature"](header(*head), value, 0.25)
    return raw(message, "sensor_msgs/msg/Temperature", little_endian=little_endian)


def joint_state(
    head: tuple[int, int, str], names: list[str], arrays: list[list[float]], *, little_endian: bool = True
) -> bytes:
    values = [np.array(array, dtype=np.float64) for array in arrays]
    message = T["sensor_msgs/msg/JointState"](header(*head), names, *values)
    return raw(message, "sensor_msgs/msg/JointState", little_endian=little_endian)


def multi_array(
    dimensions: list[tuple[str, int, int]], offset: int, data: list[float], *, little_endian: bool = True
) -> bytes:
    dims = [T["std_msgs/msg/MultiArrayDimension"](*dimension) for dimension in dimensions]
    layout = T["std_msgs/msg/MultiArrayLayout"](dims, offset)
    message = T["std_msgs/msg/Float64MultiArray"](layout, np.array(data, dtype=np.float64))
    return raw(message, "std_msgs/msg/Float64MultiArray", little_endian=little_endian)


def stamp(head: tuple[int, int, str]) -> int:
    return head[0] * 1_000_000_000 + head[1]


@pytest.mark.parametrize(
    ("write", "read"), [(accel, cdr.decode_vectors), (wrench, cdr.decode_vectors), (imu, cdr.decode_imu)]
)
@settings(max_examples=60)
@given(rows=st.lists(st.tuples(headers, triples, triples, st.booleans()), max_size=8))
def test_vectors_keep_their_order_for_mixed_frames_and_byte_orders(write: Any, read: Any, rows: list[Any]) -> None:
    samples = read([write(head, linear, angular, little_endian=little) for head, linear, angular, little in rows])
    assert samples.faults == ()
    assert samples.stamps.tolist() == [stamp(head) for head, *_ in rows]
    np.testing.assert_array_equal(samples.linear, np.array([row[1] for row in rows]).reshape(-1, 3))
    np.testing.assert_array_equal(samples.angular, np.array([row[2] for row in rows]).reshape(-1, 3))


@settings(max_examples=60)
@given(rows=st.lists(st.tuples(headers, doubles, st.booleans()), max_size=8))
def test_temperatures_keep_their_order_for_mixed_frames_and_byte_orders(rows: list[Any]) -> None:
    messages = [temperature(head, value, little_endian=little) for head, value, little in rows]
    stamps, values, faults = cdr.decode_temperatures([*messages, *(message[:-1] for message in messages[:1])])
    assert len(faults) == len(messages[:1])
    assert stamps.tolist() == [stamp(head) for head, *_ in rows]
    np.testing.assert_array_equal(values, np.array([row[1] for row in rows]))


@st.composite
def states(draw: st.DrawFn) -> tuple[Any, list[str], list[list[float]], bool]:
    names = draw(st.lists(st.sampled_from(["a", "elbow", "wrist_1_joint", "ä", ""]), max_size=3, unique=True))
    arrays = [
        draw(st.lists(doubles, min_size=len(names), max_size=len(names))) if draw(st.booleans()) else []
        for _ in range(3)
    ]
    return draw(headers), names, arrays, draw(st.booleans())


@settings(max_examples=80)
@given(rows=st.lists(states(), max_size=8))
def test_joint_states_come_back_by_name_with_nan_for_absent_arrays(rows: list[Any]) -> None:
    messages = [joint_state(head, names, arrays, little_endian=little) for head, names, arrays, little in rows]
    groups, faults = cdr.decode_joint_states(messages)
    assert faults == []
    assert sorted(place for group in groups for place in group.place.tolist()) == list(range(len(rows)))
    for group in groups:
        assert group.place.tolist() == sorted(group.place.tolist())
        for row, place in enumerate(group.place.tolist()):
            head, names, arrays, _ = rows[place]
            assert group.names == tuple(names)
            assert group.stamps[row] == stamp(head)
            for got, given_values in zip((group.position, group.velocity, group.effort), arrays, strict=True):
                expected = given_values or [math.nan] * len(names)
                np.testing.assert_array_equal(got[row], expected)


@settings(max_examples=60)
@given(
    rows=st.lists(
        st.tuples(
            st.lists(st.tuples(st.sampled_from(["torsional_acceleration", "bin", "x"]), seconds, seconds), max_size=2),
            st.integers(0, 9),
            st.lists(doubles, max_size=6),
            st.booleans(),
        ),
        max_size=6,
    )
)
def test_multi_arrays_come_back_with_their_layout(rows: list[Any]) -> None:
    messages = [multi_array(dims, offset, data, little_endian=little) for dims, offset, data, little in rows]
    groups, faults = cdr.decode_multi_arrays(messages)
    assert faults == []
    seen = {}
    for group in groups:
        for row, place in enumerate(group.place.tolist()):
            seen[place] = ([tuple(d) for d in group.dimensions], group.data_offset, group.data[row])
    assert sorted(seen) == list(range(len(rows)))
    for place, (dims, offset, data, _) in enumerate(rows):
        assert seen[place][:2] == (dims, offset)
        np.testing.assert_array_equal(seen[place][2], data)


texts = st.text(max_size=12).filter(lambda text: "\0" not in text)
statuses = st.tuples(st.integers(0, 3), texts, texts, texts, st.dictionaries(texts, texts, max_size=4))


@settings(max_examples=60)
@given(head=headers, rows=st.lists(statuses, max_size=4), little_endian=st.booleans())
def test_diagnostics_come_back_with_every_key(head: Any, rows: list[Any], little_endian: bool) -> None:
    pair = T["diagnostic_msgs/msg/KeyValue"]
    written = [
        T["diagnostic_msgs/msg/DiagnosticStatus"](*texts, [pair(key, value) for key, value in values.items()])
        for *texts, values in rows
    ]
    message = T["diagnostic_msgs/msg/DiagnosticArray"](header(*head), written)
    read = cdr.decode_diagnostics(raw(message, "diagnostic_msgs/msg/DiagnosticArray", little_endian=little_endian))
    assert read.stamp == stamp(head)
    found = [(s.level, s.name, s.message, s.hardware_id, s.values) for s in read.statuses]
    assert found == rows


@settings(max_examples=200)
@given(noise=st.binary(max_size=120))
def test_diagnostics_of_noise_are_an_error_of_the_layout(noise: bytes) -> None:
    with contextlib.suppress(LayoutError):
        cdr.decode_diagnostics(noise)


def test_a_truncated_message_is_a_fault_and_spoils_no_other() -> None:
    head = (5, 6, "sensor")
    writers: list[tuple[bytes, Any]] = [
        (accel(head, (1, 2, 3), (4, 5, 6)), cdr.decode_vectors),
        (wrench(head, (1, 2, 3), (4, 5, 6)), cdr.decode_vectors),
        (imu(head, (1, 2, 3), (4, 5, 6)), cdr.decode_imu),
    ]
    for whole, decode in writers:
        for length in range(len(whole)):
            samples = decode([whole, whole[:length], whole])
            assert samples.stamps.tolist() == [5_000_000_006] * 2
            assert len(samples.faults) == 1
    state = joint_state(head, ["a", "b"], [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
    block = multi_array([("torsional_acceleration", 2, 2)], 4, [5.0, 6.0, 0.001, 0.0, 1.0, 2.0])
    for message, decode in ((state, cdr.decode_joint_states), (block, cdr.decode_multi_arrays)):
        for length in range(len(message)):
            groups, faults = decode([message, message[:length], message])
            assert [fault.place for fault in faults] == [1], length
            assert np.concatenate([group.place for group in groups]).tolist() == [0, 2]


@settings(max_examples=200)
@given(noise=st.binary(max_size=120))
def test_noise_is_never_more_than_a_fault(noise: bytes) -> None:
    for message in (noise, b"\0\1\0\0" + noise):
        for decode in (cdr.decode_vectors, cdr.decode_imu, cdr.decode_joint_states, cdr.decode_multi_arrays):
            decode([message])


def test_arrays_of_another_length_than_the_names_are_a_fault() -> None:
    good = joint_state((1, 0, ""), ["a", "b"], [[1.0, 2.0], [], []])
    bad = joint_state((2, 0, ""), ["a", "b"], [[1.0], [], []])
    groups, faults = cdr.decode_joint_states([good, bad])
    assert [group.stamps.tolist() for group in groups] == [[1_000_000_000]]
    assert [fault.place for fault in faults] == [1]
    assert "2 names but 1 values of position" in faults[0].reason


def test_no_messages_give_empty_arrays() -> None:
    assert cdr.decode_vectors([]).stamps.shape == (0,)
    assert cdr.decode_vectors([]).linear.shape == (0, 3)
    assert cdr.decode_joint_states([]) == ([], [])
    assert cdr.decode_multi_arrays([]) == ([], [])


@pytest.mark.ros
def test_messages_of_the_middleware_are_read() -> None:
    from geometry_msgs.msg import AccelStamped, WrenchStamped
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import JointState

    message = AccelStamped()
    message.header.stamp.sec, message.header.stamp.nanosec, message.header.frame_id = 7, 8, "rig"
    message.accel.angular.z, message.accel.linear.y = -2.5, 0.5
    samples = cdr.decode_vectors([serialize_message(message)])
    assert samples.faults == ()
    assert (samples.stamps[0], samples.angular[0, 2], samples.linear[0, 1]) == (7_000_000_008, -2.5, 0.5)
    load = WrenchStamped(header=message.header)
    load.wrench.torque.z, load.wrench.force.y = -3.5, 1.5
    samples = cdr.decode_vectors([serialize_message(load)])
    assert (samples.stamps[0], samples.angular[0, 2], samples.linear[0, 1]) == (7_000_000_008, -3.5, 1.5)

    state = JointState(name=["a", "bc"], velocity=[1.0, 2.0])
    groups, faults = cdr.decode_joint_states([serialize_message(state)])
    assert faults == []
    assert groups[0].names == ("a", "bc")
    assert groups[0].velocity.tolist() == [[1.0, 2.0]]
    assert np.isnan(groups[0].position).all()

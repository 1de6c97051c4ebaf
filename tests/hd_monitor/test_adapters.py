"""Each joint gets its own part of what the topics carry, and complaints instead of crashes."""

from typing import Any

import numpy as np
import pytest

from hd_monitor import adapters
from hd_monitor.adapters import Inputs
from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import Block
from hd_monitor.errors import ParameterError
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

typesys = pytest.importorskip("rosbags.typesys")
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
T = STORE.types


def header(stamp: int) -> Any:
    return T["std_msgs/msg/Header"](T["builtin_interfaces/msg/Time"](*divmod(stamp, 10**9)), "rig")


def joint_state(stamp: int, **positions: float) -> bytes:
    count = len(positions)
    arrays = (np.array(list(positions.values())), np.full(count, 2.0), np.full(count, 3.0))
    message = T["sensor_msgs/msg/JointState"](header(stamp), list(positions), *arrays)
    return bytes(STORE.serialize_cdr(message, message.__msgtype__))


def block(stamp: int, samples: list[float], *, label: str = "torsional_acceleration", sequence: float = 0.0) -> bytes:
    size = len(samples)
    dimension = T["std_msgs/msg/MultiArrayDimension"](label, size, size)
    data = np.array([*divmod(stamp, 10**9), 0.001, sequence, *samples])
    message = T["std_msgs/msg/Float64MultiArray"](T["std_msgs/msg/MultiArrayLayout"]([dimension], 4), data)
    return bytes(STORE.serialize_cdr(message, message.__msgtype__))


def imu(stamp: int, linear: tuple[float, float, float]) -> bytes:
    vector = T["geometry_msgs/msg/Vector3"]
    nine = np.zeros(9)
    message = T["sensor_msgs/msg/Imu"](
        header(stamp),
        T["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
        nine,
        vector(0.0, 0.0, 0.0),
        nine,
        vector(*linear),
        nine,
    )
    return bytes(STORE.serialize_cdr(message, message.__msgtype__))


def wrench(stamp: int, torque: tuple[float, float, float]) -> bytes:
    vector = T["geometry_msgs/msg/Vector3"]
    body = T["geometry_msgs/msg/Wrench"](vector(7.0, 8.0, 9.0), vector(*torque))
    message = T["geometry_msgs/msg/WrenchStamped"](header(stamp), body)
    return bytes(STORE.serialize_cdr(message, message.__msgtype__))


class Recorder:
    """A sink that keeps everything."""

    def __init__(self) -> None:
        self.vibration: list[tuple[int, float]] = []
        self.blocks: list[Block] = []
        self.motion: list[tuple[int, float, float, float]] = []
        self.torque: list[tuple[int, float]] = []
        self.rejected: list[str] = []

    def add(self, quantity: Quantity, stamps: IntArray, *columns: FloatArray) -> None:
        kept: list[Any] = getattr(self, quantity)
        kept += zip(stamps.tolist(), *(column.tolist() for column in columns), strict=True)

    def add_block(self, block: Block) -> None:
        self.blocks.append(block)

    def reject(self, reason: str) -> None:
        self.rejected.append(reason)


def inputs(joint: str = "joint", **parameters: Any) -> tuple[Inputs, Recorder]:
    sink = Recorder()
    given = {name.replace("__", "."): value for name, value in parameters.items()}
    return Inputs(joint, JointSettings.from_mapping(given), sink), sink


def test_an_unnamed_joint_takes_the_only_one() -> None:
    feed, sink = inputs()
    feed.add(Quantity.MOTION, [joint_state(1, elbow=0.5), joint_state(2, elbow=0.6)])
    assert sink.motion == [(1, 0.5, 2.0, 3.0), (2, 0.6, 2.0, 3.0)]
    assert sink.rejected == []


def test_an_unnamed_joint_among_several_is_rejected() -> None:
    feed, sink = inputs()
    feed.add(Quantity.MOTION, [joint_state(1, elbow=0.5, wrist=0.6)])
    assert sink.motion == []
    assert "elbow, wrist" in sink.rejected[0]
    assert "input.joint_name" in sink.rejected[0]


def test_a_named_joint_is_taken_from_among_several_whatever_their_order() -> None:
    feed, sink = inputs("wrist")
    feed.add(Quantity.MOTION, [joint_state(1, elbow=0.5, wrist=0.6), joint_state(2, wrist=0.7, elbow=0.8)])
    assert [row[:2] for row in sink.motion] == [(1, 0.6), (2, 0.7)]


def test_input_joint_name_overrides_the_joints_own_name() -> None:
    feed, sink = inputs("wrist", input__joint_name="arm_wrist")
    feed.add(Quantity.MOTION, [joint_state(1, wrist=0.5, arm_wrist=0.6)])
    assert sink.motion[0][:2] == (1, 0.6)


def test_a_misspelt_joint_is_reported_with_the_names_there_are() -> None:
    feed, sink = inputs("elbwo")
    feed.add(Quantity.MOTION, [joint_state(1, elbow=0.5)])
    assert sink.motion == []
    assert "'elbwo' is not in joint_states, which carries elbow" in sink.rejected[0]


def test_messages_of_other_publishers_are_accepted_once_the_joint_is_seen() -> None:
    messages = [joint_state(1, gripper=9.0), joint_state(2, elbow=0.5), joint_state(3, gripper=9.0)]
    for batches in ([messages], [[m] for m in messages], [messages[:2], messages[2:]]):
        feed, sink = inputs("elbow")
        for batch in batches:
            feed.add(Quantity.MOTION, batch)
        assert [row[:2] for row in sink.motion] == [(2, 0.5)]
        assert len(sink.rejected) == 1


def test_blocks_come_in_order_and_wrong_layouts_are_reported() -> None:
    feed, sink = inputs()
    feed.add(
        Quantity.VIBRATION,
        [
            block(1, [1.0, 2.0]),
            block(2, [3.0], sequence=1),
            block(3, [4.0, 5.0], label="torque"),
            b"\0\1\0\0",
            block(4, [6.0, 7.0], sequence=2),
        ],
    )
    assert [b.stamp for b in sink.blocks] == [1, 2, 4]
    assert [b.samples.tolist() for b in sink.blocks] == [[1.0, 2.0], [3.0], [6.0, 7.0]]
    assert "labelled 'torque'" in sink.rejected[0]
    assert len(sink.rejected) == 2


def test_a_message_of_many_megabytes_is_refused_unread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(adapters, "LARGEST_MESSAGE", 1000)
    feed, sink = inputs()
    small, large = block(5, [1.0, 2.0]), block(6, [0.0] * 1000)
    feed.add(Quantity.VIBRATION, [large, small, large])
    assert [b.samples.tolist() for b in sink.blocks] == [[1.0, 2.0]]
    assert sink.rejected == 2 * ["a message of 0.0 MB; more than 0.001 MB are not read"]


@pytest.mark.parametrize(("axis", "expected"), [("x", 2.0), ("y", 4.0), ("-z", -6.0)])
def test_an_imus_tangential_axis_becomes_angular_by_its_radius(axis: str, expected: float) -> None:
    feed, sink = inputs(input__source="imu", input__axis=axis, input__sensor_radius=0.5)
    feed.add(Quantity.VIBRATION, [imu(1, (1.0, 2.0, 3.0))])
    assert sink.vibration == [(1, expected)]


def test_an_imu_without_a_radius_is_refused() -> None:
    with pytest.raises(ParameterError, match="distance of the IMU"):
        inputs(input__source="imu", input__sensor_radius=0.0)


@pytest.mark.parametrize(("axis", "expected"), [("x", 1.0), ("-y", -2.0), ("z", 3.0)])
def test_a_wrenchs_torque_is_taken_along_the_joints_axis(axis: str, expected: float) -> None:
    feed, sink = inputs(load__source="wrench", load__axis=axis)
    whole = wrench(2, (1.0, 2.0, 3.0))
    feed.add(Quantity.TORQUE, [wrench(1, (1.0, 2.0, 3.0)), whole[:-1], whole])
    assert sink.torque == [(1, expected), (2, expected)]
    assert len(sink.rejected) == 1
    assert "cut off" in sink.rejected[0]


@pytest.mark.parametrize(
    ("names", "shown"),
    [
        (["left\narm", "\x1b[31mred", ""], "'left\\narm', '\\x1b[31mred', ''; check the name"),
        ([f"j{number}" for number in range(1000)], "j0, j1, j2, j3, j4, j5 and 994 more; check the name"),
    ],
)
def test_a_complaint_about_names_stays_one_short_line(names: list[str], shown: str) -> None:
    sink = Recorder()
    message = joint_state(0, **dict.fromkeys(names, 0.0))
    Inputs("elbow", JointSettings.from_mapping(), sink).add(Quantity.MOTION, [message])
    assert sink.rejected == [f"joint 'elbow' is not in joint_states, which carries {shown}"]

"""Bags written without ROS hold what the node would publish, message by message."""

import resource
import signal
from typing import Any

import numpy as np
import pytest

from hd_monitor import cdr, contract
from hd_monitor.contract import NANOSECONDS, unpack_blocks
from hd_monitor.errors import LayoutError
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation, Stretch

pytest.importorskip("rosbags", reason="writing and reading bags needs the extra 'offline'")

from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from hd_monitor.errors import ParameterError
from hd_sim_node.bag import COMPRESSIONS, STORAGES, BagError, write_bag

START = 1_700_000_000 * NANOSECONDS + 123
EVERYTHING = {
    "programme": "fixed",
    "fixed.speed": 1600.0,
    "duration": 1.0,
    "publish": "both",
    "publish_imu": True,
    "sensor.jitter": 1e-4,
    "transport.loss": 0.05,
    "transport.duplicates": 0.05,
    "transport.late": 0.05,
    "joint_states.name": "elbow",
}


def rig(**changes):
    return RigSettings.from_mapping(EVERYTHING | {name.replace("__", "."): value for name, value in changes.items()})


def read(path):
    """(time, topic, type, message) of everything in a bag, by a library that is not ours."""
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        return [
            (time, connection.topic, connection.msgtype, reader.deserialize(data, connection.msgtype))
            for connection, time, data in reader.messages()
        ]


def stamp_of(message):
    return message.header.stamp.sec * NANOSECONDS + message.header.stamp.nanosec


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_holds_every_message_of_the_simulation_in_its_order(tmp_path, storage, compression):
    summary = write_bag(rig(), tmp_path / "bag", storage=storage, compression=compression, start=START)
    expected = [(due + START, f"/{topic}") for stretch in Simulation(rig()) for due, topic, _ in stretch.schedule()]
    got = [(time, topic) for time, topic, _, _ in read(tmp_path / "bag")]
    assert sorted(got) == sorted(expected)
    assert [time for time, _ in got] == [time for time, _ in expected]
    assert sum(summary.messages.values()) == len(expected)
    assert summary.duration == 1.0


def test_messages_carry_the_simulations_values(tmp_path):
    write_bag(rig(), tmp_path / "bag", start=START)
    stretches = list(Simulation(rig()))
    by_topic: dict[tuple[str, str], list[Any]] = {}
    for _, topic, kind, message in read(tmp_path / "bag"):
        by_topic.setdefault((topic, kind), []).append(message)
    sent: dict[str, list[tuple[Stretch, int]]] = {topic: [] for topic in Simulation(rig()).topics}
    for stretch in stretches:
        for _, topic, row in stretch.schedule():
            sent[topic].append((stretch, row))

    blocks = by_topic.pop(("/torsional_acceleration/block", "std_msgs/msg/Float64MultiArray"))
    for message, (stretch, row) in zip(blocks, sent[contract.TORSIONAL_ACCELERATION_BLOCK], strict=True):
        dimensions = [(d.label, d.size, d.stride) for d in message.layout.dim]
        (block,) = unpack_blocks(dimensions, message.layout.data_offset, np.asarray([message.data]))
        expected = stretch.blocks[row]
        assert not isinstance(block, LayoutError)
        assert block[:3] == (expected.stamp + START, expected.period, expected.sequence)
        np.testing.assert_array_equal(block.samples, expected.samples)

    samples = by_topic.pop(("/torsional_acceleration", "geometry_msgs/msg/AccelStamped"))
    for message, (stretch, row) in zip(samples, sent[contract.TORSIONAL_ACCELERATION], strict=True):
        assert stamp_of(message) == START + stretch.stamps[row]
        assert message.accel.angular.z == stretch.samples[row]
        assert message.accel.linear.y == pytest.approx(0.55 * stretch.samples[row], rel=1e-14)
        assert message.header.frame_id == "hd_rig_sensor"

    imus = by_topic.pop(("/imu/data_raw", "sensor_msgs/msg/Imu"))
    for message, (stretch, row) in zip(imus, sent[contract.IMU], strict=True):
        assert stretch.imu is not None
        force, turning = stretch.imu
        assert stamp_of(message) == START + stretch.stamps[row]
        force_read, turning_read = message.linear_acceleration, message.angular_velocity
        assert [force_read.x, force_read.y, force_read.z] == force[row].tolist()
        assert [turning_read.x, turning_read.y, turning_read.z] == turning[row].tolist()
        assert message.orientation_covariance[0] == -1.0

    joints = by_topic.pop(("/joint_states", "sensor_msgs/msg/JointState"))
    for message, (stretch, row) in zip(joints, sent[contract.JOINT_STATES], strict=True):
        assert message.name == ["elbow"]
        assert stamp_of(message) == START + stretch.joint.stamps[row]
        assert message.position.tolist() == [stretch.joint.position[row]]
        velocity, effort = stretch.joint.velocity, stretch.joint.effort
        assert velocity is not None
        assert effort is not None
        assert message.velocity.tolist() == [velocity[row]]
        assert message.effort.tolist() == [effort[row]]
    assert not by_topic


def test_the_cores_bulk_decoder_reads_it(tmp_path):
    write_bag(rig(), tmp_path / "bag", start=START)
    with AnyReader([tmp_path / "bag"]) as reader:
        raw = [data for connection, _, data in reader.messages() if connection.topic == "/torsional_acceleration"]
    decoded = cdr.decode_vectors(raw)
    assert decoded.faults == ()
    values = np.concatenate([s.samples[s.dispatch[contract.TORSIONAL_ACCELERATION].row] for s in Simulation(rig())])
    np.testing.assert_array_equal(decoded.angular[:, 2], values)


def test_what_the_joint_does_not_report_is_empty(tmp_path):
    write_bag(rig(joint_states__effort="none", joint_states__velocity="missing"), tmp_path / "bag")
    message = next(message for _, topic, _, message in read(tmp_path / "bag") if topic == "/joint_states")
    assert (message.position.size, message.velocity.size, message.effort.size) == (1, 0, 0)


def test_a_slow_joint_may_miss_whole_stretches(tmp_path):
    summary = write_bag(rig(joint_states__rate=0.5, duration=5.0, publish_imu=False), tmp_path / "bag")
    assert summary.messages["/joint_states"] == 3


def test_several_rigs_share_joint_states(tmp_path):
    rigs = [rig(publish="block", publish_imu=False, joint_states__name=name) for name in ("elbow", "wrist")]
    summary = write_bag(rigs, tmp_path / "bag", namespace="arm")
    assert set(summary.messages) == {
        "/arm/elbow/torsional_acceleration/block",
        "/arm/wrist/torsional_acceleration/block",
        "/arm/joint_states",
    }
    times = [time for time, *_ in read(tmp_path / "bag")]
    assert times == sorted(times)
    names = {message.name[0] for _, topic, _, message in read(tmp_path / "bag") if topic == "/arm/joint_states"}
    assert names == {"elbow", "wrist"}


def test_rigs_of_the_same_joint_are_refused(tmp_path):
    with pytest.raises(ParameterError, match="different names"):
        write_bag([rig(), rig()], tmp_path / "bag")


def test_a_programme_without_end_runs_once(tmp_path):
    endless = rig(duration=0.0, fixed__time=2.0)
    assert write_bag(endless, tmp_path / "bag").duration == 2.0


def test_an_existing_folder_is_left_alone(tmp_path):
    (tmp_path / "bag").mkdir()
    (tmp_path / "bag" / "mine").write_text("keep")
    with pytest.raises(BagError, match="exists already"):
        write_bag(rig(), tmp_path / "bag")
    assert (tmp_path / "bag" / "mine").read_text() == "keep"


def test_a_folder_that_cannot_be_made_is_an_error_with_a_reason(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(BagError, match="cannot be written"):
        write_bag(rig(), tmp_path / "file" / "bag")


@pytest.mark.parametrize("storage", STORAGES)
def test_a_full_disk_is_an_error_and_leaves_no_half_bag(tmp_path, storage):
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, before[1]))
    try:
        with pytest.raises(BagError, match="cannot be written"):
            write_bag(rig(duration=60.0), tmp_path / "bag", storage=storage)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert not (tmp_path / "bag").exists()


def test_progress_is_reported(tmp_path):
    told: list[float] = []
    write_bag(rig(duration=4.0), tmp_path / "bag", progress=told.append)
    assert told == sorted(told)
    assert told[0] == 0.0
    assert 0.5 < told[-1] <= 1.0

"""The node over real DDS: what arrives is what was simulated, and the impossible is refused."""

import numpy as np
import pytest
from tests.hd_sim_node.rig_process import BRIEF, MODULE, arguments, blocks_of, stamp_of

from hd_sim_node.parameters import PARAMETERS
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

pytestmark = pytest.mark.ros


def simulated(**changes):
    names = {parameter.name for parameter in PARAMETERS}
    values = BRIEF | {name.replace("__", "."): value for name, value in changes.items()}
    return list(Simulation(RigSettings.from_mapping({n: v for n, v in values.items() if n in names})))


def test_everything_simulated_arrives_once_and_unchanged(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    samples = peer.collect(messages.sample, "torsional_acceleration", match=False)
    imus = peer.collect(messages.imu, "imu/data_raw", match=False)
    joints = peer.collect(messages.joint, "joint_states", match=False)
    node = start_module(MODULE, *arguments(publish="both", publish_imu=True, time_scale=2.0))
    peer.until(lambda: not node.running, "the node's end")
    assert node.wait() == 0, node.output
    stretches = simulated(publish="both", publish_imu=True)
    peer.until(lambda: len(blocks) >= 20 and len(joints) >= 100 and len(samples) >= 1000, "the last messages")
    peer.until(lambda: len(imus) >= 1000, "the last IMU messages")

    received = blocks_of(blocks)
    epoch = received[0].stamp
    expected = [block for stretch in stretches for block in stretch.blocks]
    assert [b.stamp - epoch for b in received] == [b.stamp for b in expected]
    assert [(b.period, b.sequence) for b in received] == [(b.period, b.sequence) for b in expected]
    truth = np.concatenate([stretch.samples for stretch in stretches])
    np.testing.assert_array_equal(np.concatenate([b.samples for b in received]), truth)

    assert [stamp_of(m) - epoch for m in samples] == [n * 1_000_000 for n in range(1000)]
    np.testing.assert_array_equal([m.accel.angular.z for m in samples], truth)
    np.testing.assert_allclose([m.accel.linear.y for m in samples], 0.55 * truth)
    np.testing.assert_allclose([m.linear_acceleration.y for m in imus], 0.55 * truth)
    assert imus[0].orientation_covariance[0] == -1.0

    assert [stamp_of(m) - epoch for m in joints] == [n * 10_000_000 for n in range(100)]
    assert {tuple(m.name) for m in joints} == {("joint",)}
    position = np.concatenate([stretch.joint.position for stretch in stretches])
    np.testing.assert_array_equal([m.position[0] for m in joints], position)


def test_stamps_start_now(peer, start_module, messages):
    before = peer.node.get_clock().now().nanoseconds
    joints = peer.collect(messages.joint, "joint_states", match=False)
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    node = start_module(MODULE, *arguments())
    peer.until(lambda: joints and blocks, "messages")
    assert before <= stamp_of(joints[0]) <= peer.node.get_clock().now().nanoseconds
    assert node.interrupt() == 0


def test_waits_for_subscribers_so_that_the_first_message_is_not_lost(peer, start_module, messages):
    joints = peer.collect(messages.joint, "joint_states", match=False)
    node = start_module(MODULE, *arguments())
    peer.until(lambda: "waiting for 1 subscriber" in node.output, "the node's waiting")
    peer.until(lambda: peer.node.count_publishers("joint_states") == 1, "its publisher")
    for _ in range(20):
        peer.executor.spin_once(timeout_sec=0.05)
    assert joints == []  # one topic has its subscriber, the other has not
    blocks = peer.collect(messages.block, "torsional_acceleration/block")
    peer.until(lambda: len(blocks) >= 20, "all blocks")
    assert [b.sequence for b in blocks_of(blocks)] == list(range(20))
    assert stamp_of(joints[0]) == blocks_of(blocks)[0].stamp


def test_runs_until_interrupted(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    node = start_module(MODULE, *arguments(duration=0.0, wait_for_subscribers=0))
    peer.until(lambda: len(blocks) > 50, "blocks beyond the first second")
    assert node.interrupt() == 0, node.output


def test_can_stay_after_the_programme(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    joints = peer.collect(messages.joint, "joint_states", match=False)
    node = start_module(MODULE, *arguments(exit_at_end=False))
    peer.until(lambda: "the programme has ended" in node.output, "the programme's end")
    peer.until(lambda: len(blocks) == 20 and len(joints) == 100, "all messages")
    assert node.running
    assert peer.node.count_publishers("joint_states") == 1


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"fixed__sped": 5.0}, "fixed.sped is not a parameter of the rig; did you mean fixed.speed?"),
        ({"defect": "rust"}, "choose one of"),
        ({"sensor__noise": -1.0}, "outside"),
        ({"seed": 1.5}, "wrong type"),
        ({"reducer__circular_spline_teeth": 163}, "odd"),
        ({"time_scale": 0.0}, "time_scale"),
        (
            {"fixed__speed": 3300.0, "defect": "custom", "circular_spline__beta": [0.14]},
            "parametrically unstable at 3300 rpm",
        ),
    ],
)
def test_refuses_the_impossible_with_a_reason_and_status_2(start_module, changes, said):
    node = start_module(MODULE, *arguments(**changes))
    assert node.wait() == 2
    assert said in node.output
    assert "Traceback" not in node.output


def test_an_unstable_rig_may_be_watched_on_purpose(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    node = start_module(
        MODULE,
        *arguments(
            fixed__speed=3300.0,
            defect="custom",
            circular_spline__beta=[0.14],
            unstable="warn",
            duration=4.0,
        ),
    )
    joints = peer.collect(messages.joint, "joint_states")
    peer.until(lambda: joints and not node.running, "the node's end")
    assert node.wait() == 0
    assert "unstable at 3300 rpm" in node.output
    peer.until(lambda: len(blocks) == 80, "all blocks")
    sizes = [float(np.std(b.samples)) for b in blocks_of(blocks)]
    assert sizes[79] > 50 * sizes[39]


def test_a_parameter_file_that_serves_the_monitor_too(peer, start_module, messages, tmp_path):
    file = tmp_path / "both.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n    joints: [elbow]\n    elbow: {reducer: {serial: A7}}\n"
        "    reducer: {flexspline_teeth: 200, circular_spline_teeth: 202, mount: flexspline_fixed}\n"
        "    diagnosis: {warn_index: 0.04}\n"
        "hd_sim_node:\n  ros__parameters:\n    joint_states: {name: elbow}\n    programme: fixed\n"
        "    circular_spline: {beta: [0.05, 0.02]}\n    defect: custom\n"
    )
    joints = peer.collect(messages.joint, "joint_states", match=False)
    node = start_module(MODULE, "--ros-args", "--params-file", str(file))
    peer.until(lambda: joints, "joint states")
    assert joints[0].name == ["elbow"]
    assert "rig 200/202" in node.output
    assert "of the circular spline 5.39 %" in node.output


def test_a_namespace_moves_every_topic(peer, start_module, messages):
    blocks = peer.collect(messages.block, "arm/torsional_acceleration/block", match=False)
    joints = peer.collect(messages.joint, "arm/joint_states", match=False)
    start_module(MODULE, *arguments(), "-r", "__ns:=/arm")
    peer.until(lambda: len(blocks) >= 20 and len(joints) >= 100, "all messages below the namespace")

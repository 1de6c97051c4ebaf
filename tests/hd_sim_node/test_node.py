"""The node over real DDS: what arrives is what was simulated, and the lifecycle does what it says."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from hd_monitor.contract import NANOSECONDS, unpack_block
from hd_sim_node.node_parameters import NODE_PARAMETERS
from hd_sim_node.parameters import CHANGEABLE, PARAMETERS
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

pytestmark = pytest.mark.ros
MODULE = "hd_sim_node.node"
BRIEF = {
    "programme": "fixed",
    "fixed.speed": 1600.0,
    "duration": 1.0,
    "time_scale": 10.0,
    "wait_for_subscribers": 1,
    "exit_at_end": True,
    "seed": 5,
}


def arguments(**changes):
    values = BRIEF | {name.replace("__", "."): value for name, value in changes.items()}
    texts = {True: "true", False: "false"}
    pairs = [("-p", f"{n}:={texts.get(v, v) if isinstance(v, bool) else v}") for n, v in values.items()]
    return ["--ros-args", *itertools.chain.from_iterable(pairs)]


def simulated(**changes):
    names = {parameter.name for parameter in PARAMETERS}
    values = BRIEF | {name.replace("__", "."): value for name, value in changes.items()}
    return list(Simulation(RigSettings.from_mapping({n: v for n, v in values.items() if n in names})))


@pytest.fixture
def messages():
    pytest.importorskip("rclpy")
    from geometry_msgs.msg import AccelStamped
    from sensor_msgs.msg import Imu, JointState
    from std_msgs.msg import Float64MultiArray

    return SimpleNamespace(block=Float64MultiArray, sample=AccelStamped, imu=Imu, joint=JointState)


def stamp_of(message):
    return message.header.stamp.sec * NANOSECONDS + message.header.stamp.nanosec


def blocks_of(received):
    return [
        unpack_block([(d.label, d.size, d.stride) for d in m.layout.dim], m.layout.data_offset, m.data)
        for m in received
    ]


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


def test_goes_on_without_end_until_interrupted(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    node = start_module(MODULE, *arguments(duration=0.0, wait_for_subscribers=0))
    peer.until(lambda: len(blocks) > 50, "blocks beyond the first second")
    assert node.interrupt() == 0, node.output


def test_stays_after_the_programme_if_asked(peer, start_module, messages):
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
        ({"fixed__sped": 5.0}, "fixed.sped is no parameter of the rig; did you mean fixed.speed?"),
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


@pytest.fixture
def services():
    pytest.importorskip("rclpy")
    from lifecycle_msgs import msg as lifecycle
    from lifecycle_msgs import srv as lifecycle_calls
    from rcl_interfaces import msg as parameters
    from rcl_interfaces import srv as parameter_calls

    return SimpleNamespace(
        State=lifecycle.State,
        Transition=lifecycle.Transition,
        ChangeState=lifecycle_calls.ChangeState,
        GetState=lifecycle_calls.GetState,
        Parameter=parameters.Parameter,
        ParameterType=parameters.ParameterType,
        ParameterValue=parameters.ParameterValue,
        DescribeParameters=parameter_calls.DescribeParameters,
        GetParameters=parameter_calls.GetParameters,
        SetParameters=parameter_calls.SetParameters,
    )


def change_state(peer, services, transition):
    request = services.ChangeState.Request(transition=services.Transition(id=transition))
    return peer.call(services.ChangeState, "hd_sim_node/change_state", request).success


def state(peer, services):
    request = services.GetState.Request()
    return peer.call(services.GetState, "hd_sim_node/get_state", request).current_state.id


def set_parameters(peer, services, **values):
    def typed(value):
        kinds = services.ParameterType
        if isinstance(value, str):
            return services.ParameterValue(type=kinds.PARAMETER_STRING, string_value=value)
        if isinstance(value, list):
            return services.ParameterValue(type=kinds.PARAMETER_DOUBLE_ARRAY, double_array_value=value)
        return services.ParameterValue(type=kinds.PARAMETER_DOUBLE, double_value=value)

    request = services.SetParameters.Request(
        parameters=[
            services.Parameter(name=name.replace("__", "."), value=typed(value)) for name, value in values.items()
        ]
    )
    return peer.call(services.SetParameters, "hd_sim_node/set_parameters", request).results


ENDLESS = {"duration": 0.0, "wait_for_subscribers": 0}


def test_comes_up_unconfigured_if_asked_and_follows_the_lifecycle(peer, start_module, messages, services):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    start_module(MODULE, *arguments(**ENDLESS, autostart=False))
    ids, states = services.Transition, services.State
    assert state(peer, services) == states.PRIMARY_STATE_UNCONFIGURED
    assert change_state(peer, services, ids.TRANSITION_CONFIGURE)
    assert state(peer, services) == states.PRIMARY_STATE_INACTIVE
    assert blocks == []
    assert change_state(peer, services, ids.TRANSITION_ACTIVATE)
    peer.until(lambda: len(blocks) > 5, "blocks of the active node")
    assert change_state(peer, services, ids.TRANSITION_DEACTIVATE)
    paused_at = peer.node.get_clock().now().nanoseconds
    assert change_state(peer, services, ids.TRANSITION_ACTIVATE)
    count = len(blocks)
    peer.until(lambda: len(blocks) > count + 5, "blocks after the pause")
    received = blocks_of(blocks)
    assert [b.sequence for b in received] == list(range(len(received)))  # a pause loses nothing
    assert received[-1].stamp > paused_at
    assert change_state(peer, services, ids.TRANSITION_DEACTIVATE)
    assert change_state(peer, services, ids.TRANSITION_CLEANUP)
    assert state(peer, services) == states.PRIMARY_STATE_UNCONFIGURED
    assert change_state(peer, services, ids.TRANSITION_CONFIGURE)
    assert change_state(peer, services, ids.TRANSITION_ACTIVATE)
    count = len(blocks)
    peer.until(lambda: len(blocks) > count, "blocks of the rig set up anew")
    assert blocks_of(blocks[count:])[0].sequence == 0


def test_a_defect_may_appear_while_it_runs(peer, start_module, messages, services):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    start_module(MODULE, *arguments(**ENDLESS, defect="none"))
    peer.until(lambda: len(blocks) > 60, "a few healthy blocks")
    healthy = np.std(blocks_of(blocks)[-1].samples)
    (result,) = set_parameters(peer, services, defect="both")
    assert result.successful, result.reason
    peer.until(lambda: np.std(blocks_of(blocks[-1:])[0].samples) > 3 * healthy, "the defect's vibration")


def test_impossible_changes_are_refused_and_change_nothing(peer, start_module, messages, services):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    node = start_module(MODULE, *arguments(**ENDLESS, fixed__speed=3300.0, defect="none"))
    peer.until(lambda: blocks, "blocks")
    (result,) = set_parameters(peer, services, defect="rust")
    assert not result.successful
    assert "choose one of" in result.reason
    (result,) = set_parameters(peer, services, programme="sweep")
    assert not result.successful
    (result,) = set_parameters(peer, services, circular_spline__beta=[0.14])
    assert result.successful, result.reason  # it does not count yet
    (result,) = set_parameters(peer, services, defect="custom")
    assert not result.successful
    assert "unstable at 3300 rpm" in result.reason
    count = len(blocks)
    peer.until(lambda: len(blocks) > count + 5, "blocks, as before")
    assert node.running


def test_every_parameter_is_typed_described_and_bounded(peer, start_module, services):
    start_module(MODULE, *arguments(**ENDLESS))
    table = [*PARAMETERS, *NODE_PARAMETERS]
    names = [parameter.name for parameter in table]
    request = services.DescribeParameters.Request(names=names)
    descriptors = peer.call(services.DescribeParameters, "hd_sim_node/describe_parameters", request).descriptors
    values = peer.call(
        services.GetParameters, "hd_sim_node/get_parameters", services.GetParameters.Request(names=names)
    ).values
    types = services.ParameterType
    kinds = {
        bool: types.PARAMETER_BOOL,
        int: types.PARAMETER_INTEGER,
        float: types.PARAMETER_DOUBLE,
        str: types.PARAMETER_STRING,
        tuple: types.PARAMETER_DOUBLE_ARRAY,
    }
    for parameter, descriptor, value in zip(table, descriptors, values, strict=True):
        assert descriptor.name == parameter.name
        assert value.type == descriptor.type == kinds[type(parameter.default)], parameter.name
        assert parameter.description in descriptor.description
        if parameter.unit:
            assert f"[{parameter.unit}]" in descriptor.description
        if type(parameter.default) is float:
            assert descriptor.floating_point_range, parameter.name
        if type(parameter.default) is int:
            assert descriptor.integer_range, parameter.name
        changeable = parameter.name.startswith(CHANGEABLE) or parameter.name == "time_scale"
        assert descriptor.read_only != changeable, parameter.name


def test_the_pace_may_change_while_it_runs(peer, start_module, messages, services):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    start_module(MODULE, *arguments(**ENDLESS, time_scale=0.01))
    peer.until(lambda: peer.node.count_publishers("torsional_acceleration/block"), "its publisher")
    (result,) = set_parameters(peer, services, time_scale=50.0)
    assert result.successful, result.reason
    # At the first pace these would take half a minute of half an hour.
    peer.until(lambda: len(blocks) > 500, "blocks at the new pace")


def test_a_namespace_moves_every_topic(peer, start_module, messages):
    blocks = peer.collect(messages.block, "arm/torsional_acceleration/block", match=False)
    joints = peer.collect(messages.joint, "arm/joint_states", match=False)
    start_module(MODULE, *arguments(), "-r", "__ns:=/arm")
    peer.until(lambda: len(blocks) >= 20 and len(joints) >= 100, "all messages below the namespace")

"""The node's lifecycle and its parameters at run time, over real DDS."""

import numpy as np
import pytest
from tests.hd_sim_node.rig_process import MODULE, NODE, arguments, blocks_of
from tests.managed import change_state, set_parameter, state

from hd_sim_node.drive.catalogue import preset
from hd_sim_node.parameters import CHANGEABLE, NODE_PARAMETERS, PARAMETERS

pytestmark = pytest.mark.ros

ENDLESS = {"duration": 0.0, "wait_for_subscribers": 0}


def test_can_start_unconfigured_and_follows_the_lifecycle(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    start_module(MODULE, *arguments(**ENDLESS, autostart=False))
    assert state(peer, NODE) == "unconfigured"
    assert change_state(peer, NODE, "configure")
    assert state(peer, NODE) == "inactive"
    assert blocks == []
    assert change_state(peer, NODE, "activate")
    peer.until(lambda: len(blocks) > 5, "blocks of the active node")
    assert change_state(peer, NODE, "deactivate")
    paused_at = peer.node.get_clock().now().nanoseconds
    assert change_state(peer, NODE, "activate")
    count = len(blocks)
    peer.until(lambda: len(blocks) > count + 5, "blocks after the pause")
    received = blocks_of(blocks)
    assert [b.sequence for b in received] == list(range(len(received)))  # a pause loses nothing
    assert received[-1].stamp > paused_at
    assert change_state(peer, NODE, "deactivate")
    assert change_state(peer, NODE, "cleanup")
    assert state(peer, NODE) == "unconfigured"
    assert change_state(peer, NODE, "configure")
    assert change_state(peer, NODE, "activate")
    count = len(blocks)
    peer.until(lambda: len(blocks) > count, "blocks of the reconfigured rig")
    assert blocks_of(blocks[count:])[0].sequence == 0


def test_a_defect_may_appear_while_it_runs(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    start_module(MODULE, *arguments(**ENDLESS, defect="none"))
    peer.until(lambda: len(blocks) > 60, "a few healthy blocks")
    healthy = np.std(blocks_of(blocks)[-1].samples)
    result = set_parameter(peer, NODE, "defect", "both")
    assert result.successful, result.reason
    peer.until(lambda: np.std(blocks_of(blocks[-1:])[0].samples) > 3 * healthy, "the defect's vibration")


def test_impossible_changes_are_refused_and_change_nothing(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    node = start_module(MODULE, *arguments(**ENDLESS, fixed__speed=3300.0, defect="none"))
    peer.until(lambda: blocks, "blocks")
    result = set_parameter(peer, NODE, "defect", "rust")
    assert not result.successful
    assert "choose one of" in result.reason
    result = set_parameter(peer, NODE, "programme", "sweep")
    assert not result.successful
    result = set_parameter(peer, NODE, "circular_spline.beta", [0.14])
    assert result.successful, result.reason  # it does not count yet
    result = set_parameter(peer, NODE, "defect", "custom")
    assert not result.successful
    assert "unstable at 3300 rpm" in result.reason
    count = len(blocks)
    peer.until(lambda: len(blocks) > count + 5, "blocks, as before")
    assert node.running


def test_every_parameter_is_typed_described_and_bounded(peer, start_module):
    from rcl_interfaces.msg import ParameterType as types
    from rcl_interfaces.srv import DescribeParameters, GetParameters

    start_module(MODULE, *arguments(**ENDLESS))
    table = [*PARAMETERS, *NODE_PARAMETERS]
    names = [parameter.name for parameter in table]
    request = DescribeParameters.Request(names=names)
    descriptors = peer.call(DescribeParameters, "hd_sim_node/describe_parameters", request).descriptors
    values = peer.call(GetParameters, "hd_sim_node/get_parameters", GetParameters.Request(names=names)).values
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


def test_the_pace_may_change_while_it_runs(peer, start_module, messages):
    blocks = peer.collect(messages.block, "torsional_acceleration/block", match=False)
    start_module(MODULE, *arguments(**ENDLESS, time_scale=0.01))
    peer.until(lambda: peer.node.count_publishers("torsional_acceleration/block"), "its publisher")
    result = set_parameter(peer, NODE, "time_scale", 50.0)
    assert result.successful, result.reason
    # At the first pace these would take half a minute of half an hour.
    peer.until(lambda: len(blocks) > 500, "blocks at the new pace")


def test_a_preset_shows_in_the_declared_values(peer, start_module):
    from rcl_interfaces.srv import GetParameters

    start_module(MODULE, *arguments(**ENDLESS, drive="catalogue", dynamics__inertia=1.5))
    names = ["drive", "torque.mean", "torque.ripple", "dynamics.inertia"]
    values = peer.call(GetParameters, "hd_sim_node/get_parameters", GetParameters.Request(names=names)).values
    assert values[0].string_value == "catalogue"
    assert values[1].double_value == preset("catalogue")["torque.mean"]
    assert tuple(values[2].double_array_value) == preset("catalogue")["torque.ripple"]
    assert values[3].double_value == 1.5

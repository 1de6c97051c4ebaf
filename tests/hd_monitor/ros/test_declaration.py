"""The core's parameters declared in ROS."""

from typing import Any

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.settings import PARAMETERS

pytestmark = pytest.mark.ros


def test_every_numeric_parameter_has_a_range() -> None:
    from hd_monitor.ros.declaration import describe

    for parameter in PARAMETERS:
        descriptor = describe(parameter, read_only=False)
        assert descriptor.description.startswith(parameter.description)
        if isinstance(parameter.default, (int, float)) and not isinstance(parameter.default, bool):
            assert descriptor.floating_point_range or descriptor.integer_range, parameter.name


def test_a_checked_value_takes_the_place_of_the_raw_one(peer: Any) -> None:
    from hd_monitor.ros.declaration import declare

    (parameter,) = (parameter for parameter in PARAMETERS if parameter.name == "load.torque")
    peer.node.declare_parameter("load.torque", 3)
    declare(peer.node, parameter, 3.0, read_only=True)
    assert peer.node.get_parameter("load.torque").value == 3.0
    assert peer.node.describe_parameter("load.torque").read_only


def test_an_error_of_the_project_is_a_refusal_with_its_reason() -> None:
    from hd_monitor.ros.declaration import answer

    def refuse() -> None:
        raise ParameterError("load.torque = x has the wrong type")

    assert answer(lambda: None).successful
    refused = answer(refuse)
    assert not refused.successful
    assert refused.reason == "load.torque = x has the wrong type"

"""The core's parameters declared in ROS with description, unit and range, and checked by the core's own rules."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

from ..errors import HdMonitorError
from ..parameter import Parameter


def declare(node: Node, parameter: Parameter, value: Any, *, read_only: bool, below: str = "") -> None:
    """Declare a parameter, its name after the prefix `below`, with its checked value in place of ROS's raw one."""
    name = below + parameter.name
    if node.has_parameter(name):
        node.undeclare_parameter(name)
    node.declare_parameter(name, value, describe(parameter, read_only=read_only), ignore_override=True)


def describe(parameter: Parameter, *, read_only: bool) -> ParameterDescriptor:
    """Write a parameter's description, unit, range and words as a ROS descriptor."""
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    descriptor = ParameterDescriptor(
        description=f"{parameter.description}{unit}",
        read_only=read_only,
        additional_constraints=f"one of: {', '.join(parameter.choices)}" if parameter.choices else "",
    )
    if math.isfinite(parameter.low) and math.isfinite(parameter.high):
        if isinstance(parameter.default, float):
            bounds = FloatingPointRange(from_value=float(parameter.low), to_value=float(parameter.high))
            descriptor.floating_point_range = [bounds]
        elif isinstance(parameter.default, int) and not isinstance(parameter.default, bool):
            descriptor.integer_range = [IntegerRange(from_value=int(parameter.low), to_value=int(parameter.high))]
    return descriptor


def with_real_numbers(node: Node, parameters: Sequence[RosParameter]) -> list[RosParameter]:
    """Make whole numbers real where a node expects that: ``ros2 param set NODE input.timeout 1`` sends a whole one.

    To be called in a node's only callback before parameters are set: of several, rclpy would set what each returns.
    """
    return [_real(node, parameter) for parameter in parameters]


def _real(node: Node, parameter: RosParameter) -> RosParameter:
    if not node.has_parameter(parameter.name):
        return parameter
    expected = node.describe_parameter(parameter.name).type
    if (parameter.type_, expected) == (RosParameter.Type.INTEGER, ParameterType.PARAMETER_DOUBLE):
        return RosParameter(parameter.name, value=float(parameter.value))
    if (parameter.type_, expected) == (RosParameter.Type.INTEGER_ARRAY, ParameterType.PARAMETER_DOUBLE_ARRAY):
        return RosParameter(parameter.name, value=[float(value) for value in parameter.value])
    return parameter


def answer(check: Callable[[], object]) -> SetParametersResult:
    """Answer a request to set parameters: refused, with the reason, where `check` raises an error of the project."""
    try:
        check()
    except HdMonitorError as error:
        return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)

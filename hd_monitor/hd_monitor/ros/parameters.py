"""The joints' settings as ROS parameters, declared on the node and checked by the core's own rules."""

import re
from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

from ..errors import ParameterError
from ..settings import NODE_PARAMETERS, PARAMETERS, JointSettings, check_change, set_aside_foreign, split_joints
from ..settings.table import JOINTS
from .declaration import answer, declare, with_real_numbers

_TOPIC_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


class JointParameters:
    """The parameters of all joints, declared on a node.

    Parameters
    ----------
    node : Node
        Created with ``automatically_declare_parameters_from_overrides=True``, so that misspelt names are noticed.
    is_active : callable
        Whether the joints are being watched, so that only what leaves their evidence valid may change.
    changed : callable
        Called after a change.

    Attributes
    ----------
    settings : dict of str to JointSettings
        By joint, in force once the node is activated.

    Raises
    ------
    ParameterError, GeometryError
        If a parameter is unknown, of the wrong type, out of range or impossible beside the others.
    """

    def __init__(self, node: Node, is_active: Callable[[], bool], changed: Callable[[], None]) -> None:
        self._node = node
        self._is_active = is_active
        self._changed = changed
        given, strangers = set_aside_foreign(self._values())
        for name in strangers:
            node.undeclare_parameter(name)
        if strangers:
            node.get_logger().warning(
                f"ignoring {', '.join(strangers)}: not parameters of this node; correct if others share the file, "
                "else check the spelling"
            )
        self.settings = split_joints(given)
        joints = list(self.settings)
        check_names(joints)
        declare(node, JOINTS, joints, read_only=True)
        for parameter in NODE_PARAMETERS:
            value = parameter.check(given.get(parameter.name, parameter.default))
            declare(node, parameter, value, read_only=True)
        below = tuple(f"{joint}." for joint in joints)
        by_joint = len(joints) > 1 or any(name.startswith(below) for name in given)
        self._overridden = {name for name in given if name.startswith(below)}
        self._followers: set[str] = set()
        common = split_joints({name: value for name, value in given.items() if not name.startswith(below)})[joints[0]]
        self._declare("", common)
        if by_joint:
            for joint, settings in self.settings.items():
                self._declare(f"{joint}.", settings)
        node.add_pre_set_parameters_callback(self._extend)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def _declare(self, prefix: str, settings: JointSettings) -> None:
        values = dict(settings.values)
        for parameter in PARAMETERS:
            declare(self._node, parameter, values[parameter.name], read_only=False, below=prefix)

    def _values(self) -> dict[str, Any]:
        return {name: self._node.get_parameter(name).value for name in self._node.list_parameters([], 0).names}

    def _with(self, parameters: Sequence[RosParameter]) -> dict[str, JointSettings]:
        return split_joints(self._values() | {parameter.name: parameter.value for parameter in parameters})

    def _extend(self, parameters: list[RosParameter]) -> list[RosParameter]:
        """Set a common parameter of every joint that has not been given its own."""
        parameters = with_real_numbers(self._node, parameters)
        requested = {parameter.name for parameter in parameters}
        followers = [
            RosParameter(name, value=parameter.value)
            for parameter in parameters
            for joint in self.settings
            if self._node.has_parameter(name := f"{joint}.{parameter.name}")
            and name not in self._overridden | requested
        ]
        self._followers = {parameter.name for parameter in followers}
        return [*parameters, *followers]

    def _check(self, parameters: Sequence[RosParameter]) -> SetParametersResult:
        def check() -> None:
            settings = self._with(parameters)
            if self._is_active():
                for joint, before in self.settings.items():
                    check_change(before, settings[joint])

        return answer(check)

    def _apply(self, parameters: Sequence[RosParameter]) -> None:
        self._overridden |= {parameter.name for parameter in parameters} - self._followers
        settings = self._with(parameters)
        if settings != self.settings:
            self.settings = settings
            self._changed()


def check_names(joints: Sequence[str]) -> None:
    """Refuse joint names that cannot stand before a parameter or, with several joints, in a topic's name.

    Raises
    ------
    ParameterError
        If a name is empty, is the first word of a parameter or, with several joints, holds anything but letters,
        digits and underscores; the message says the way out.
    """
    groups = {parameter.name.partition(".")[0] for parameter in PARAMETERS}
    for joint in joints:
        word = re.sub(r"[^A-Za-z0-9]+", "_", joint).strip("_") or "joint"
        if word in groups:
            word = f"{word}_joint"
        elif word[0].isdigit():
            word = f"joint_{word}"
        if joint in groups or not joint:
            trouble = "which cannot precede a parameter's name"
        elif len(joints) > 1 and not _TOPIC_WORD.fullmatch(joint):
            trouble = "which cannot be part of a topic's name"
        else:
            continue
        raise ParameterError(
            f"joints has {joint!r}, {trouble}; call it {word!r} there and put the name that joint_states uses into "
            f"{word}.input.joint_name"
        )

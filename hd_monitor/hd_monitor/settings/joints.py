"""A node's parameters, split into those of each joint, of the node itself, and of other nodes that share the file."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import ParameterError, did_you_mean, listed
from ..parameter import flatten
from .joint_settings import JointSettings
from .table import NODE_PARAMETERS, PARAMETERS, ROS_PARAMETERS

_OF_JOINTS = {parameter.name for parameter in PARAMETERS}
_OF_NO_JOINT = {parameter.name for parameter in NODE_PARAMETERS} | set(ROS_PARAMETERS)


def _is_of_the_node(name: str) -> bool:
    """Whether a parameter belongs to the node or to ROS itself, and so to no joint."""
    return name in _OF_NO_JOINT or name.startswith("qos_overrides.")


_OWN_GROUPS = ("reducer", "dynamics", "input", "analysis", "diagnosis")


def set_aside_foreign(given: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Split a parameter file that is shared with other nodes: (the monitor's parameters, names of the others').

    What stands below a joint or in a group that is the monitor's alone is never foreign, and neither is a joint's
    parameter below another name, so that a misspelt name is still refused by :func:`split_joints`.
    """
    flat = flatten(given)
    joints = flat.get("joints") or ["joint"]
    # Whatever else stands there is refused by `split_joints`.
    own = tuple(f"{group}." for group in (*_OWN_GROUPS, *(joints if isinstance(joints, (list, tuple)) else [joints])))
    mine = {"joints", *_OF_JOINTS}
    known = {
        name
        for name in flat
        if name in mine or _is_of_the_node(name) or name.startswith(own) or name.partition(".")[2] in _OF_JOINTS
    }
    strangers = sorted(flat.keys() - known)
    return {name: value for name, value in flat.items() if name not in strangers}, strangers


def split_joints(given: Mapping[str, Any]) -> dict[str, JointSettings]:
    """Settings of every joint in a node's parameters.

    Parameters
    ----------
    given : mapping
        Parameters, nested or dotted: `joints` (list of names; one unnamed joint called ``joint`` by default), the
        joints' common values at the top level and each joint's own below its name.

    Returns
    -------
    dict of str to JointSettings
        In the order of `joints`.

    Raises
    ------
    ParameterError
        If a joint is named twice or a name belongs to no parameter and no joint.
    """
    flat = {name: value for name, value in flatten(given).items() if not _is_of_the_node(name)}
    joints = flat.pop("joints", None) or ["joint"]
    several = isinstance(joints, Sequence) and not isinstance(joints, str)
    named = several and all(isinstance(joint, str) and joint and joint.isprintable() for joint in joints)
    if not named or len(set(joints)) != len(joints):
        raise ParameterError(f"joints = {joints!r} must be a list of different names, each on one line")
    common = {name: value for name, value in flat.items() if name in _OF_JOINTS}
    rest = {name: value for name, value in flat.items() if name not in _OF_JOINTS}
    settings = {}
    for joint in joints:
        prefix = f"{joint}."
        own = {name[len(prefix) :]: value for name, value in rest.items() if name.startswith(prefix)}
        rest = {name: value for name, value in rest.items() if not name.startswith(prefix)}
        settings[joint] = JointSettings.from_mapping(common | own)
    if rest:
        raise ParameterError(_unknown(min(rest), joints))
    return settings


def _unknown(name: str, joints: Sequence[str]) -> str:
    """Say what is wrong with a name that belongs to no parameter and no joint."""
    section, _, parameter = name.partition(".")
    if parameter in _OF_JOINTS:
        hint = did_you_mean(section, joints) or "; add it to joints, or check the spelling"
        return f"{name}: there is no joint {section!r}, only {listed(joints)}{hint}"
    hint = did_you_mean(name, _OF_JOINTS) or "; check the spelling"
    return f"there is no parameter {name}, neither of the node nor of a joint ({listed(joints)}){hint}"

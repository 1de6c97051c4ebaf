"""Which parameters may change while a joint is watched: those that leave what is known of it valid."""

from ..errors import ParameterError
from .joint_settings import JointSettings

CHANGEABLE = (
    "diagnosis.",
    "load.torque",
    "load.topic",
    "input.topic",
    "input.temperature_topic",
    "input.reliability",
    "input.queue_seconds",
    "input.timeout",
    "input.startup_warning",
    "input.startup_timeout",
)
"""Parameters, and groups of them, that take effect at once while the node is active."""


def is_changeable(name: str) -> bool:
    """Whether a parameter takes effect at once while the node is active."""
    return name in CHANGEABLE or name.partition(".")[0] + "." in CHANGEABLE


def check_change(before: JointSettings, after: JointSettings) -> None:
    """Refuse a change for which what is known of the joint would have to be gathered anew.

    Raises
    ------
    ParameterError
        If there is one; the message says why, and what to do.
    """
    old, new = dict(before.values), dict(after.values)
    for name, value in old.items():
        if new[name] == value:
            continue
        gains_or_loses_scale = name == "load.torque" and 0.0 in (value, new[name])
        if not is_changeable(name) or gains_or_loses_scale:
            raise ParameterError(
                f"{name} cannot change while the node is active, since what it knows of the joint was learnt with "
                f"{value!r}: deactivate the node, set {name}, and activate it again; the joint then starts anew"
            )

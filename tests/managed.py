"""A managed node from outside: its lifecycle and its parameters, by the services that every such node offers."""

from typing import Any


def change_state(peer: Any, node: str, label: str) -> bool:
    """Ask a node for a transition (``'activate'``, say); return whether it was made."""
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState

    request = ChangeState.Request(transition=Transition(label=label))
    return bool(peer.call(ChangeState, f"{node}/change_state", request).success)


def state(peer: Any, node: str) -> str:
    """Return the label of the state that a node is in."""
    from lifecycle_msgs.srv import GetState

    return str(peer.call(GetState, f"{node}/get_state", GetState.Request()).current_state.label)


def set_parameter(peer: Any, node: str, name: str, value: Any) -> Any:
    """Set a node's parameter; return the answer, with ``successful`` and ``reason``."""
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
    return peer.call(SetParameters, f"{node}/set_parameters", request).results[0]

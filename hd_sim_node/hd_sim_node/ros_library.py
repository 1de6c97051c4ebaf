"""Messages by ROS's own classes."""

from importlib import import_module
from typing import Any

import numpy as np
from rclpy.serialization import serialize_message

from .encoding import Library


def message_class(kind: str) -> Any:
    """Find the class of a message type such as ``sensor_msgs/msg/Imu``."""
    package, _, name = kind.split("/")
    return getattr(import_module(f"{package}.msg"), name)


def _make(kind: str, **fields: Any) -> Any:
    plain = {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in fields.items()}
    return message_class(kind)(**plain)


ROS = Library(_make, lambda message, kind: serialize_message(message))

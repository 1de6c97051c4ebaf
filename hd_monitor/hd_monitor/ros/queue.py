"""Depth of a queue: as requested, within what the middleware keeps.

Fast DDS gives every reader and writer room for 5000 samples (``max_samples`` of its resource limits), whatever depth
ROS requests. A full queue of a larger depth does not drop its oldest message, as keep-last promises, but refuses the
newest; up to 5000 it keeps the promise.
"""

import math

import rclpy

FAST_DDS_MOST = 5000
"""``max_samples`` of a reader or a writer of Fast DDS, measured with the rmw_fastrtps of Jazzy."""
SHALLOWEST = 10
"""Messages that a queue holds at least."""


def most_messages() -> float:
    """Messages that a queue of the middleware in use can hold; infinite where no limit is known."""
    return FAST_DDS_MOST if rclpy.get_rmw_implementation_identifier().startswith("rmw_fastrtps") else math.inf


def queue_depth(rate: float, seconds: float) -> int:
    """Messages to hold for so many seconds at a rate [Hz], as far as the middleware can."""
    return round(min(max(SHALLOWEST, math.ceil(rate * seconds)), most_messages()))

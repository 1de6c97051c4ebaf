"""How many messages a queue may hold: as many as are asked for, as far as the middleware keeps them.

Fast DDS gives every reader and writer room for 5000 samples (``max_samples`` of its resource limits), whatever depth
ROS asks for. A queue asked to be deeper does not drop its oldest message when it is full, as keep-last promises, but
refuses the newest; asked for 5000 it does as promised.
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

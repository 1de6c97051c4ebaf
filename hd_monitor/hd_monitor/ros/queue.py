"""Queues of the middleware: as deep as requested, within what it keeps, and without memory that it never returns.

Fast DDS gives every reader and writer room for 5000 samples (``max_samples`` of its resource limits), whatever depth
ROS requests. A full queue of a larger depth does not drop its oldest message, as keep-last promises, but refuses the
newest; up to 5000 it keeps the promise. Each place of a queue holds on to as much memory as the largest message that
was ever in it, unless a profile says otherwise: messages of 80 MB, published by mistake where blocks are
expected, would each cost 80 MB for good.
"""

import math
import os
from pathlib import Path

import rclpy

FAST_DDS_MOST = 5000
"""``max_samples`` of a reader or a writer of Fast DDS, measured with the rmw_fastrtps of Jazzy."""
SHALLOWEST = 10
"""Messages that a queue holds at least."""

_PROFILES = Path(__file__).with_name("fast_dds.xml")
_LOCATIONS = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")


def return_memory() -> None:
    """Have Fast DDS free what a message took once it is taken; call it before ROS is initialised.

    A user who has chosen profiles in the environment keeps them.
    """
    if not any(os.environ.get(location) for location in _LOCATIONS):
        os.environ |= dict.fromkeys(_LOCATIONS, str(_PROFILES)) | {"RMW_FASTRTPS_USE_QOS_FROM_XML": "1"}


def most_messages() -> float:
    """Messages that a queue of the middleware in use can hold; infinite where no limit is known."""
    return FAST_DDS_MOST if rclpy.get_rmw_implementation_identifier().startswith("rmw_fastrtps") else math.inf


def queue_depth(rate: float, seconds: float) -> int:
    """Messages to hold for so many seconds at a rate [Hz], as far as the middleware can."""
    return round(min(max(SHALLOWEST, math.ceil(rate * seconds)), most_messages()))

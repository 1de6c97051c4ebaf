"""Finds a ROS domain in which a command's nodes are among themselves."""

import random
import socket

from ..errors import ParameterError

DOMAINS = range(1, 102)  # above them, DDS ports run into the system's ephemeral ones
LAST_DOMAIN = 232
"""Highest ROS_DOMAIN_ID there is."""
_FIRST_PORT, _PORTS_PER_DOMAIN = 7410, 250  # of a domain's first participant, by the DDS standard


def free_domain() -> int:
    """Find a ROS_DOMAIN_ID in which no DDS participant of this machine is.

    A participant binds a UDP port that stands for its domain, so a port that can be bound is a domain that is free.
    """
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("", _FIRST_PORT + _PORTS_PER_DOMAIN * domain))
            except OSError:
                continue
            return domain
    raise ParameterError("every ROS_DOMAIN_ID seems to be in use on this machine; give one with --domain")

"""Find a ROS domain that no other process on this machine uses."""

import random
import socket

from hd_monitor.errors import ParameterError

DOMAINS = range(1, 102)  # above them, DDS ports run into the system's ephemeral ones
LAST_DOMAIN = 232
"""The highest ROS_DOMAIN_ID."""
_FIRST_PORT, _PORTS_PER_DOMAIN = 7410, 250  # of a domain's first participant, by the DDS standard


def free_domain() -> int:
    """Find a ROS_DOMAIN_ID without a DDS participant on this machine.

    The first participant of a domain binds a UDP port that follows from the domain's number, so a port that can be
    bound means a domain that is free.

    Raises
    ------
    ParameterError
        If every domain is in use.
    """
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("", _FIRST_PORT + _PORTS_PER_DOMAIN * domain))
            except OSError:
                continue
            return domain
    raise ParameterError("every ROS_DOMAIN_ID seems to be in use on this machine; give one with --domain")

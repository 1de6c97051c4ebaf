"""From serialised messages to a monitor's arrays: the one path of the node's and of replay's input.

An :class:`Inputs` knows which message types its joint listens to and what of each message belongs to the joint. Both
shells hand it the bytes as they come from the middleware or from a bag, so that they cannot differ in what they see.
"""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from . import cdr, contract
from .arrays import FloatArray, IntArray
from .cdr_layout import Fault
from .errors import listed
from .settings import JointSettings
from .sources import Quantity, Stamped

UNNAMED_JOINT = "joint"
"""Name of a joint that the parameters do not name; it takes the only joint there is in joint_states."""

LARGEST_MESSAGE = 2_000_000
"""Bytes; a block of 250 000 samples has as many. Larger messages are refused unread: decoding costs time and copies."""


class Sink(Protocol):
    """What an adapter feeds: the input side of :class:`hd_monitor.monitor.Monitor`."""

    def add(self, quantity: Quantity, stamps: IntArray, *columns: FloatArray) -> None:
        """Take samples with their stamps [ns]: θ'' [rad/s²]; position, velocity and effort; torque; temperature."""

    def add_block(self, block: contract.Block) -> None:
        """Take a block of samples of θ'' [rad/s²]."""

    def reject(self, reason: str) -> None:
        """Count an unusable message, and remember why."""


class Inputs:
    """The inputs of one joint, as serialised messages.

    Parameters
    ----------
    joint : str
        Name of the joint in the parameters.
    settings : JointSettings
    sink : Sink
        Usually the joint's monitor.
    """

    def __init__(self, joint: str, settings: JointSettings, sink: Sink) -> None:
        self._sink = sink
        self.change(settings)
        self._joint = settings.input.joint_name or joint
        self._takes_any = not settings.input.joint_name and joint == UNNAMED_JOINT
        self._joint_seen = False

    def change(self, settings: JointSettings) -> None:
        """Put other settings in force, with the same source and joint."""
        self._settings = settings
        self._sources = settings.all_sources

    def add(self, quantity: Quantity, messages: Sequence[bytes]) -> None:
        """Feed messages of one of the joint's topics, in the order of their arrival."""
        if max(map(len, messages), default=0) > LARGEST_MESSAGE:
            for message in (message for message in messages if len(message) > LARGEST_MESSAGE):
                megabytes = len(message) / 1e6
                self._sink.reject(
                    f"a message of {megabytes:.1f} MB; more than {LARGEST_MESSAGE / 1e6:g} MB are not read"
                )
            messages = [message for message in messages if len(message) <= LARGEST_MESSAGE]
        decode = self._sources[quantity].decode
        if decode is None:
            self._add_motion(messages)
            return
        for item in decode(messages, self._settings):
            if isinstance(item, str):
                self._sink.reject(item)
            elif isinstance(item, Stamped):
                self._sink.add(quantity, item.stamps, item.values)
            else:
                self._sink.add_block(item)

    def _add_motion(self, messages: Sequence[bytes]) -> None:
        groups, faults = cdr.decode_joint_states(messages)
        mine = np.zeros(len(messages), dtype=np.bool_)
        stamps = np.zeros(len(messages), dtype=np.int64)
        values = np.empty((3, len(messages)))
        strangers: list[Fault] = []
        for group in groups:
            column = self._column(group.names)
            if column is not None:
                mine[group.place] = True
                stamps[group.place] = group.stamps
                for row, array in zip(values, (group.position, group.velocity, group.effort), strict=True):
                    row[group.place] = array[:, column]
            elif not self._joint_seen:
                strangers += [Fault(place, self._absent(group.names)) for place in group.place.tolist()]
        # Several publishers may share the topic, each with its own joints. Messages without the joint are a fault only
        # until it is first seen, since its name may be misspelt.
        first = int(mine.argmax()) if mine.any() else len(messages)
        for fault in sorted(faults + [stranger for stranger in strangers if stranger.place < first]):
            self._sink.reject(fault.reason)
        if mine.any():
            self._joint_seen = True
            self._sink.add(Quantity.MOTION, stamps[mine], *values[:, mine])

    def _column(self, names: tuple[str, ...]) -> int | None:
        if self._joint in names:
            return names.index(self._joint)
        return 0 if self._takes_any and len(names) == 1 else None

    def _absent(self, names: tuple[str, ...]) -> str:
        there = listed(names) if names else "no joint at all"
        if self._takes_any:
            return f"joint_states carries {there}; set input.joint_name (or joints) to the one to watch"
        return f"joint {self._joint!r} is not in joint_states, which carries {there}; check the name"

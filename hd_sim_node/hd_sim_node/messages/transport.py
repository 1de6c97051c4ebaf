"""What happens to messages in transit: some are lost, some arrive twice, some arrive late."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hd_monitor.arrays import IntArray
from hd_monitor.parameter import number

from ..randomness import generator

_LATEST = 3.0  # message intervals: a late message lets up to three others pass


@dataclass(frozen=True, slots=True, kw_only=True)
class TransportSettings:
    """What happens to a topic's messages: for the vibration's, the parameters ``transport.*``."""

    loss: float = number(0.0, "", 0.0, 1.0, "vibration messages lost, as a fraction")
    duplicates: float = number(0.0, "", 0.0, 1.0, "vibration messages that come twice, as a fraction")
    late: float = number(0.0, "", 0.0, 1.0, "vibration messages that arrive after up to three later ones, a fraction")


class Dispatch(NamedTuple):
    """When each message is sent, in order."""

    due: IntArray
    """Simulated time [ns] since the start."""
    row: IntArray
    """Row of the message in its batch."""


class Transport:
    """Decides when the messages of one topic are sent, and which are lost."""

    def __init__(self, settings: TransportSettings, *, seed: int = 0, topic: str = "") -> None:
        self.settings = settings
        self._random = generator(seed, f"transport {topic}")

    def dispatch(self, due: IntArray) -> Dispatch:
        """Schedule messages due at `due` [ns], rising; none is sent later than the last one is due."""
        settings, count = self.settings, due.size
        lost, twice, late, extent = self._random.random((count, 4)).T
        index = np.arange(count)
        if count > 1 and settings.late:
            spacing = float(due[-1] - due[0]) / (count - 1)
            delay = np.where(late < settings.late, np.rint((1.0 + extent * (_LATEST - 1.0)) * 1.5 * spacing), 0.0)
            due = np.minimum(due + delay.astype(np.int64), due[-1])
        copies = np.where(lost < settings.loss, 0, np.where(twice < settings.duplicates, 2, 1))
        index, due = np.repeat(index, copies), np.repeat(due, copies)
        order = np.argsort(due, kind="stable")
        return Dispatch(due[order], index[order])

"""The newest segment at an almost constant speed: what a spectrum over time may be taken of."""

import math
from collections import deque

from ..acquisition.record import Record
from ..reducer import Reducer

_SPEED_TOLERANCE = 0.02  # of the speed: more would smear the lines of a pair (1.25 % apart) into each other anyway
_REVOLUTIONS = 2.0  # of the output kept: twice what a Hann window needs for the first pair
_LONGEST = 60.0  # s


class SteadySegment:
    """Collects successive records as long as they follow each other at the same speed.

    Parameters
    ----------
    reducer : Reducer
    minimum_speed : float
        Wave-generator speed [rpm] below which the joint counts as standing.
    """

    def __init__(self, reducer: Reducer, minimum_speed: float) -> None:
        self._minimum = minimum_speed * math.tau / 60.0 / reducer.reduction
        self._parts: deque[Record] = deque()

    def add(self, record: Record) -> None:
        """Append a record, or start again with it where it does not continue or the speed has changed."""
        if not (record.continues and self._fits(record)):
            self._parts.clear()
            if not self._fits(record):
                return
        self._parts.append(record)
        while len(self._parts) > 1 and self._too_long():
            self._parts.popleft()

    def interrupt(self) -> None:
        """Forget the segment: nothing followed it."""
        self._parts.clear()

    def _fits(self, record: Record) -> bool:
        """Whether a record keeps the segment's speed or, where there is no segment yet, one speed of its own."""
        slowest, fastest = float(record.speed.min()), float(record.speed.max())
        speed = float(self._parts[0].speed.mean()) if self._parts else 0.5 * (slowest + fastest)
        margin = _SPEED_TOLERANCE * abs(speed)
        return abs(speed) > self._minimum and speed - margin <= slowest and fastest <= speed + margin

    def _too_long(self) -> bool:
        rest, newest = self._parts[1], self._parts[-1]
        travel = abs(float(newest.angle[-1] - rest.angle[0])) / math.tau
        return travel > _REVOLUTIONS or newest.start + newest.period * len(newest) - rest.start > _LONGEST

    def parts(self) -> tuple[Record, ...]:
        """Return the records of the segment, none while the speed is not steady."""
        return tuple(self._parts)

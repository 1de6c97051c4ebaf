"""How a joint fared since the view opened: a bounded history that gets coarser as it gets longer."""

import math
from dataclasses import dataclass
from typing import NamedTuple, Self

CAPACITY = 512
"""Steps kept; beyond it neighbours are merged."""


class Step(NamedTuple):
    """A span of time."""

    stamp: int
    """When it began [ns]."""
    severity: float
    """The largest reading over its error limit; NaN where there was none."""
    mark: str
    """One letter for the worst state in it: see `MARKS`."""


MARKS = {"?": "not judged", ".": "OK", "W": "WARN", "E": "ERROR"}
"""From the least to the worst."""


@dataclass(frozen=True, slots=True)
class Trail:
    """Steps in the order of time, each of the same number of statuses but the last."""

    steps: tuple[Step, ...] = ()
    merged: int = 1
    """Statuses a full step holds."""
    last: int = 0
    """Statuses in the last step."""

    def then(self, step: Step) -> Self:
        """Return the trail that goes on with a status."""
        if self.steps and self.last < self.merged:
            return type(self)((*self.steps[:-1], _worse(self.steps[-1], step)), self.merged, self.last + 1)
        if len(self.steps) < CAPACITY:
            return type(self)((*self.steps, step), self.merged, 1)
        halves = tuple(map(_worse, self.steps[::2], self.steps[1::2]))
        return type(self)((*halves, step), 2 * self.merged, 1)

    def columns(self, width: int) -> tuple[Step, ...]:
        """Return at most `width` steps, the worst of each group."""
        group = max(1, -(-len(self.steps) // width))
        found = []
        for start in range(0, len(self.steps), group):
            worst, *others = self.steps[start : start + group]
            for other in others:
                worst = _worse(worst, other)
            found.append(worst)
        return tuple(found)


def _worse(first: Step, second: Step) -> Step:
    order = list(MARKS)
    known = [value for value in (first.severity, second.severity) if not math.isnan(value)]
    return Step(first.stamp, max(known, default=math.nan), max(first.mark, second.mark, key=order.index))

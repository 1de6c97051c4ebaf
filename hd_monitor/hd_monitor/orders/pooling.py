"""Segments of a joint's motion pooled: whitened by what they show of the background, and fitted by direction."""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from .joint_segment import JointSegment
from .line_orders import LineOrders
from .regression import LineFit, Products, pool, solve
from .segment_products import products_of_segment, residual_of_segment
from .whitening import learn_whitening

LEAST_SHARE = 0.1
"""Part of the motion that a direction must have to count."""

RELEARN = 3.0
"""Growth of the data after which the background is learnt again."""


class GroupFit(NamedTuple):
    """Lines fitted to a group of segments: a direction, or half of the time if there is one direction only."""

    name: str
    segments: tuple[JointSegment, ...]
    fit: LineFit


@dataclass(slots=True, eq=False)
class _Pooled:
    """A segment with its products for each set of orders; None where these are too fast for the sampling rate."""

    segment: JointSegment
    products: list[Products | None]


class SegmentPool:
    """Keeps the newest segments, and their products for several sets of orders.

    Parameters
    ----------
    orders : sequence of LineOrders
        The first set decides what counts as background, and which segments count.
    memory : float
        Motion [s] that is kept.
    """

    def __init__(self, orders: Sequence[LineOrders], memory: float) -> None:
        self._orders = orders
        self._memory = memory
        self._pooled: deque[_Pooled] = deque()
        self._coefficients = np.ones(1)
        self._learnt = 0.0
        self._seen = 0.0

    @property
    def coefficients(self) -> FloatArray:
        """Of the whitening, as learnt last."""
        return self._coefficients

    @property
    def segments(self) -> list[JointSegment]:
        """Segments kept, the oldest first."""
        return [pooled.segment for pooled in self._pooled]

    @property
    def seconds(self) -> float:
        """Motion kept [s]."""
        return sum(pooled.segment.duration for pooled in self._pooled)

    def clear(self) -> None:
        """Forget the segments; what was learnt of the background stays."""
        self._pooled.clear()

    def add(self, segment: JointSegment) -> None:
        """Take a segment in; learn the background again when the data have grown much."""
        self._seen += segment.duration
        self._pooled.append(_Pooled(segment, []))
        held = self.seconds
        while len(self._pooled) > 1 and held - self._pooled[0].segment.duration >= self._memory:
            held -= self._pooled.popleft().segment.duration
        due = RELEARN * self._learnt if self._learnt < self._memory else self._learnt + self._memory
        outdated = [self._pooled[-1]]
        if self._seen >= due:
            self._learnt = self._seen
            self._coefficients = learn_whitening([residual_of_segment(s, self._orders[0]) for s in self.segments])
            outdated = list(self._pooled)
        for pooled in outdated:
            pooled.products = [
                products_of_segment(pooled.segment, orders, self._coefficients) for orders in self._orders
            ]

    def fits(self, number: int) -> list[GroupFit]:
        """Fit the lines of one set of orders, by its number, to every group of segments that determines them."""
        return [
            GroupFit(name, segments, fit)
            for name, segments, products in self.groups(number)
            if (fit := solve(products, self._orders[number])) is not None
        ]

    def groups(self, number: int) -> Iterator[tuple[str, tuple[JointSegment, ...], Products]]:
        """Yield name, segments and products of every group, for one set of orders by its number; none without that."""
        if number >= len(self._orders):
            return
        for name, group in self._groups():
            total = pool(products for pooled in group if (products := pooled.products[number]) is not None)
            if total is not None:
                yield name, tuple(pooled.segment for pooled in group), total

    def _groups(self) -> Iterator[tuple[str, list[_Pooled]]]:
        """Segments that are pooled coherently: by direction, or by time if there is one direction only."""
        usable = [pooled for pooled in self._pooled if pooled.products[0] is not None]
        total = _rows(usable)
        by_direction = {
            name: [pooled for pooled in usable if pooled.segment.direction == sign]
            for name, sign in (("forward", 1), ("reverse", -1))
        }
        kept = {name: group for name, group in by_direction.items() if _rows(group) >= max(LEAST_SHARE * total, 1)}
        if len(kept) == 2:
            yield from kept.items()
            return
        for name, group in kept.items():
            half = len(group) // 2
            if not half:
                yield name, group
            else:
                yield f"{name}, first half", group[:half]
                yield f"{name}, second half", group[half:]


def _rows(group: Sequence[_Pooled]) -> int:
    return sum(pooled.segment.values.size for pooled in group)

"""Segments summed up for every order of a range at once, so that any lines among them can be fitted afterwards."""

import math
from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray, IntArray
from ..robust import clip
from .joint_segment import HIGHEST_SHARE, LOWEST_FREQUENCY, JointSegment
from .orthonormal import project
from .regression import Products, pool
from .segment_products import trend_columns
from .whitening import learn_whitening, settled, whiten

CLIP = 4.0
"""Robust standard deviations at which the whitened signal is clipped before any line is known."""

TREND_ORDER = 10.0
"""Knots of the trend per output revolution: no line looked for is anywhere near."""

PARTS = 6
"""Parts at most in which the segments of a direction are pooled where they do not add up as a whole."""

PART_TRAVEL = math.tau
"""Least travel of a part [rad]: over less, a phase that drifts with the speed looks like another order."""


class OrderScan:
    """Products of segments with a line at every order of a range.

    Parameters
    ----------
    segments : sequence of JointSegment
    orders : ndarray of int, shape (orders,)
        Successive whole orders [cycles per output revolution].
    """

    def __init__(self, segments: Sequence[JointSegment], orders: IntArray) -> None:
        self._orders = orders
        trends = [trend_columns(segment, TREND_ORDER) for segment in segments]
        flat = [project(trend, segment.values[:, None])[:, 0] for trend, segment in zip(trends, segments, strict=True)]
        self._coefficients = learn_whitening(flat)
        self._usable = [
            (segment, trend)
            for segment, trend in zip(segments, trends, strict=True)
            if np.count_nonzero(settled(segment.starts, self._coefficients)) >= 4 * trend.shape[1]
        ]

    @property
    def highest(self) -> int:
        """Highest order of the range."""
        return int(self._orders[-1])

    def by_direction(self) -> list[Products]:
        """Sums over all segments of each direction: coherent in the absolute angle."""
        return self._pooled(1)

    def by_parts(self) -> list[Products]:
        """Sums over a few successive segments each, so that amplitudes and phases may change between them.

        Each covers a revolution or more; there are none where the joint does not turn that far.
        """
        return self._pooled(PARTS)

    def _pooled(self, parts: int) -> list[Products]:
        sums = []
        for direction in (1, -1):
            chosen = [number for number, (segment, _) in enumerate(self._usable) if segment.direction == direction]
            if not chosen:
                continue
            travel = float(np.ptp([self._usable[number][0].angle[[0, -1]] for number in chosen]))
            count = parts if parts == 1 else min(parts, int(travel / PART_TRAVEL))
            for group in np.array_split(chosen, count) if count else []:
                every = (self._products(*self._usable[number]) for number in group)
                total = pool(products for products in every if products is not None)
                if total is not None:
                    sums.append(total)
        return sums

    def _products(self, segment: JointSegment, trend: FloatArray) -> Products | None:
        """Products of every order's whitened columns where its frequency is in the band; None of a constant signal."""
        orders = self._orders.astype(np.float64)
        good = settled(segment.starts, self._coefficients)
        frequency = np.multiply.outer(segment.speed, orders) / math.tau
        band = (frequency >= LOWEST_FREQUENCY) & (frequency <= HIGHEST_SHARE * segment.rate)
        columns = np.column_stack([segment.columns(orders) * np.tile(band, 2), segment.values - segment.values.mean()])
        columns = project(whiten(self._coefficients, trend)[good], whiten(self._coefficients, columns)[good])
        columns[:, -1] = clip(columns[:, -1], CLIP)
        noise = math.sqrt(float(np.mean(columns[:, -1] ** 2)))
        if not noise > 0.0:
            return None
        return Products(orders=orders, matrix=columns.T @ columns / noise**2, rows=len(columns), noise=noise)

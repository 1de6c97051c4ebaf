"""Segments summed up for every order of a range at once, so that any lines among them can be fitted afterwards."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray, IntArray
from .gram import Gram, PairOrders, project, trend_columns
from .joint_segment import HIGHEST_SHARE, LOWEST_FREQUENCY, JointSegment
from .pair import LineSolution, solve_lines
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
    """Gram matrices of segments with a line at every order of a range.

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

    def by_direction(self) -> list[Gram]:
        """Sums over all segments of each direction: coherent in the absolute angle."""
        return self._pooled(1)

    def by_parts(self) -> list[Gram]:
        """Sums over a few successive segments each, so that amplitudes and phases may change between them.

        Each covers a revolution or more; there are none where the joint does not turn that far.
        """
        return self._pooled(PARTS)

    def _pooled(self, parts: int) -> list[Gram]:
        sums = []
        for direction in (1, -1):
            chosen = [number for number, (segment, _) in enumerate(self._usable) if segment.direction == direction]
            count = parts if parts == 1 else min(parts, int(self._travel(chosen) / PART_TRAVEL))
            for group in np.array_split(chosen, count) if chosen and count else []:
                total = self._sum(group.tolist())
                if total is not None:
                    sums.append(total)
        return sums

    def _travel(self, group: Sequence[int]) -> float:
        """Range of the output angle over these segments [rad]."""
        angles = [self._usable[number][0].angle[[0, -1]] for number in group]
        return float(np.ptp(angles)) if angles else 0.0

    def _sum(self, group: Iterable[int]) -> Gram | None:
        size = 2 * self._orders.size + 1
        products, rows, weight = np.zeros((size, size)), 0, 0.0
        for number in group:
            columns = self._columns(*self._usable[number])
            power = float(columns[:, -1] @ columns[:, -1]) / len(columns)
            if power > 0.0:
                products += columns.T @ columns / power
                rows, weight = rows + len(columns), weight + len(columns) / power
        return Gram(products=products, rows=rows, noise=math.sqrt(rows / weight)) if rows else None

    def _columns(self, segment: JointSegment, trend: FloatArray) -> FloatArray:
        """Whitened columns of every order and the signal, where the order's frequency is in the band."""
        orders = self._orders.astype(np.float64)
        good = settled(segment.starts, self._coefficients)
        frequency = np.multiply.outer(segment.speed, orders) / math.tau
        band = (frequency >= LOWEST_FREQUENCY) & (frequency <= HIGHEST_SHARE * segment.rate)
        columns = np.column_stack([segment.columns(orders) * np.tile(band, 2), segment.values - segment.values.mean()])
        columns = project(whiten(self._coefficients, trend)[good], whiten(self._coefficients, columns)[good])
        limit = CLIP * float(np.median(np.abs(columns[:, -1]))) / 0.6745
        columns[:, -1] = np.clip(columns[:, -1], -limit, limit)
        return columns

    def solve(self, orders: PairOrders, part: Gram) -> LineSolution | None:
        """Fit lines with their reference orders out of a sum; None where the range does not hold or determine them."""
        scanned = self._orders
        reference_orders = orders.reference_orders[
            (orders.reference_orders >= scanned[0]) & (orders.reference_orders <= scanned[-1])
        ]
        wanted = np.concatenate([orders.lines, reference_orders])
        if orders.lines.min() < scanned[0] or orders.lines.max() > scanned[-1] or (wanted != np.rint(wanted)).any():
            return None
        place = np.rint(wanted).astype(np.int64) - scanned[0]
        lines, floor = place[: orders.lines.size], place[orders.lines.size :]
        index = np.concatenate([lines, lines + scanned.size, floor, floor + scanned.size, [2 * scanned.size]])
        return solve_lines(part.products[np.ix_(index, index)], replace(orders, reference_orders=reference_orders))

"""Strokes summed up for every order of a range at once, so that any lines among them can be fitted afterwards."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray, IntArray
from .gram import Gram, PairOrders, project, trend_columns
from .joint_segment import HIGHEST_SHARE, LOWEST_FREQUENCY, Stroke
from .pair import LineSolution, solve_lines
from .whitening import learn_whitening, settled, whiten

CLIP = 4.0
"""Robust standard deviations at which the whitened signal is clipped before any line is known."""

TREND_ORDER = 10.0
"""Knots of the trend per output revolution: no line looked for is anywhere near."""

PARTS = 6
"""Parts at most in which the strokes of a direction are pooled where they do not add up as a whole."""

PART_TRAVEL = math.tau
"""Least travel of a part [rad]: over less, a phase that drifts with the speed looks like another order."""


class OrderScan:
    """Gram matrices of strokes with a line at every order of a range.

    Parameters
    ----------
    strokes : sequence of Stroke
    orders : ndarray of int, shape (orders,)
        Successive whole orders [cycles per output revolution].
    """

    def __init__(self, strokes: Sequence[Stroke], orders: IntArray) -> None:
        self._orders = orders
        trends = [trend_columns(stroke, TREND_ORDER) for stroke in strokes]
        flat = [project(trend, stroke.values[:, None])[:, 0] for trend, stroke in zip(trends, strokes, strict=True)]
        self._coefficients = learn_whitening(flat)
        self._usable = [
            (stroke, trend)
            for stroke, trend in zip(strokes, trends, strict=True)
            if np.count_nonzero(settled(stroke.starts, self._coefficients)) >= 4 * trend.shape[1]
        ]

    @property
    def highest(self) -> int:
        """Highest order of the range."""
        return int(self._orders[-1])

    def by_direction(self) -> list[Gram]:
        """Sums over all strokes of each direction: coherent in the absolute angle."""
        return self._pooled(1)

    def by_parts(self) -> list[Gram]:
        """Sums over a few successive strokes each, so that amplitudes and phases may change between them.

        Each covers a revolution or more; there are none where the joint does not turn that far.
        """
        return self._pooled(PARTS)

    def _pooled(self, parts: int) -> list[Gram]:
        sums = []
        for direction in (1, -1):
            chosen = [number for number, (stroke, _) in enumerate(self._usable) if stroke.direction == direction]
            count = parts if parts == 1 else min(parts, int(self._travel(chosen) / PART_TRAVEL))
            for group in np.array_split(chosen, count) if chosen and count else []:
                total = self._sum(group.tolist())
                if total is not None:
                    sums.append(total)
        return sums

    def _travel(self, group: Sequence[int]) -> float:
        """Range of the output angle over these strokes [rad]."""
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

    def _columns(self, stroke: Stroke, trend: FloatArray) -> FloatArray:
        """Whitened columns of every order and the signal, where the order's frequency is in the band."""
        orders = self._orders.astype(np.float64)
        good = settled(stroke.starts, self._coefficients)
        frequency = np.multiply.outer(stroke.speed, orders) / math.tau
        band = (frequency >= LOWEST_FREQUENCY) & (frequency <= HIGHEST_SHARE * stroke.rate)
        columns = np.column_stack([stroke.columns(orders) * np.tile(band, 2), stroke.values - stroke.values.mean()])
        columns = project(whiten(self._coefficients, trend)[good], whiten(self._coefficients, columns)[good])
        limit = CLIP * float(np.median(np.abs(columns[:, -1]))) / 0.6745
        columns[:, -1] = np.clip(columns[:, -1], -limit, limit)
        return columns

    def solve(self, orders: PairOrders, part: Gram) -> LineSolution | None:
        """Fit lines with their placebo orders out of a sum; None where the range does not hold or determine them."""
        scanned = self._orders
        placebos = orders.placebos[(orders.placebos >= scanned[0]) & (orders.placebos <= scanned[-1])]
        wanted = np.concatenate([orders.lines, placebos])
        if orders.lines.min() < scanned[0] or orders.lines.max() > scanned[-1] or (wanted != np.rint(wanted)).any():
            return None
        place = np.rint(wanted).astype(np.int64) - scanned[0]
        lines, floor = place[: orders.lines.size], place[orders.lines.size :]
        index = np.concatenate([lines, lines + scanned.size, floor, floor + scanned.size, [2 * scanned.size]])
        return solve_lines(part.products[np.ix_(index, index)], replace(orders, placebos=placebos))

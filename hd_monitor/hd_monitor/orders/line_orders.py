"""Which orders a regression on lines looks at together: the lines, others fitted along, and where there is none."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray, IntArray
from ..reducer import LinePair

REFERENCES = 12
"""Reference orders on either side of a line: the noise floor is what a fit finds there."""

FLOOR_REACH = 0.15
"""Part of the lowest line's order within which they stay, five in any case."""

TREND_CYCLES = 5.0
"""Cycles of the first pair between two knots of the trend: a spline of that flexibility cannot follow the lines."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LineOrders:
    """Orders [cycles per revolution] that a regression looks at together.

    Attributes
    ----------
    lines : ndarray, shape (lines,)
        Lines wanted; of a pair, the circular spline's first.
    nuisance : ndarray
        Lines fitted along, such as the motor's.
    reference_orders : ndarray
        Where there is no line.
    spacing : float
        Distance of the reference orders from each other.
    trend : float
        Order up to which a trend follows the signal; 0 if there is none.
    """

    lines: FloatArray
    nuisance: FloatArray
    reference_orders: FloatArray
    spacing: float
    trend: float = 0.0

    @classmethod
    def around(
        cls, lines: npt.ArrayLike, spacing: float, *, nuisance: Iterable[float] = (), trend: float = 0.0
    ) -> "LineOrders":
        """Choose reference orders around lines, away from these and from the nuisance lines."""
        wanted = np.asarray(lines, dtype=np.float64)
        others = np.array([order for order in nuisance if np.abs(wanted - order).min() > 1e-6])
        lowest, highest = float(wanted.min()), float(wanted.max())
        count = max(5, min(REFERENCES, int(FLOOR_REACH * lowest / spacing)))
        reference = lowest + spacing * np.arange(-count, (highest - lowest) / spacing + count + 0.5)
        distance = np.abs(np.subtract.outer(reference, wanted)).min(axis=1) / spacing
        clear = (distance > 0.99) & (distance < count + 0.5) & (reference > spacing)
        for order in others:
            clear &= np.abs(reference - order) > 0.5 * spacing
        return cls(lines=wanted, nuisance=others, reference_orders=reference[clear], spacing=spacing, trend=trend)

    @classmethod
    def of_pair(cls, pair: LinePair, k: int = 1, motor: Iterable[float] = ()) -> "LineOrders":
        """Choose orders for the k-th multiple of the first `pair`; the motor's lines are fitted along."""
        return cls.around(
            [k * pair.circular_spline, k * pair.flexspline],
            k * (pair.flexspline - pair.circular_spline),
            nuisance=motor,
            trend=pair.circular_spline / TREND_CYCLES,
        )

    @property
    def every(self) -> FloatArray:
        """All orders, shape (orders,): the lines, the nuisance lines, the references. Columns come in this order."""
        return np.concatenate([self.lines, self.nuisance, self.reference_orders])

    @property
    def fitted_columns(self) -> IntArray:
        """Columns of the lines and the nuisance lines: their cosines, then their sines."""
        return self._columns(0, self.lines.size + self.nuisance.size)

    @property
    def reference_columns(self) -> IntArray:
        """Columns of the reference orders: their cosines, then their sines."""
        return self._columns(self.lines.size + self.nuisance.size, self.every.size)

    def _columns(self, first: int, last: int) -> IntArray:
        return np.add.outer([0, self.every.size], np.arange(first, last)).ravel()

"""Which tooth pairs are compared, and which multiples of their lines count."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...orders.line_orders import LineOrders
from ...orders.order_spectrum import HIGHEST_ORDER
from ...reducer import WAVE_GENERATOR_LOBES, LinePair, Mount, Reducer

TOOTH_RANGE = (60, 320)
"""Flexspline teeth looked at: reductions 30 to 160, as catalogues have them."""

CATALOGUE_REDUCTIONS = (30, 50, 80, 100, 120, 160)
"""Reductions z1/2 in the catalogues of strain wave gears (CSF, CSG, SHF and their like); 99 or 101 are none."""

ENCODER_ORDERS = (64, 128, 256, 512)
"""Periods per revolution of common encoders, whose interpolation errors show as lines, with sidebands beside."""

MOTOR_REACH = 4
"""Orders around the motor's in which load fluctuations and the coupling with the lines put lines, too."""

NEIGHBOURS = (-4, -3, -2, -1, 1, 2, 3, 4)
"""Tooth numbers, relative to those given, that share a line with them or lie where travel does not separate them."""

STRONGEST = 4
"""Pairs with the strongest lines that are compared with the one given."""


class ToothPair(NamedTuple):
    """Teeth of the flexspline, z1, and of the circular spline, z2."""

    flexspline: float
    circular_spline: float

    def __str__(self) -> str:
        """Return the teeth as technicians write them, 200/202."""
        return f"{self.flexspline:g}/{self.circular_spline:g}"

    @classmethod
    def of(cls, reducer: Reducer) -> "ToothPair":
        """Return the pair, two teeth apart, whose lines are those of a reducer."""
        return cls(*reducer.output_orders)

    def reducer(self, mount: Mount) -> Reducer:
        """Return a reducer with these teeth."""
        return Reducer(flexspline_teeth=int(self[0]), circular_spline_teeth=int(self[1]), mount=mount)

    def lines(self, k: float = 1.0) -> LinePair:
        """Orders [cycles per output revolution] of the k-th pair of lines; k = 1/2 are the motor's, in either mount."""
        return LinePair(k * self.flexspline, k * self.circular_spline)

    @property
    def is_in_catalogue(self) -> bool:
        """Whether catalogues list the reduction."""
        return 0.5 * self.flexspline in CATALOGUE_REDUCTIONS

    def doubled(self) -> tuple["ToothPair", ...]:
        """Return the pairs, in either mount, whose motor turns once for a cycle of one of the two lines."""
        teeth = sorted({2.0 * line + shift for line in self for shift in (-WAVE_GENERATOR_LOBES, 0)})
        return tuple(ToothPair(z, z + WAVE_GENERATOR_LOBES) for z in teeth if z <= TOOTH_RANGE[1])

    @property
    def is_beside_encoder(self) -> bool:
        """Whether the lines lie where an encoder's own errors would."""
        return any(self.flexspline - 1 <= order <= self.circular_spline + 1 for order in ENCODER_ORDERS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A tooth pair, and the pairs of lines that support it.

    Attributes
    ----------
    teeth : ToothPair
    multiples : tuple of float
        Numbers k of the pairs of lines that count.
    further : tuple of float
        Those that count only once a line of `multiples` is found.
    """

    teeth: ToothPair
    multiples: tuple[float, ...] = (1.0,)
    further: tuple[float, ...] = ()


def every_pair() -> list[ToothPair]:
    """Every pair with two teeth of difference whose reduction catalogues have, by rising tooth numbers."""
    return [ToothPair(teeth, teeth + WAVE_GENERATOR_LOBES) for teeth in range(TOOTH_RANGE[0], TOOTH_RANGE[1] + 1)]


def with_neighbours(given: Reducer) -> list[Candidate]:
    """Return the pair given and those near it, by their first lines."""
    own = ToothPair.of(given)
    return [Candidate(teeth=ToothPair(*(order + shift for order in own))) for shift in (0, *NEIGHBOURS)]


def surroundings(candidates: Sequence[Candidate], motor: Iterable[float]) -> LineOrders:
    """Return all orders that the first lines of the candidates and their noise floors take, the motor's fitted along.

    The first candidate's lines are fitted, too: they are the likeliest.
    """
    each = [LineOrders.of_pair(candidate.teeth.lines(), motor=motor) for candidate in candidates]
    fitted = np.concatenate([each[0].lines, each[0].nuisance])
    orders = np.unique(np.concatenate([part for one in each for part in (one.lines, one.reference_orders)]))
    return replace(each[0], reference_orders=orders[np.abs(np.subtract.outer(orders, fitted)).min(axis=1) > 1e-6])


def strongest(amplitudes: FloatArray, given: Reducer, harmonics: int) -> list[Candidate]:
    """Return the pair given and those whose lines stand out most, in the order of their tooth numbers.

    Parameters
    ----------
    amplitudes : ndarray, shape (orders,)
        Of the vibration at the orders 0, 1, 2 …
    given : Reducer
    harmonics : int
        Pairs of lines that count.
    """
    # logarithms, so that a single strong tone does not fill the list with all pairs that have a line there
    heights = np.log1p((amplitudes / np.median(amplitudes[TOOTH_RANGE[0] :])) ** 2)
    own = ToothPair.of(given)
    score = {}
    for teeth in every_pair():
        counted = [k for k in range(1, harmonics + 1) if not _beside_motor(teeth.lines(k), given)]
        orders = [int(order) for k in counted for order in teeth.lines(k) if order <= HIGHEST_ORDER]
        if orders and teeth != own:
            score[Candidate(teeth=teeth, multiples=tuple(map(float, counted)))] = float(heights[orders].sum())
    chosen = sorted(score, key=lambda candidate: -score[candidate])[:STRONGEST]
    everything = Candidate(teeth=own, multiples=tuple(float(k) for k in range(1, harmonics + 1)))
    return sorted([everything, *chosen], key=lambda candidate: candidate.teeth)


def _beside_motor(lines: Iterable[float], given: Reducer) -> bool:
    """Whether an order is the motor's, whose ripple the stiffness' lines shift, too."""
    lower, upper = (0.5 * line for line in given.output_orders)
    return any(j * lower - MOTOR_REACH <= order <= j * upper + MOTOR_REACH for order in lines for j in (1, 3, 5))

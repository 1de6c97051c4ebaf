"""Which tooth numbers, other than those given, could make the lines that the model leaves unexplained."""

import itertools
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ...orders.line_orders import LineOrders
from ...orders.regression import solve
from ...orders.spectrum import HIGHEST_ORDER, OrderSpectrum
from ...reducer import LinePair, Reducer
from .ranking import TOOTH_RANGE

LEAST_TURNS = 0.2
"""Output revolutions below which the order spectrum is too blurred to suspect anything."""

CHANCE = 1e-6
"""Probability of noise making a line as large, below which the line counts as found; many pairs are looked at."""

APART = 0.75
"""Output revolutions from which the two lines of the first pair are looked for as two: half a one more than Fourier."""

SHARE = 0.02
"""Part of the largest line that an unexplained one must have to matter."""

MOTOR_REACH = 4
"""Orders around the motor's in which load fluctuations and the coupling with the lines put lines, too."""

_STANDS_OUT = 5.0  # medians of the spectrum: 3e-8 by chance
_LOWEST_ORDER = 20  # gravity, friction and the load's own orders lie below
_REFERENCES = 8.0  # orders on either side that the noise floor is taken from
_MOST, _MOST_BLURRED = 2, 4


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothSuspect:
    """Tooth numbers that could explain what those given do not.

    Attributes
    ----------
    reducer : Reducer
        In the mount given, which the lines do not tell.
    lines : tuple of float
        Orders [cycles per output revolution] of its lines that were found; none where travel does not part them.
    evident : bool
        Whether lines that the given teeth do not have were found one by one.
    """

    reducer: Reducer
    lines: tuple[float, ...]
    evident: bool


def unexplained(signal: OrderSpectrum, residual: OrderSpectrum) -> bool:
    """Whether the residual has a line that noise does not make, of a size that matters."""
    if signal.turns < LEAST_TURNS:
        return False
    left = residual.amplitudes[_LOWEST_ORDER:]
    return float(left.max()) > max(
        _STANDS_OUT * float(np.median(left)), SHARE * float(signal.amplitudes[_LOWEST_ORDER:].max())
    )


def tooth_suspects(
    signal: OrderSpectrum, given: Reducer, harmonics: int, *, one_speed: bool
) -> tuple[ToothSuspect, ...]:
    """Tooth numbers with lines of their own, the likeliest first.

    Parameters
    ----------
    signal : OrderSpectrum
        Of the vibration as measured.
    given : Reducer
    harmonics : int
        Line pairs looked for.
    one_speed : bool
        Whether all of the motion was at one speed: then a tone of fixed frequency looks like one line, and only both
        lines of a pair are evidence. Else any two lines are.
    """
    amplitudes = signal.amplitudes
    teeth = np.arange(TOOTH_RANGE[0], min(TOOTH_RANGE[1], HIGHEST_ORDER - 2) + 1)
    power = np.zeros(teeth.size)
    for k in range(1, harmonics + 1):
        for line in (k * teeth, k * (teeth + 2)):
            power += np.where(line <= HIGHEST_ORDER, amplitudes[np.minimum(line, HIGHEST_ORDER)] ** 2, 0.0)
    best = [int(teeth[place]) for place in np.argsort(-power).tolist()]
    reducers = [_like(given, z1) for z1 in best[: 4 * _MOST] if abs(z1 - given.output_orders.circular_spline) > 1e-6]
    found = {reducer: _found_lines(signal, reducer, given, harmonics) for reducer in reducers}
    evident = [reducer for reducer in reducers if _is_pair(found[reducer], one_speed)]
    if not evident and one_speed:
        return ()
    # Neighbours share lines: which of them explains the whole, or at changing speed anything, the model must tell.
    likeliest = [reducer for reducer in reducers if not _beside_motor(reducer.output_orders.circular_spline, given)]
    most = _MOST if evident else _MOST_BLURRED
    chosen = list(dict.fromkeys([*evident[:1], *likeliest[:most]]))[:most]
    return tuple(
        ToothSuspect(reducer=reducer, lines=tuple(itertools.chain.from_iterable(found[reducer])), evident=bool(evident))
        for reducer in chosen
    )


def _found_lines(signal: OrderSpectrum, reducer: Reducer, given: Reducer, harmonics: int) -> list[tuple[float, ...]]:
    """Orders of the lines found of each pair of some teeth."""
    return [_found(signal, reducer, given, k) for k in range(1, harmonics + 1)]


def _is_pair(found: list[tuple[float, ...]], one_speed: bool) -> bool:
    """Whether so many lines belong to some teeth, and to nothing else that turns or hums."""
    return any(len(lines) == 2 for lines in found) or (not one_speed and sum(map(bool, found)) > 1)


def _like(given: Reducer, flexspline_teeth: int) -> Reducer:
    """The reducer with other tooth numbers, two apart."""
    return Reducer(flexspline_teeth=flexspline_teeth, circular_spline_teeth=flexspline_teeth + 2, mount=given.mount)


def _found(signal: OrderSpectrum, reducer: Reducer, given: Reducer, k: int) -> tuple[float, ...]:
    """Orders of the k-th pair at which a line was found: both, or the one that travel cannot part from the other."""
    pair = LinePair(*(k * order for order in reducer.output_orders))
    if pair.flexspline + _REFERENCES > HIGHEST_ORDER:
        return ()
    if any(_beside_motor(order, given) for order in pair):
        return ()
    if signal.turns > APART / k:
        both = _chances(signal, pair, given)
        return tuple(line for line, chance in zip(pair, both, strict=True) if chance < CHANCE)
    alone = {line: _chances(signal, (line,), given)[0] for line in pair}
    best = min(alone, key=lambda line: alone[line])
    return (best,) if alone[best] < CHANCE else ()


def _beside_motor(order: float, given: Reducer) -> bool:
    """Whether an order is the motor's, whose ripple the stiffness' lines shift, too."""
    lower, upper = (0.5 * line for line in given.output_orders)
    return any(j * lower - MOTOR_REACH <= order <= j * upper + MOTOR_REACH for j in (1, 3, 5))


def _chances(signal: OrderSpectrum, lines: tuple[float, ...], given: Reducer) -> tuple[float, ...]:
    """Probability for each line that noise alone makes it this large; 1 where the travel does not determine it."""
    low, high = min(lines), max(lines)
    apart = max(1.0, 0.5 / signal.turns)
    offsets = 0.5 * np.arange(1.0, 2.0 * _REFERENCES * apart + 1.0)
    around = np.concatenate([low - offsets[::-1], high + offsets])
    own = _given_lines(given)
    near = own[(own > around[0]) & (own < around[-1]) & (np.abs(np.subtract.outer(own, lines)).min(axis=1) > 1e-6)]
    nuisance = np.concatenate([near, [n for n in np.arange(low - 2.0, high + 3.0) if n not in lines and n not in near]])
    if signal.turns < 1.0:
        nuisance = near if signal.turns > 0.5 else np.zeros(0)
    taken = np.concatenate([np.asarray(lines), nuisance])
    reference_orders = around[(np.abs(np.subtract.outer(around, taken)).min(axis=1) > 0.4) & (around > 2.0)]
    orders = LineOrders(lines=np.asarray(lines), nuisance=nuisance, reference_orders=reference_orders, spacing=2.0)
    fit = solve(signal.products(orders.every), orders)
    return (1.0,) * len(lines) if fit is None else tuple(fit.chances.tolist())


def _given_lines(given: Reducer) -> FloatArray:
    """Orders of the lines of the teeth given and of the motor that turns them."""
    lower, upper = given.output_orders
    motor = given.reduction
    pairs = [k * order for k in range(1, 5) for order in (lower, upper)]
    return np.unique(np.array([order for order in [*pairs, motor, 3.0 * motor] if order <= HIGHEST_ORDER]))

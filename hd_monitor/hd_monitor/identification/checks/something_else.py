"""Vibration that the model leaves unexplained: at which orders and frequencies, how strong, and from where."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ...arrays import BoolArray
from ...orders.order_spectrum import OrderSpectrum
from ...reducer import WAVE_GENERATOR_LOBES, Reducer
from .tone_watch import ToneWatch

MOST = 6
"""Rows that are listed at most, the strongest."""

LEAST_SHARE = 1e-3
"""Part of the vibration's power from which something is worth a row."""

WAVE_GENERATOR_ORDERS = (1.0, WAVE_GENERATOR_LOBES + 1.0)
RIPPLE_ORDERS = (2.0, 6.0, 12.0)
"""Cycles per motor revolution of a wave generator that runs out, as 2 ± 1, and of a motor's torque ripple."""

MAINS = (50.0, 60.0)
"""[Hz]"""

_STANDS_OUT = 5.0  # medians of the orders around: 3e-8 by chance
_MATTERS = 0.2  # of the strongest row's amplitude: what is weaker may be its side lines or its leakage
_NEAR = 10.0  # widths of a line within which only the largest order counts
_BLOCK = 256  # orders over which the median is taken, so that a line's own leakage hardly lifts it
_KNOWN = 0.3  # of a tone's amplitude from which it is the line of a known source, which is loudest near the resonance
_SLOW = 0.75  # of the mean speed: an order that is too high to be heard even then is hardly real
_LOWEST_ORDER = 20  # gravity, friction and the load's own orders lie below
_BESIDE = 3.0  # orders beside a pair of lines that the check of the residual looks at
_LEAST_TURNS = 0.2  # output revolutions below which orders are too blurred
_MAINS_WANDERS = 0.01  # of its frequency, and as much of its multiples


class Source(StrEnum):
    """Where vibration that is none of the splines' lines may come from."""

    WAVE_GENERATOR = "wave_generator"
    MOTOR_RIPPLE = "motor_ripple"
    MAINS = "mains"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True, kw_only=True)
class SomethingElse:
    """A line that the model does not explain.

    Attributes
    ----------
    source : Source
        The likely one.
    order : float or None
        Cycles per output revolution; None for a fixed frequency.
    frequency : float or None
        [Hz]; None for a line that follows the joint's angle. At one speed both are there: it may be either.
    amplitude : float
        [rad/s²]
    share : float
        Part of the vibration's power.
    """

    source: Source
    order: float | None
    frequency: float | None
    amplitude: float
    share: float


def something_else(
    signal: OrderSpectrum,
    residual: OrderSpectrum,
    watch: ToneWatch,
    reducer: Reducer,
    harmonics: int,
    mean_speed: float,
    highest_frequency: float,
    *,
    one_speed: bool,
) -> tuple[SomethingElse, ...]:
    """List what the model leaves unexplained, the strongest first.

    A line that follows the angle is sharp over orders and smears over frequencies as the speed changes, a tone of fixed
    frequency the other way round: the sharper view shows the larger amplitude.

    Parameters
    ----------
    signal, residual : OrderSpectrum
        Of the vibration, and of what fits leave of it.
    watch : ToneWatch
    reducer : Reducer
    harmonics : int
        Line pairs of the model; what is left beside them is the model's own misfit.
    mean_speed : float
        Of the output [rad/s].
    highest_frequency : float
        Up to which the samples can be trusted [Hz]; the images of lines below it stand beyond.
    one_speed : bool
        Whether the speed hardly varied; then orders and frequencies are not distinguished.
    """
    own, width = _own_lines(reducer, harmonics, residual), _width(residual)
    highest = math.tau * highest_frequency / (mean_speed if one_speed else _SLOW * mean_speed)
    orders = {order: amplitude for order, amplitude in _orders_left(residual, own) if order <= highest}
    found: list[tuple[float | None, float | None, float]] = []

    def needed(order: int) -> float:
        return 1.0 if _source(order, None, reducer, harmonics, 0.5 * width) is Source.UNKNOWN else _KNOWN

    for tone in watch.lasting:
        low, high = tone.orders
        rivals = [order for order in orders if low - 1.0 <= order <= high + 1.0]
        if tone.at_one_speed:
            if not one_speed or own[min(round(low), own.size - 1)]:
                continue  # what is not heard at other speeds follows the angle
            found.append((0.5 * (low + high), tone.frequency, tone.amplitude))
        elif any(orders[order] >= needed(order) * tone.amplitude for order in rivals):
            continue
        else:
            found.append((None, tone.frequency, tone.amplitude))
        for order in rivals:
            del orders[order]
    for order, amplitude in orders.items():
        found.append((float(order), order * mean_speed / math.tau if one_speed else None, amplitude))

    power = max(signal.power / max(float(signal.counts.sum()), 1.0), 1e-300)
    least = max(_MATTERS * max((line[2] for line in found), default=0.0), math.sqrt(2.0 * LEAST_SHARE * power))
    rows = [
        SomethingElse(
            source=_source(order, frequency, reducer, harmonics, 0.5 * width),
            order=order,
            frequency=frequency,
            amplitude=amplitude,
            share=min(0.5 * amplitude**2 / power, 1.0),
        )
        for order, frequency, amplitude in found
        if amplitude >= least
    ]
    return tuple(sorted(rows, key=lambda row: -row.amplitude)[:MOST])


def _width(spectrum: OrderSpectrum) -> float:
    """Width of a line [orders], by the travel."""
    return 1.0 / max(min(spectrum.turns, 1.0), _LEAST_TURNS)


def _own_lines(reducer: Reducer, harmonics: int, spectrum: OrderSpectrum) -> BoolArray:
    """Orders at and beside the lines that the model has, shape (orders,)."""
    orders, beside = np.arange(spectrum.every_amplitude.size), _BESIDE + _width(spectrum)
    own = np.zeros(orders.size, dtype=np.bool_)
    for k in range(1, harmonics + 1):
        low, high = (k * line for line in reducer.output_orders)
        own |= (orders >= low - beside) & (orders <= high + beside)
    return own


def _orders_left(spectrum: OrderSpectrum, own: BoolArray) -> Iterator[tuple[int, float]]:
    """Orders that stand out of a residual's spectrum, with their amplitudes [rad/s²]; the strongest first."""
    if spectrum.turns < _LEAST_TURNS:
        return
    amplitudes = spectrum.every_amplitude
    blocks = np.array_split(amplitudes, amplitudes.size // _BLOCK)
    floor = np.concatenate([np.full(block.size, np.median(block)) for block in blocks])
    free = (amplitudes > _STANDS_OUT * floor) & ~own
    free[:_LOWEST_ORDER] = False
    near = math.ceil(_NEAR * _width(spectrum))
    for _ in range(MOST):
        order = int(np.argmax(np.where(free, amplitudes, 0.0)))
        if not free[order]:
            return
        around = slice(max(order - near, _LOWEST_ORDER), order + near + 1)
        if not (own[around] & (amplitudes[around] > amplitudes[order])).any():  # else it may leak from there
            yield order, float(amplitudes[order])
        free[around] = False


def _source(order: float | None, frequency: float | None, reducer: Reducer, harmonics: int, tolerance: float) -> Source:
    """Return the likely source of a line, its order known to a tolerance."""
    if order is not None:
        motor = WAVE_GENERATOR_LOBES * reducer.reduction
        # Of the lines that the stiffness puts beside a source's own, those of the spline that the motor does not share
        line = max(reducer.output_orders, key=lambda line: abs(line - motor))
        for aside in (0.0, *(sign * k * line for k in range(1, harmonics + 1) for sign in (-1.0, 1.0))):
            for source, known in ((Source.WAVE_GENERATOR, WAVE_GENERATOR_ORDERS), (Source.MOTOR_RIPPLE, RIPPLE_ORDERS)):
                if any(abs(order - abs(reducer.reduction * each + aside)) <= tolerance for each in known):
                    return source
    if frequency is not None:
        for mains in MAINS:
            multiple = max(round(frequency / mains), 1) * mains
            if abs(frequency - multiple) <= _MAINS_WANDERS * mains:
                return Source.MAINS
    return Source.UNKNOWN

"""What a kind of programme is, and the pieces that its corners are made of."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hd_monitor.arrays import FloatArray
from hd_monitor.parameter import Parameter, number
from hd_monitor.reducer import Reducer


class Setup(NamedTuple):
    """What the corners of a programme depend on besides its own parameters."""

    reducer: Reducer
    closed: bool
    """Whether the cycle must end at its first speed."""
    seed: int
    """Of the random numbers."""


class Corners(NamedTuple):
    """Times [s], wave-generator speeds [rpm] and the fraction of the payload carried, at each corner."""

    times: npt.ArrayLike
    speeds: npt.ArrayLike
    carried: npt.ArrayLike | None = None


class ProgrammeKind(NamedTuple):
    """A kind of programme."""

    summary: str
    """What the wave generator does, in words."""
    parameters: tuple[Parameter, ...]
    corners: Callable[..., Corners]
    """From the :class:`Setup` and the parameters' values as keywords."""


class Piece(NamedTuple):
    """A straight line of the speed."""

    duration: float
    """[s]"""
    speed: float
    """Wave-generator speed [rpm] at its end."""
    carried: float = 0.0
    """Fraction of the payload at its end."""


def chain(start: float, pieces: Sequence[Piece] | FloatArray) -> Corners:
    """Join pieces to corners from a start speed [rpm] without payload; those without duration vanish."""
    durations, speeds, carried = np.array(pieces, dtype=np.float64).T
    times = np.concatenate([[0.0], np.cumsum(np.maximum(durations, 0.0))])
    lasts = np.append(True, np.diff(times) > 0.0)
    return Corners(times[lasts], np.append(start, speeds)[lasts], np.append(0.0, carried)[lasts])


def stroke(reducer: Reducer, angle: float, speed: float, acceleration: float, *, carried: float = 0.0) -> list[Piece]:
    """Move the output by `angle` [deg], signed, from standstill to standstill.

    `speed` [rpm] and `acceleration` [rpm/s] are the wave generator's; `carried` is the fraction of the payload.
    """
    revolutions = abs(angle) / 360.0 * reducer.reduction
    # A short stroke brakes before it has reached its speed: v² / (60 a) revolutions go into the two ramps.
    reachable = math.sqrt(60.0 * acceleration * revolutions)
    peak = min(speed, reachable)
    ramp = peak / acceleration
    hold = 60.0 * revolutions / peak - ramp if peak < reachable else 0.0
    top = math.copysign(peak, angle)
    return [Piece(ramp, top, carried), Piece(hold, top, carried), Piece(ramp, 0.0, carried)]


def strokes(
    reducer: Reducer, moves: Iterable[tuple[float, float]], *, acceleration: float, pause: float
) -> list[Piece]:
    """Make a stroke of each (angle [deg], speed [rpm]), with `pause` [s] of standstill after it."""
    return [
        piece for angle, speed in moves for piece in (*stroke(reducer, angle, speed, acceleration), Piece(pause, 0.0))
    ]


def speeds_between(first: float, last: float, step: float) -> list[float]:
    """Speeds [rpm] from `first` towards `last` in steps."""
    count = math.floor(abs(last - first) / step + 1e-9) + 1
    return [first + math.copysign(step * i, last - first) for i in range(count)]


def speed_parameter[T: (float, tuple[float, ...])](default: T, description: str, *, low: float = -20_000.0) -> T:
    """Declare a speed of the wave generator."""
    return number(default, "rpm", low, 20_000.0, f"wave generator: {description}")


def rate_parameter(default: float, description: str) -> float:
    """Declare an acceleration of the wave generator."""
    return number(default, "rpm/s", 1e-3, 1e6, f"wave generator: {description}")

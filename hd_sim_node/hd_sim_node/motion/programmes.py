"""The speed programmes to choose from: name, parameters and corners of each.

A new programme is one function and one entry of :data:`PROGRAMMES`.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from hd_monitor.errors import ParameterError
from hd_monitor.parameter import Parameter, number, table
from hd_monitor.reducer import Reducer

from .programme import NO_RIPPLE, Ripple, SpeedProgramme

Corners = tuple[list[float], list[float]]
"""Times [s] and wave-generator speeds [rpm]."""


def _speed[T: (float, tuple[float, ...])](default: T, description: str) -> T:
    return number(default, "rpm", -20_000.0, 20_000.0, f"wave generator: {description}")


def _rate(default: float, description: str) -> float:
    return number(default, "rpm/s", 1e-3, 1e6, f"wave generator: {description}")


class ProgrammeKind(NamedTuple):
    """A kind of programme."""

    summary: str
    """What the wave generator does, in words."""
    parameters: tuple[Parameter, ...]
    corners: Callable[..., Corners]
    """From the reducer, whether the cycle must end at its first speed, and the parameters' values as keywords."""


def build_programme(
    name: str, values: Mapping[str, Any], reducer: Reducer, *, cycles: int = 0, ripple: Ripple = NO_RIPPLE
) -> SpeedProgramme:
    """Build the programme called `name`.

    Parameters
    ----------
    name : str
        One of :data:`PROGRAMMES`.
    values : mapping
        Values of its parameters by full name, as ``dwell.step``; other names are ignored.
    reducer : Reducer
    cycles : int
        How often it is run through; 0: without end.
    ripple : Ripple, optional

    Raises
    ------
    ParameterError
        If the values do not make a programme.
    """
    kind = PROGRAMMES[name]
    own = {p.name.partition(".")[2]: values.get(p.name, p.default) for p in kind.parameters}
    times, speeds = kind.corners(reducer, cycles != 1, **own)
    return SpeedProgramme(times=times, speeds=speeds, cycles=cycles, ripple=ripple)


def _chain(start: float, *pieces: tuple[float, float]) -> Corners:
    """Make corners from a start speed and pieces (duration [s], final speed [rpm]); those without duration vanish."""
    times, speeds = [0.0], [start]
    for duration, speed in pieces:
        if times[-1] + duration > times[-1]:
            times.append(times[-1] + duration)
            speeds.append(speed)
    return times, speeds


def _dwell(
    _: Reducer, closed: bool, *, first: float, last: float, step: float, time: float, ramp_rate: float
) -> Corners:
    count = math.floor(abs(last - first) / step + 1e-9) + 1
    speeds = [first + math.copysign(step * i, last - first) for i in range(count)]
    pieces = [(time, first)]
    for before, speed in pairwise(speeds):
        pieces += [(abs(speed - before) / ramp_rate, speed), (time, speed)]
    if closed:
        pieces.append((abs(speeds[-1] - first) / ramp_rate, first))
    return _chain(first, *pieces)


def _fixed(_: Reducer, closed: bool, *, speed: float, time: float) -> Corners:
    return _chain(speed, (time, speed))


def _sweep(_: Reducer, closed: bool, *, first: float, last: float, rate: float) -> Corners:
    duration = abs(last - first) / rate
    if duration == 0.0:
        raise ParameterError(
            f"a sweep from {first:g} to {last:g} rpm does not change the speed; give two speeds, or programme fixed"
        )
    return _chain(first, (duration, last), *([(duration, first)] if closed else []))


def _strokes(
    reducer: Reducer, closed: bool, *, angle: float, speed: float, acceleration: float, pause: float
) -> Corners:
    revolutions = angle / 360.0 * reducer.reduction
    # A short stroke brakes before it has reached its speed: v² / (60 a) revolutions go into the two ramps.
    reachable = math.sqrt(60.0 * acceleration * revolutions)
    speed = min(speed, reachable)
    ramp = speed / acceleration
    hold = 60.0 * revolutions / speed - ramp if speed < reachable else 0.0
    there, back = ([(ramp, peak), (hold, peak), (ramp, 0.0), (pause, 0.0)] for peak in (speed, -speed))
    return _chain(0.0, *there, *back)


def _profile(_: Reducer, closed: bool, *, times: Sequence[float], speeds: Sequence[float]) -> Corners:
    return list(times), list(speeds)


PROGRAMMES: dict[str, ProgrammeKind] = {
    "dwell": ProgrammeKind(
        summary="holds one speed after the other, with ramps between",
        parameters=table(
            "dwell.",
            first=_speed(200.0, "first speed held"),
            last=_speed(3000.0, "last speed held"),
            step=number(100.0, "rpm", 0.1, 20_000.0, "step between the speeds"),
            time=number(5.0, "s", 0.01, 86_400.0, "time at each speed"),
            ramp_rate=_rate(500.0, "change of speed between dwells"),
        ),
        corners=_dwell,
    ),
    "fixed": ProgrammeKind(
        summary="holds one speed",
        parameters=table(
            "fixed.", speed=_speed(850.0, "speed"), time=number(60.0, "s", 0.01, 1e7, "length of one cycle")
        ),
        corners=_fixed,
    ),
    "sweep": ProgrammeKind(
        summary="passes from one speed to another at a steady rate, and back if it repeats",
        parameters=table(
            "sweep.",
            first=_speed(200.0, "speed at the start"),
            last=_speed(3000.0, "speed at the end"),
            rate=_rate(50.0, "change of speed"),
        ),
        corners=_sweep,
    ),
    "strokes": ProgrammeKind(
        summary="moves back and forth over an arc of the output, as a robot's joint does",
        parameters=table(
            "strokes.",
            angle=number(120.0, "deg", 0.01, 1e5, "arc of the output"),
            speed=number(1500.0, "rpm", 1.0, 20_000.0, "wave generator: largest speed, arc permitting"),
            acceleration=_rate(3000.0, "acceleration and braking"),
            pause=number(0.2, "s", 0.0, 3600.0, "standstill at each end"),
        ),
        corners=_strokes,
    ),
    "profile": ProgrammeKind(
        summary="follows corners given one by one",
        parameters=table(
            "profile.",
            times=number((0.0, 60.0), "s", 0.0, math.inf, "times of the corners, from 0"),
            speeds=_speed((850.0, 850.0), "speeds at the corners"),
        ),
        corners=_profile,
    ),
}
"""By the value of the parameter `programme`."""

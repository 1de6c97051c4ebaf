"""The speed programmes to choose from: name, parameters and corners of each.

A new programme is one function and one entry of :data:`PROGRAMMES`.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

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


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgrammeKind:
    """A kind of programme.

    Parameters
    ----------
    summary : str
        What the wave generator does, in words.
    parameters : tuple of Parameter
    corners : callable
        From the parameters' values (by the part of the name after the dot), the reducer, and whether the cycle must
        end at its first speed, to times [s] and speeds [rpm].
    """

    summary: str
    parameters: tuple[Parameter, ...]
    corners: Callable[[Mapping[str, Any], Reducer, bool], Corners]


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
        If the name is unknown or the values do not make a programme.
    """
    if name not in PROGRAMMES:
        raise ParameterError(f"programme = {name!r} is unknown; choose one of: {', '.join(PROGRAMMES)}")
    kind = PROGRAMMES[name]
    own = {p.name.partition(".")[2]: values.get(p.name, p.default) for p in kind.parameters}
    times, speeds = kind.corners(own, reducer, cycles != 1)
    return SpeedProgramme(times=times, speeds=speeds, cycles=cycles, ripple=ripple)


def _chain(start: float, *pieces: tuple[float, float]) -> Corners:
    """Make corners from a start speed and pieces (duration [s], final speed [rpm]); those without duration vanish."""
    times, speeds = [0.0], [start]
    for duration, speed in pieces:
        if times[-1] + duration > times[-1]:
            times.append(times[-1] + duration)
            speeds.append(speed)
    return times, speeds


def _dwell(values: Mapping[str, Any], reducer: Reducer, closed: bool) -> Corners:
    first, last, step, rate = values["first"], values["last"], values["step"], values["ramp_rate"]
    count = math.floor(abs(last - first) / step + 1e-9) + 1
    speeds = [first + math.copysign(step * i, last - first) for i in range(count)]
    pieces = [(values["time"], first)]
    for before, speed in pairwise(speeds):
        pieces += [(abs(speed - before) / rate, speed), (values["time"], speed)]
    if closed:
        pieces.append((abs(speeds[-1] - first) / rate, first))
    return _chain(first, *pieces)


def _fixed(values: Mapping[str, Any], reducer: Reducer, closed: bool) -> Corners:
    return _chain(values["speed"], (values["time"], values["speed"]))


def _sweep(values: Mapping[str, Any], reducer: Reducer, closed: bool) -> Corners:
    first, last = values["first"], values["last"]
    duration = abs(last - first) / values["rate"]
    if duration == 0.0:
        raise ParameterError(
            f"a sweep from {first:g} to {last:g} rpm does not change the speed; give two speeds, or programme fixed"
        )
    return _chain(first, (duration, last), *([(duration, first)] if closed else []))


def _strokes(values: Mapping[str, Any], reducer: Reducer, closed: bool) -> Corners:
    revolutions = values["angle"] / 360.0 * reducer.reduction
    rate = values["acceleration"]
    # A short stroke brakes before it has reached its speed: v² / (60 a) revolutions go into the two ramps.
    reachable = math.sqrt(60.0 * rate * revolutions)
    speed = min(values["speed"], reachable)
    ramp = speed / rate
    hold = 60.0 * revolutions / speed - ramp if speed < reachable else 0.0
    pieces: list[tuple[float, float]] = []
    for direction in (1.0, -1.0):
        peak = direction * speed
        pieces += [(ramp, peak), (hold, peak), (ramp, 0.0), (values["pause"], 0.0)]
    return _chain(0.0, *pieces)


def _profile(values: Mapping[str, Any], reducer: Reducer, closed: bool) -> Corners:
    return list(values["times"]), list(values["speeds"])


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
            "fixed.",
            speed=_speed(850.0, "speed"),
            time=number(60.0, "s", 0.01, 1e7, "length of one cycle"),
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

"""The speed programmes to choose from: name, parameters and corners of each.

A new programme is one function and one entry of :data:`PROGRAMMES`.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from hd_monitor.errors import ParameterError
from hd_monitor.parameter import number, table
from hd_monitor.reducer import Reducer

from .kind import Corners, Piece, ProgrammeKind, Setup, chain, rate_parameter, speed_parameter, speeds_between, strokes
from .programme import NO_RIPPLE, Ripple, SpeedProgramme
from .robot import ROBOT_PROGRAMMES


def build_programme(
    name: str,
    values: Mapping[str, Any],
    reducer: Reducer,
    *,
    cycles: int = 0,
    ripple: Ripple = NO_RIPPLE,
    seed: int = 0,
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
    seed : int
        Of the random programmes.

    Raises
    ------
    ParameterError
        If the values do not make a programme.
    """
    kind = PROGRAMMES[name]
    own = {p.name.partition(".")[2]: values.get(p.name, p.default) for p in kind.parameters}
    corners = kind.corners(Setup(reducer, cycles != 1, seed), **own)
    return SpeedProgramme(**corners._asdict(), cycles=cycles, ripple=ripple)


def _dwell(setup: Setup, *, first: float, last: float, step: float, time: float, ramp_rate: float) -> Corners:
    speeds = speeds_between(first, last, step)
    pieces = [Piece(time, first)]
    for before, speed in pairwise(speeds):
        pieces += [Piece(abs(speed - before) / ramp_rate, speed), Piece(time, speed)]
    if setup.closed:
        pieces.append(Piece(abs(speeds[-1] - first) / ramp_rate, first))
    return chain(first, pieces)


def _fixed(_: Setup, *, speed: float, time: float) -> Corners:
    return chain(speed, [Piece(time, speed)])


def _sweep(setup: Setup, *, first: float, last: float, rate: float) -> Corners:
    duration = abs(last - first) / rate
    if duration == 0.0:
        raise ParameterError(
            f"a sweep from {first:g} to {last:g} rpm does not change the speed; give two speeds, or programme fixed"
        )
    return chain(first, [Piece(duration, last), *([Piece(duration, first)] if setup.closed else [])])


def _strokes(setup: Setup, *, angle: float, speed: float, acceleration: float, pause: float) -> Corners:
    there_and_back = [(angle, speed), (-angle, speed)]
    return chain(0.0, strokes(setup.reducer, there_and_back, acceleration=acceleration, pause=pause))


def _profile(_: Setup, *, times: Sequence[float], speeds: Sequence[float]) -> Corners:
    return Corners(times, speeds)


PROGRAMMES: dict[str, ProgrammeKind] = {
    "dwell": ProgrammeKind(
        summary="holds one speed after the other, with ramps between",
        parameters=table(
            "dwell.",
            first=speed_parameter(200.0, "first speed held"),
            last=speed_parameter(3000.0, "last speed held"),
            step=number(100.0, "rpm", 0.1, 20_000.0, "step between the speeds"),
            time=number(5.0, "s", 0.01, 86_400.0, "time at each speed"),
            ramp_rate=rate_parameter(500.0, "change of speed between dwells"),
        ),
        corners=_dwell,
    ),
    "fixed": ProgrammeKind(
        summary="holds one speed",
        parameters=table(
            "fixed.", speed=speed_parameter(850.0, "speed"), time=number(60.0, "s", 0.01, 1e7, "length of one cycle")
        ),
        corners=_fixed,
    ),
    "sweep": ProgrammeKind(
        summary="passes from one speed to another at a steady rate, and back if it repeats",
        parameters=table(
            "sweep.",
            first=speed_parameter(200.0, "speed at the start"),
            last=speed_parameter(3000.0, "speed at the end"),
            rate=rate_parameter(50.0, "change of speed"),
        ),
        corners=_sweep,
    ),
    "strokes": ProgrammeKind(
        summary="moves back and forth over an arc of the output, as a robot's joint does",
        parameters=table(
            "strokes.",
            angle=number(120.0, "deg", 0.01, 1e5, "arc of the output"),
            speed=number(1500.0, "rpm", 1.0, 20_000.0, "wave generator: largest speed, arc permitting"),
            acceleration=rate_parameter(3000.0, "acceleration and braking"),
            pause=number(0.2, "s", 0.0, 3600.0, "standstill at each end"),
        ),
        corners=_strokes,
    ),
    "profile": ProgrammeKind(
        summary="follows corners given one by one",
        parameters=table(
            "profile.",
            times=number((0.0, 60.0), "s", 0.0, math.inf, "times of the corners, from 0"),
            speeds=speed_parameter((850.0, 850.0), "speeds at the corners"),
        ),
        corners=_profile,
    ),
    **ROBOT_PROGRAMMES,
}
"""By the value of the parameter `programme`."""

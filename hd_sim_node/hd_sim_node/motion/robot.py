"""Programmes of a robot's joint: it moves between standstills, and the payload comes and goes."""

from collections.abc import Sequence

import numpy as np

from hd_monitor.arrays import FloatArray
from hd_monitor.errors import ParameterError
from hd_monitor.parameter import number, table
from hd_monitor.reducer import Reducer

from ..randomness import generator
from .kind import (
    Corners,
    Piece,
    ProgrammeKind,
    Setup,
    chain,
    rate_parameter,
    speed_parameter,
    speeds_between,
    stroke,
    strokes,
)

GRIP_TIME = 0.1
"""Time [s] in which the gripper takes the payload or releases it, at standstill."""

_SHARES = {"pick and place": 0.5, "short strokes": 0.25, "slow moves": 0.1, "rest": 0.15}
"""Of the sections of a day."""


def _picking(
    reducer: Reducer,
    *,
    angle: float,
    loaded_speed: float,
    empty_speed: float,
    acceleration: float,
    pick_pause: float,
    place_pause: float,
) -> list[Piece]:
    there = stroke(reducer, angle, loaded_speed, acceleration, carried=1.0)
    back = stroke(reducer, -angle, empty_speed, acceleration)
    pick = [Piece(GRIP_TIME, 0.0, 1.0), Piece(pick_pause - GRIP_TIME, 0.0, 1.0)]
    place = [Piece(GRIP_TIME, 0.0), Piece(place_pause - GRIP_TIME, 0.0)]
    return [*pick, *there, *place, *back]


def _pick_and_place(setup: Setup, **values: float) -> Corners:
    return chain(0.0, _picking(setup.reducer, **values))


def _wander(
    random: np.random.Generator,
    reducer: Reducer,
    arcs: FloatArray,
    *,
    travel: float,
    speed: float,
    acceleration: float,
    pause: float,
) -> list[Piece]:
    """Strokes over `arcs` [deg] that stay within half of `travel` [deg] of the start, and the same ones back."""
    place, signed = 0.0, []
    for arc, sense in zip(arcs.tolist(), random.choice([-1.0, 1.0], arcs.size).tolist(), strict=True):
        step = sense * arc if abs(place + sense * arc) <= 0.5 * travel else -sense * arc
        place += step
        signed.append(step)
    route = [*signed, *(-step for step in reversed(signed))]
    return strokes(reducer, [(step, speed) for step in route], acceleration=acceleration, pause=pause)


def _short_strokes(
    setup: Setup, *, smallest: float, largest: float, travel: float, count: int, **values: float
) -> Corners:
    if smallest > largest:
        raise ParameterError(f"arcs from {smallest:g} to {largest:g} deg are not a range; give the smaller one first")
    if largest > 0.5 * travel:
        raise ParameterError(
            f"arcs of up to {largest:g} deg do not fit into a travel of {travel:g} deg from every position; give a "
            "short_strokes.travel of at least twice the largest arc"
        )
    random = generator(setup.seed, "short strokes")
    arcs = random.uniform(smallest, largest, count)
    return chain(0.0, _wander(random, setup.reducer, arcs, travel=travel, **values))


def _commissioning(
    setup: Setup, *, angle: float, first: float, last: float, step: float, acceleration: float, pause: float
) -> Corners:
    moves = [(-angle, first)]
    for speed in speeds_between(first, last, step):
        moves += [(2.0 * angle, speed), (-2.0 * angle, speed)]
    moves.append((angle, first))
    return chain(0.0, strokes(setup.reducer, moves, acceleration=acceleration, pause=pause))


def _day(setup: Setup, *, hours: float, section: float, travel: float, speed: float, acceleration: float) -> Corners:
    random = generator(setup.seed, "day")
    left, done = 3600.0 * hours, []
    task = next(iter(_SHARES))
    while True:
        cycle = np.array(_task(task, random, setup.reducer, travel=travel, speed=speed, acceleration=acceleration))
        length = cycle[:, 0].sum()
        wanted = max(1, round(60.0 * section * random.uniform(0.5, 1.5) / length))
        repeats = min(wanted, int(left / length))
        if repeats == 0:
            break
        done.append(np.tile(cycle, (repeats, 1)))
        left -= repeats * length
        task = str(random.choice(list(_SHARES), p=list(_SHARES.values())))
    return chain(0.0, np.concatenate([*done, [Piece(left, 0.0)]]))


def _task(
    task: str, random: np.random.Generator, reducer: Reducer, *, travel: float, speed: float, acceleration: float
) -> Sequence[Piece]:
    """One cycle of a task, from the start angle and back to it."""

    def share(low: float, high: float) -> float:
        return float(random.choice(np.arange(low, high + 0.01, 0.05)))

    if task == "pick and place":
        return _picking(
            reducer,
            angle=travel * share(0.2, 0.5),
            loaded_speed=speed * share(0.3, 0.7),
            empty_speed=speed * share(0.5, 1.0),
            acceleration=acceleration,
            pick_pause=random.uniform(0.2, 1.0),
            place_pause=random.uniform(0.2, 1.0),
        )
    if task == "short strokes":
        arcs = travel * random.uniform(0.1, 0.3, 20)
        pause, peak = random.uniform(0.1, 0.5), speed * share(0.5, 1.0)
        return _wander(random, reducer, arcs, travel=travel, speed=peak, acceleration=acceleration, pause=pause)
    if task == "slow moves":
        slow = speed * share(0.05, 0.1)
        moves = [(part * travel, slow) for part in (0.5, -1.0, 0.5)]
        return strokes(reducer, moves, acceleration=acceleration, pause=1.0)
    return [Piece(random.uniform(20.0, 200.0), 0.0)]


def _acceleration() -> float:
    return rate_parameter(3000.0, "acceleration and braking")


def _peak(default: float, description: str) -> float:
    return speed_parameter(default, f"{description}, arc permitting", low=1.0)


ROBOT_PROGRAMMES: dict[str, ProgrammeKind] = {
    "pick_and_place": ProgrammeKind(
        summary="carries the payload from start_angle over an arc and returns without it",
        parameters=table(
            "pick_and_place.",
            angle=number(90.0, "deg", 0.01, 1e5, "arc of the output from where it picks to where it places"),
            loaded_speed=_peak(1000.0, "largest speed with the payload"),
            empty_speed=_peak(1800.0, "largest speed without it"),
            acceleration=_acceleration(),
            pick_pause=number(0.4, "s", GRIP_TIME, 3600.0, "standstill where it picks; the first 0.1 s grip"),
            place_pause=number(0.3, "s", GRIP_TIME, 3600.0, "standstill where it places; the first 0.1 s release"),
        ),
        corners=_pick_and_place,
    ),
    "short_strokes": ProgrammeKind(
        summary="moves over random arcs around start_angle and back the same way",
        parameters=table(
            "short_strokes.",
            smallest=number(20.0, "deg", 0.01, 1e5, "smallest arc of the output"),
            largest=number(60.0, "deg", 0.01, 1e5, "largest arc of the output"),
            travel=number(180.0, "deg", 0.01, 1e5, "range of the output, half of it on either side of start_angle"),
            count=number(40, "", 1, 100_000, "strokes before it turns back"),
            speed=_peak(1500.0, "largest speed"),
            acceleration=_acceleration(),
            pause=number(0.3, "s", 0.0, 3600.0, "standstill after each stroke"),
        ),
        corners=_short_strokes,
    ),
    "commissioning": ProgrammeKind(
        summary="moves through the whole range of a robot's joint, faster from stroke to stroke",
        parameters=table(
            "commissioning.",
            angle=number(120.0, "deg", 0.01, 1e5, "arc of the output on either side of start_angle"),
            first=_peak(200.0, "speed of the first strokes"),
            last=_peak(3000.0, "speed of the last strokes"),
            step=number(100.0, "rpm", 0.1, 20_000.0, "step between the speeds"),
            acceleration=_acceleration(),
            pause=number(0.5, "s", 0.0, 3600.0, "standstill after each stroke"),
        ),
        corners=_commissioning,
    ),
    "day": ProgrammeKind(
        summary="works through a day of random sections: pick and place, short strokes, slow moves, rest",
        parameters=table(
            "day.",
            hours=number(24.0, "h", 0.01, 240.0, "length"),
            section=number(15.0, "min", 0.1, 600.0, "mean length of a section of one kind of work"),
            travel=number(180.0, "deg", 0.01, 1e5, "range of the output, half of it on either side of start_angle"),
            speed=_peak(2000.0, "largest speed of all"),
            acceleration=_acceleration(),
        ),
        corners=_day,
    ),
}
"""By the value of the parameter `programme`."""

"""How well does one health-check move repeat, and is a line that grows by 30 % noticed within one?

    python tests/studies/check_move.py [--sound 1000] [--moves 100] [--with-sensor 10] [--phases 10] [--seed 2024]

From joint states alone, but for a look at the repeatability with a sensor. The rig has the effects of a real drive
(`drive: catalogue`), and each move other noise. Repeatability is the standard deviation of a reading over moves. The
first five are the baseline. Each move after them is looked at by itself: a change is noticed where it is significant
at 1 in 1000, and what a monitor then shows is counted. Last come drives whose lines have random phases, each with a
baseline of its own.
"""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hd_monitor.assessment import Assessment
from hd_monitor.change import Change
from hd_monitor.history.entry import Entry, Kind
from hd_monitor.history.rating import baseline_of, rated
from hd_monitor.history.series import SPLINES, series_of
from hd_monitor.history.trend import change_of
from hd_monitor.offline.move import MoveLimits, plan_move
from hd_monitor.settings import JointSettings
from hd_sim_node.drive.catalogue import preset
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.studies.false_alarms import watch

LINES = {
    "flexspline.beta": [0.012, 0.008, 0.004],
    "circular_spline.beta": [0.012, 0.008, 0.004],
    "flexspline.transmission_error": [0.3, 0.08, 0.03],
    "circular_spline.transmission_error": [0.25, 0.08, 0.03],
}
"""Of a sound drive; the transmission errors [arcmin] are those of `drive: catalogue`."""
PHASES = [f"{spline}.{name}" for spline in SPLINES for name in ("phase", "transmission_error_phase")]
GROWTH = 1.3
LIMITS = MoveLimits(lower=-1.5, upper=1.5, speed=2.0, acceleration=5.0)
BASE = 5
"""Moves of the baseline."""
CHANCE = 1e-3
DYNAMICS = ("dynamics.natural_frequency", "dynamics.damping_ratio", "dynamics.inertia")
JOINT_STATES = {"input.source": "joint_effort", "input.expected_rate": 250.0}


def on_the_move(watched: Mapping[str, object]) -> type[RigSettings]:
    """Settings of a rig that drives the move of a monitor with these parameters."""

    class OnTheMove(RigSettings):
        @property
        def programme(self) -> SpeedProgramme:
            move = plan_move(JointSettings.from_mapping(watched), LIMITS, 60.0)
            rpm = move.velocities * self.reducer.reduction * 60.0 / math.tau
            return SpeedProgramme(times=move.times, speeds=rpm, cycles=1)

    return OnTheMove


class Driven(NamedTuple):
    """A move, as the ledger keeps it and as the monitor shows it."""

    entry: Entry
    last: Assessment


def drive(seed: int, number: int, **rig: object) -> Driven:
    """Drive one move without a sensor and sum it up."""
    effort = {"joint_states.effort": "reaction", "joint_states.effort_noise": 0.3, "joint_states.rate": 250.0}
    return driven(seed, number, JOINT_STATES, {"drive": "catalogue"} | effort | rig)


def driven(seed: int, number: int, watched: dict[str, Any], rig: Mapping[str, object]) -> Driven:
    """Drive one move before a monitor with these parameters and sum it up."""
    given = {"defect": "custom", "duration": 60.0, "seed": seed, **rig}
    *_, last = watch(Simulation(on_the_move(watched).from_mapping(given)), watched)
    entry = Entry.of(last, "joint", kind=Kind.EVIDENCE)
    return Driven(replace(entry, time=float(number), seconds=3600.0 / BASE, revolutions=1000.0), last)


def repeatability_with_sensor(seed: int, moves: int) -> Iterator[str]:
    """Scatter of both readings where an accelerometer is there, on the paper's drive and on a real one's."""
    for name in ("paper", "catalogue"):
        watched = {key: value for key, value in preset(name).items() if key in DYNAMICS}
        rig = {"drive": name, "joint_states.effort_noise": 0.3} | LINES
        entries = [driven(seed + number, number, watched, rig).entry for number in range(moves)]
        yield from (f"{name} drive, {line}" for line in repeatability(entries) if "index" in line or "error" in line)


def repeatability(entries: Sequence[Entry]) -> Iterator[str]:
    """Standard deviation of each reading over the moves, beside what the moves say of themselves."""
    for series in series_of(entries):
        values, own = series.values, float(series.stds.mean())
        yield (
            f"{series.name}: mean {values.mean():.4g}, standard deviation over {values.size} moves "
            f"{values.std(ddof=1):.2g}, said {own:.2g}"
        )


def growths(base: Sequence[Entry], moves: Sequence[Driven], spline: str) -> list[Change]:
    """Change of a spline's first line in every single move after the baseline."""
    name = f"{spline.replace('_', ' ')} line 1"
    found = []
    for move in moves:
        entries = [*base, replace(move.entry, time=1e6)]
        change = change_of(next(series for series in series_of(entries) if series.name == name))
        if change is None:
            raise ValueError(f"no {name} in the move")
        found.append(change)
    return found


def shown(base: Sequence[Entry], moves: Sequence[Driven]) -> Counter[str]:
    """Count what a monitor that knows the baseline shows after each move."""
    baseline = baseline_of([*base, replace(base[-1], time=1e6, kind=Kind.BASELINE, verdict=None)])
    limits = JointSettings.from_mapping(JOINT_STATES).diagnosis
    verdicts = [rated(move.last.verdict, move.last.identification, baseline, limits) for move in moves]
    return Counter(f"{verdict.fault_code}, {verdict.reason.partition(' (')[0]}" for verdict in verdicts)


def grown_by(spline: str, lines: Mapping[str, Any]) -> dict[str, Any]:
    """Return lines of which all amplitudes of a spline have grown."""
    names = {key for key in LINES if spline and key.startswith(spline)}
    return {key: [GROWTH * size for size in value] if key in names else value for key, value in lines.items()}


def with_random_phases(seed: int, drives: int, moves: int = 2) -> Iterator[str]:
    """Count what is shown of moves with a line grown, on drives whose lines have random phases."""
    said = {spline: Counter[str]() for spline in SPLINES}
    rng = np.random.default_rng(seed)
    for number in range(drives):
        lines = LINES | {name: rng.uniform(0.0, math.tau, 3).tolist() for name in PHASES}
        first = seed + 1000 * number
        base = [drive(first + n, n, **lines).entry for n in range(BASE)]
        for place, spline in enumerate(SPLINES):
            numbers = range(first + 100 * (place + 1), first + 100 * (place + 1) + moves)
            said[spline] += shown(base, [drive(n, BASE, **grown_by(spline, lines)) for n in numbers])
    yield from (
        f"random phases, {spline} grown, {count.total()} moves: {dict(count)}" for spline, count in said.items()
    )


def main() -> None:
    """Print the study's figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sound", type=int, default=1000, help="moves of the sound drive")
    parser.add_argument("--moves", type=int, default=100, help="moves with each spline's line grown")
    parser.add_argument("--seed", type=int, default=2024)
    parser.add_argument("--with-sensor", type=int, default=10, help="moves with a sensor on either drive")
    parser.add_argument("--phases", type=int, default=10, help="drives whose lines have random phases")
    options = parser.parse_args()
    print(*repeatability_with_sensor(options.seed, options.with_sensor), sep="\n", flush=True)
    base = [drive(options.seed + n, n, **LINES).entry for n in range(BASE)]
    cases = {"": options.sound} | dict.fromkeys(SPLINES, options.moves)
    for place, (spline, count) in enumerate(cases.items()):
        if not count:
            continue
        first = options.seed + 1_000_000 * (place + 1)
        moves = [drive(first + n, BASE + n, **grown_by(spline, LINES)) for n in range(count)]
        if not spline:
            print(*repeatability([*base, *(move.entry for move in moves)]), sep="\n")
        print(f"{spline or 'nothing'} grown, {count} moves")
        for line in SPLINES:
            changes = growths(base, moves, line)
            growth, deviation = np.array([(c.change / c.before, c.change / c.std) for c in changes]).T
            noticed = sum(change.p_value < CHANCE for change in changes)
            print(
                f"  {line}: noticed in {noticed}; growth {100 * growth.mean():.1f} ± {100 * growth.std():.1f} %, in "
                f"standard deviations {deviation.mean():.2f} ± {deviation.std():.2f}, from {deviation.min():.2f} to "
                f"{deviation.max():.2f}"
            )
        print(f"  shown: {dict(shown(base, moves))}", flush=True)
    print(*with_random_phases(options.seed, options.phases), sep="\n")


if __name__ == "__main__":
    main()

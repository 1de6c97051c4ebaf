"""Is the right spline named where the drive has a transmission error at the very same lines?

    python tests/studies/transmission_error.py [--cases 40] [--seed 11] [--seconds 20] [--jobs 2]

Whole chain, simulator to verdict, on random drives with a transmission error on both splines: the monitor is told to
expect none (``reducer.transmission_error: 0``, as in the paper) or the catalogue's 1'. *varying*: one spline's
stiffness is bad, gravity swings the torque, and effort is measured; *sweep*: the same at constant torque, the speed
varies; *steady*: at constant torque and speed; *error*: the stiffness is sound, one spline's error is 2' to 4';
*sound*: neither. A row counts the last verdicts: the right part, another one, undetermined; and how often the 95 %
intervals hold the true index and the true transmission error.
"""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from hd_monitor.assessment import Assessment

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.studies.false_alarms import assessed

SETS = ("varying", "sweep", "steady", "error", "sound")
SPLINES = ("circular_spline", "flexspline")
GIVEN = (0.0, 1.0)
"""Transmission errors [arcmin] that the monitor is told to expect."""


def random_drive(
    kind: str, seed: int, seconds: float
) -> tuple[dict[str, Any], dict[str, float], dict[str, float], str]:
    """Parameters of a random rig, the true indexes, the true errors [arcmin peak to peak] and the part that is bad."""
    rng = np.random.default_rng([SETS.index(kind), seed])
    bad = str(rng.choice(SPLINES))
    rig: dict[str, Any] = {
        "defect": "custom",
        "dynamics.natural_frequency": float(rng.uniform(40.0, 70.0)),
        "dynamics.damping_ratio": float(rng.uniform(0.025, 0.045)),
        "torque.mean": float(rng.uniform(8.0, 20.0)),
        "sensor.noise": float(10.0 ** rng.uniform(-1.0, 0.0)),
        "joint_states.effort": "transmitted",
        "duration": seconds,
        "seed": int(rng.integers(2**31)),
    }
    indexes, errors = {}, {}
    for spline in SPLINES:
        faulty = spline == bad and kind in ("varying", "sweep", "steady")
        index = float(rng.uniform(0.07, 0.11) if faulty else rng.uniform(0.005, 0.025))
        worn = spline == bad and kind == "error"
        error = float(rng.uniform(2.0, 4.0) if worn else rng.uniform(0.1, 1.0))
        for name, size in (("beta", index), ("transmission_error", error)):
            shape = rng.dirichlet([3.0, 1.5, 0.7]) ** 0.5  # root-sum-square 1
            phase = "phase" if name == "beta" else "transmission_error_phase"
            rig[f"{spline}.{name}"] = (size * shape).tolist()
            rig[f"{spline}.{phase}"] = rng.uniform(0.0, math.tau, 3).tolist()
        indexes[spline], errors[spline] = index, error
    speed = float(rng.uniform(600.0, 2600.0))
    match kind:
        case "sweep":
            rig |= {"programme": "sweep", "sweep.first": 300.0, "sweep.last": 2700.0, "sweep.rate": 2400.0 / seconds}
        case "steady":
            rig |= {"programme": "fixed", "fixed.speed": speed, "fixed.time": seconds}
        case _:
            programme = str(rng.choice(["fixed", "strokes", "sweep"]))
            rig |= {
                "programme": programme,
                "fixed.speed": speed,
                "strokes.angle": float(rng.uniform(90.0, 180.0)),
                "strokes.speed": speed,
                "sweep.first": 300.0,
                "sweep.last": 2700.0,
                "torque.gravity": float(rig["torque.mean"] * rng.uniform(0.6, 1.2)),
            }
    return rig, indexes, errors, "none" if kind == "sound" else bad


def watch(rig: dict[str, Any], given: float) -> Assessment:
    """Return the last assessment of a rig by a monitor that expects an error of so many arcmin."""
    shared = {name: value for name, value in rig.items() if name.startswith("dynamics.")}
    *_, last = assessed(rig, shared | {"reducer.transmission_error": given})
    return last


@dataclass
class Tally:
    """Counts of one set with one expectation."""

    named: Counter[str] = field(default_factory=Counter)
    held: Counter[str] = field(default_factory=Counter)
    asked: Counter[str] = field(default_factory=Counter)

    def add(self, other: "Tally") -> None:
        """Add the counts of another case."""
        for own, more in ((self.named, other.named), (self.held, other.held), (self.asked, other.asked)):
            own.update(more)


def judge(case: tuple[str, int, float, float]) -> Tally:
    """Simulate and judge one drive."""
    kind, seed, seconds, given = case
    rig, indexes, errors, bad = random_drive(kind, seed, seconds)
    last, tally = watch(rig, given), Tally()
    component = last.verdict.component.value
    tally.named["right" if component == bad else component if component == "undetermined" else "wrong"] += 1
    found = last.identification
    if found is None or found.relative or found.blockers:
        return tally
    readings = [("index", indexes, found.index, found.index_std)]
    if found.transmission_error is not None and found.transmission_error_std is not None:
        readings.append(("error", errors, found.transmission_error, found.transmission_error_std))
    for name, truth, value, std in readings:
        for spline in SPLINES:
            tally.asked[name] += 1
            tally.held[name] += abs(getattr(value, spline) - truth[spline]) <= 1.96 * getattr(std, spline)
    return tally


def study(
    cases: int, seed: int, seconds: float, jobs: int, expected: Sequence[float] = GIVEN
) -> dict[tuple[str, float], Tally]:
    """Judge `cases` drives of every set with every expectation [arcmin]."""
    tallies = {(kind, given): Tally() for kind in SETS for given in expected}
    tasks = [(kind, seed + n, seconds, given) for kind, given in tallies for n in range(cases)]
    with ProcessPoolExecutor(jobs) as pool:
        for done, (task, tally) in enumerate(zip(tasks, pool.map(judge, tasks), strict=True), start=1):
            tallies[task[0], task[3]].add(tally)
            print(f"\r{done} of {len(tasks)} cases", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return tallies


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args(arguments)
    print(f"{'set':10}{'told':>8}{'right':>8}{'wrong':>8}{'undetermined':>14}{'index held':>13}{'error held':>13}")
    for (kind, told), tally in study(given.cases, given.seed, given.seconds, given.jobs).items():
        shares = [
            f"{100 * tally.held[name] / tally.asked[name]:.1f} %" if tally.asked[name] else "–"
            for name in ("index", "error")
        ]
        row = "".join(
            f"{tally.named[name]:{width}}" for name, width in (("right", 8), ("wrong", 8), ("undetermined", 14))
        )
        print(f"{kind:10}{told:7g}'{row}{shares[0]:>13}{shares[1]:>13}")


if __name__ == "__main__":
    main()

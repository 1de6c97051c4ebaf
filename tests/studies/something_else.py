"""Is what the model does not explain listed with its true source, and nothing where there is nothing?

    python tests/studies/something_else.py [--cases 20] [--seed 5]

Whole chain, simulator to result, on random rigs: one speed, strokes, a sweep or a staircase of speeds; a defect of
either spline or none; noise. *nothing*: nothing else is there, and every assessment that lists something is false. In
the other sets one thing is added, with 1 % to 20 % of the vibration's power: the wave generator once per revolution or
at its third order, ripple at twelve cycles per motor revolution, mains hum, a tone of another frequency. Of these the
last assessment counts: whether its strongest row has the right source, and a tone its frequency, and whether it lists
more; the stiffness' side lines of a source count as that source.
"""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hd_monitor.identification.result import Identification
from hd_monitor.process import set_up_process
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation, Stretch

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.studies.false_alarms import watch

SETS = ("nothing", "wave generator", "third order", "ripple", "mains", "tone")
ORDERS = {"wave generator": 1.0, "third order": 3.0, "ripple": 12.0}
SOURCES = {
    "wave generator": "wave_generator",
    "third order": "wave_generator",
    "ripple": "motor_ripple",
    "mains": "mains",
}


class Drive(NamedTuple):
    """A rig, and a tone [Hz, rad/s²] in its sensor."""

    rig: dict[str, Any]
    tone: tuple[float, float] = (0.0, 0.0)


def random_drive(kind: str, seed: int) -> Drive:
    """Draw a drive in which one thing, or nothing, is not the reducer's."""
    rng = np.random.default_rng([SETS.index(kind), seed])
    speed = float(rng.uniform(500.0, 1500.0))
    programmes: tuple[dict[str, Any], ...] = (
        {"programme": "fixed", "fixed.speed": speed},
        {"programme": "strokes", "strokes.speed": speed, "strokes.angle": float(rng.uniform(120.0, 300.0))},
        {"programme": "sweep", "sweep.first": 300.0, "sweep.last": 1800.0, "sweep.rate": 125.0},
        {"programme": "dwell", "dwell.first": speed, "dwell.last": speed + 450.0, "dwell.step": 150.0},
    )
    rig: dict[str, Any] = {
        "defect": str(rng.choice(["none", "flexspline", "circular_spline"])),
        "sensor.noise": float(10.0 ** rng.uniform(-1.0, 0.0)),
        "torque.gravity": float(rng.choice([0.0, 5.0])),
        "duration": 12.0,
        "seed": int(rng.integers(2**31)),
    } | programmes[int(rng.integers(len(programmes)))]
    amplitude = math.sqrt(2.0 * float(rng.uniform(0.01, 0.2))) * _rms(_samples(rig))
    if order := ORDERS.get(kind):
        driven = rig | {"torque.ripple": [1.0], "torque.ripple_orders": [order]}
        size = amplitude / math.sqrt(2.0) / _rms(_samples(driven) - _samples(rig))
        return Drive(driven | {"torque.ripple": [size]})
    if kind == "mains":
        return Drive(rig, (float(rng.choice([50.0, 60.0, 100.0])) * float(rng.uniform(0.998, 1.002)), amplitude))
    return Drive(rig, (float(rng.uniform(20.0, 46.0)), amplitude)) if kind == "tone" else Drive(rig)


def _samples(rig: dict[str, Any]) -> Any:
    return np.concatenate([stretch.samples for stretch in Simulation(RigSettings.from_mapping(rig))])


def _rms(values: Any) -> float:
    return float(np.sqrt(np.mean(values**2)))


def results_of(drive: Drive) -> list[Identification]:
    """Results of every assessment of a drive that had any."""
    said = watch(_stretches(drive), {})
    return [assessment.identification for assessment in said if assessment.identification is not None]


def _stretches(drive: Drive) -> Iterator[Stretch]:
    frequency, amplitude = drive.tone
    for stretch in Simulation(RigSettings.from_mapping(drive.rig)):
        tone = amplitude * np.sin(math.tau * 1e-9 * frequency * stretch.stamps)
        yield replace(stretch, samples=stretch.samples + tone)


def judge(kind: str, seed: int) -> Counter[str]:
    """Count what was listed of a drive."""
    drive = random_drive(kind, seed)
    results = results_of(drive)
    if kind == "nothing":
        return Counter(assessments=len(results), false=sum(bool(result.something_else) for result in results))
    rows = results[-1].something_else
    if not rows:
        return Counter(cases=1, missed=1)
    right = rows[0].source == SOURCES.get(kind, "unknown")
    if drive.tone[0]:
        right &= rows[0].frequency is not None and abs(rows[0].frequency - drive.tone[0]) < 1.0
    return Counter(cases=1, right=int(right), wrong=int(not right), more=int(len(rows) > 1))


def main() -> int:
    """Print the table; status 1 if more than one assessment in a thousand is false."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=20, help="of each set")
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--sets", default=",".join(SETS), help="comma-separated; all by default")
    given = parser.parse_args()
    failed = False
    for kind in given.sets.split(","):
        counts: Counter[str] = Counter()
        for number in range(given.cases):
            counts.update(judge(kind, 1000 * given.seed + number))
        print(f"{kind:15}", ", ".join(f"{name} {count}" for name, count in counts.items()), flush=True)
        failed |= 1000 * counts["false"] > counts["assessments"]
    return int(failed)


if __name__ == "__main__":
    set_up_process()
    raise SystemExit(main())

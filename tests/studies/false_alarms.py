"""How often does the monitor accuse a sound reducer? Whole chain, simulator to verdict, on random sound units.

    python tests/studies/false_alarms.py [--runs 120] [--seconds 40] [--seed 2024]

Every run is another unit: random tooth numbers, natural frequency and damping, stiffness indexes of at most 60 % of the
warn limit, random mean torque, gravity of an eccentric load that no effort tells, load fluctuation, noise, motion
(dwells, one speed, sweeps, strokes). A false alarm is a verdict that accuses a spline; one that only says which line
is larger, for want of a torque (``HD_UNRATED``, level OK), accuses none. Counted by verdict and by run.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
from scipy.stats import beta

from hd_monitor.assessment import Assessment
from hd_monitor.diagnosis.verdict import FaultCode
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation, Stretch

EPOCH = 1_700_000_000_000_000_000
TEETH = ((160, 162), (200, 202), (100, 102), (240, 242))
MAX_PART_OF_LIMIT = 0.6


def random_unit(seed: int, seconds: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """Parameters of a random sound rig and of the monitor that watches it."""
    rng = np.random.default_rng(seed)
    z1, z2 = TEETH[rng.integers(len(TEETH))]
    common = {
        "reducer.flexspline_teeth": z1,
        "reducer.circular_spline_teeth": z2,
        "reducer.mount": str(rng.choice(["circular_spline_fixed", "flexspline_fixed"])),
        "dynamics.natural_frequency": float(rng.uniform(30.0, 80.0)),
        "dynamics.damping_ratio": float(rng.uniform(0.015, 0.05)),
    }
    limit = JointSettings.from_mapping().diagnosis.warn_index
    rig: dict[str, Any] = dict(common)
    for spline in ("flexspline", "circular_spline"):
        shape = rng.dirichlet([3.0, 1.5, 0.7]) ** 0.5  # root-sum-square 1
        index = limit * rng.uniform(0.05, MAX_PART_OF_LIMIT)
        rig[f"{spline}.beta"] = [float(b) for b in index * shape]
        rig[f"{spline}.phase"] = [float(p) for p in rng.uniform(0.0, 2.0 * np.pi, 3)]
    mean = float(rng.uniform(5.0, 40.0))
    rig |= {
        "defect": "custom",
        "programme": str(rng.choice(["dwell", "fixed", "sweep", "strokes"])),
        "dwell.first": 400.0,
        "dwell.last": 2400.0,
        "dwell.step": 400.0,
        "fixed.speed": float(rng.uniform(300.0, 2800.0)),
        "sweep.first": 300.0,
        "sweep.last": 2500.0,
        "strokes.angle": float(rng.uniform(60.0, 200.0)),
        "strokes.speed": float(rng.uniform(600.0, 2400.0)),
        "torque.mean": mean,
        "torque.gravity": float(mean * rng.uniform(0.0, 0.8)),
        "torque.load_fluctuation": float(mean * rng.uniform(0.0, 0.3)),
        "torque.load_phase": float(rng.uniform(0.0, 2.0 * np.pi)),
        "sensor.noise": float(10.0 ** rng.uniform(-1.5, 0.7)),
        "joint_states.effort": str(rng.choice(["transmitted", "mean", "none"])),
        "duration": seconds,
        "seed": int(rng.integers(2**31)),
    }
    return rig, common | {"load.torque": mean}


def assessed(rig: dict[str, Any], watched: dict[str, Any]) -> Iterator[Assessment]:
    """Iterate over the assessments of a simulated rig by a monitor, each with its parameters."""
    return watch(Simulation(RigSettings.from_mapping(rig)), watched)


def watch(stretches: Iterable[Stretch], watched: dict[str, Any]) -> Iterator[Assessment]:
    """Iterate over the assessments of a monitor with these parameters that is fed simulated stretches."""
    monitor = Monitor(JointSettings.from_mapping(watched))
    for stretch in stretches:
        joint = stretch.joint
        unknown = np.full(len(joint), np.nan)
        velocity = unknown if joint.velocity is None else joint.velocity
        effort = unknown if joint.effort is None else joint.effort
        monitor.add(Quantity.MOTION, EPOCH + joint.stamps, joint.position, velocity, effort)
        monitor.add(Quantity.VIBRATION, EPOCH + stretch.stamps, stretch.samples)
        yield from monitor.advance()
    before, last = monitor.latest, monitor.finish()
    if last is not None and last is not before:
        yield last


def verdicts(case: tuple[int, float]) -> Counter[str]:
    """Count the components named in one run; what is not rated, for want of a torque, accuses nothing."""
    named = (assessment.verdict for assessment in assessed(*random_unit(*case)))
    return Counter("unrated" if one.fault_code is FaultCode.UNRATED else str(one.component) for one in named)


def alarms_in(counted: Counter[str]) -> int:
    """Count the verdicts that accuse a spline."""
    return sum(counted[name] for name in ("flexspline", "circular_spline", "both"))


def main() -> int:
    """Run the study and print its figures; status 1 if more than 1 verdict in 1000 is a false alarm."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=120, help="random units")
    parser.add_argument("--seconds", type=float, default=40.0, help="simulated time of each run [s]")
    parser.add_argument("--seed", type=int, default=2024, help="first seed; the units are seed, seed + 1, …")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--verbose", action="store_true", help="name the runs with false alarms")
    options = parser.parse_args()
    cases = [(options.seed * 100_000 + number, options.seconds) for number in range(options.runs)]
    total: Counter[str] = Counter()
    bad_runs = 0
    with ProcessPoolExecutor(options.jobs) as pool:
        for number, (case, counted) in enumerate(zip(cases, pool.map(verdicts, cases), strict=True), start=1):
            total += counted
            alarms = alarms_in(counted)
            bad_runs += alarms > 0
            if options.verbose and alarms:
                print(f"\nseed {case[0]}: {dict(counted)} {random_unit(*case)[0]}")
            print(f"\r{number}/{options.runs} units, {bad_runs} accused", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    alarms, count = alarms_in(total), total.total()
    upper = beta.ppf(0.95, bad_runs + 1, options.runs - bad_runs)
    print(f"{options.runs} sound units, {count} verdicts: {dict(total)}")
    print(f"false alarms: {alarms} of {count} verdicts ({1000.0 * alarms / count:.2f} per 1000)")
    print(f"units ever accused: {bad_runs} of {options.runs} (95 % upper bound {100.0 * upper:.1f} %)")
    return int(alarms > count / 1000.0)


if __name__ == "__main__":
    raise SystemExit(main())

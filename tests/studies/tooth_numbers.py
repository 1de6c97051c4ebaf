"""What wrong tooth numbers lead to: random cases with a vibration sensor, and random joints without, given wrong teeth.

    python tests/studies/tooth_numbers.py [--cases 24] [--seed 7] [--jobs 2]

Every case (see tests/simulated/cases.py: one speed, ripple, strokes, run-ups, several speeds in turn) is identified
with its right teeth and with teeth that are wrong by 2, 20 and 40 either way; every joint (see
tests/simulated/joints.py) with its right teeth and with neighbours, which share a line with them. Counted: names at
the end, wrong ones among them, wrong ones at any time, and results that doubt the teeth; and the processor time of the
whole identification and of the question of the teeth in it.
"""

import argparse
import functools
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np

from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.identifier import Identifier
from hd_monitor.identification.result import Identification
from hd_monitor.identification.sensorless import identifier as sensorless
from hd_monitor.identification.teeth.watch import ToothWatch
from hd_monitor.limitation import LimitationCode
from hd_monitor.reducer import LinePair

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.simulated.cases import MOTIONS, simulate
from tests.simulated.joints import random_joint, simulate_joint
from tests.simulated.random_cases import random_case

SHIFTS = (0, -40, -20, -2, 2, 20, 40)
"""Teeth given minus those in the case, with a sensor."""

NEIGHBOURS = (0, -4, -3, -2, -1, 1, 2, 3, 4)
"""The same without."""

DOUBTS = {LimitationCode.TEETH_CONTRADICTED, LimitationCode.TEETH_CONTRADICTED_VAGUELY}
AT_ONCE = {"diagnosis.confirm_count": 1, "diagnosis.confirm_window": 1}


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """One identification: what was named, rightly or not, and what it cost [s of processor time]."""

    number: int
    shift: int
    truth: Component
    named: Component
    ever_named: frozenset[Component]
    doubted: bool
    seconds: float
    teeth_seconds: float

    @property
    def is_named(self) -> bool:
        """Whether there is a verdict at the end."""
        return self.named is not Component.UNDETERMINED

    @property
    def is_wrong(self) -> bool:
        """Whether it is a wrong one."""
        return self.is_named and self.named is not self.truth

    @property
    def was_wrong(self) -> bool:
        """Whether there was a wrong one at any time."""
        return bool(self.ever_named - {self.truth, Component.UNDETERMINED})


class Stopwatch:
    """Adds up the processor time of some functions."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def timed(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function, timed."""

        @functools.wraps(function)
        def run(*arguments: Any, **named: Any) -> Any:
            start = time.process_time()
            try:
                return function(*arguments, **named)
            finally:
                self.seconds += time.process_time() - start

        return run


STOPWATCH = Stopwatch()
for _owner, _names in ((ToothWatch, ("after", "look")), (sensorless, ("question_teeth", "question_motor"))):
    for _name in _names:
        setattr(_owner, _name, STOPWATCH.timed(getattr(_owner, _name)))


def judge_case(number: int, seed: int, shifts: Sequence[int] = SHIFTS) -> list[Outcome]:
    """Identify a case with a sensor, given teeth that are off by each of `shifts`."""
    case = random_case(np.random.default_rng([seed, number]), motion=MOTIONS[number % len(MOTIONS)])
    records = simulate(case)
    outcomes = []
    for shift in shifts:
        settings = case.settings(**AT_ONCE, **_teeth(case.model.reducer.flexspline_teeth + shift))
        judge = Judge(settings)
        start, STOPWATCH.seconds = time.process_time(), 0.0
        identifier = Identifier(settings)
        seen: list[Identification | None] = []
        for record in records:
            identifier.add(record)
            seen.append(identifier.estimate())
        seen.append(identifier.finish())
        seconds = time.process_time() - start
        outcomes.append(_outcome(number, shift, case.truth, judge, seen, seconds))
    return outcomes


def judge_joint(number: int, seed: int, shifts: Sequence[int] = NEIGHBOURS) -> list[Outcome]:
    """Identify a joint without a sensor, given teeth that are off by each of `shifts`."""
    rng = np.random.default_rng([seed, number])
    lines = LinePair(*rng.permutation([1.0, 0.4]).tolist())
    joint = random_joint(rng, lines, rate=float(rng.choice([100.0, 125.0, 250.0])))
    samples = simulate_joint(joint)
    truth = Component.CIRCULAR_SPLINE if lines.circular_spline > lines.flexspline else Component.FLEXSPLINE
    outcomes = []
    for shift in shifts:
        settings = joint.settings(**AT_ONCE, **_teeth(joint.reducer.flexspline_teeth + shift))
        start, STOPWATCH.seconds = time.process_time(), 0.0
        identifier = sensorless.SensorlessIdentifier(settings)
        identifier.add(samples)
        found = [identifier.finish()]
        outcomes.append(_outcome(number, shift, truth, Judge(settings), found, time.process_time() - start))
    return outcomes


def _teeth(flexspline: int) -> dict[str, int]:
    return {"reducer.flexspline_teeth": flexspline, "reducer.circular_spline_teeth": flexspline + 2}


def _outcome(
    number: int, shift: int, truth: Component, judge: Judge, seen: Sequence[Identification | None], seconds: float
) -> Outcome:
    """Sum up all results of an identification, the last one the result on everything."""
    named = [judge.judge(result, WAITING).component for result in seen]
    last = seen[-1]
    return Outcome(
        number=number,
        shift=shift,
        truth=truth,
        named=named[-1],
        ever_named=frozenset(named),
        doubted=last is not None and any(limitation.code in DOUBTS for limitation in last.blockers),
        seconds=seconds,
        teeth_seconds=STOPWATCH.seconds,
    )


def table(outcomes: Iterable[Outcome]) -> str:
    """One row for each shift."""
    rows = ["teeth off by | cases  named  wrong  ever wrong  teeth doubted | seconds  of these for the teeth"]
    by_shift: dict[int, list[Outcome]] = {}
    for outcome in outcomes:
        by_shift.setdefault(outcome.shift, []).append(outcome)
    for shift, group in sorted(by_shift.items()):
        named, wrong, ever = (sum(getattr(o, flag) for o in group) for flag in ("is_named", "is_wrong", "was_wrong"))
        rows.append(
            f"{shift:+12d} | {len(group):5d} {named:6d} {wrong:6d} {ever:11d} {sum(o.doubted for o in group):14d} | "
            f"{sum(o.seconds for o in group):7.1f} {sum(o.teeth_seconds for o in group):23.2f}"
        )
    return "\n".join(rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=24)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    with ProcessPoolExecutor(options.jobs) as pool:
        for title, judged in (("With a sensor", judge_case), ("Without a sensor", judge_joint)):
            results = pool.map(judged, range(options.cases), repeat(options.seed))
            print(f"{title}\n{table(outcome for each in results for outcome in each)}\n", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

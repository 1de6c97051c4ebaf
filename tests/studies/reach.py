"""How far does the right verdict reach? Whole chain, simulator to verdict, on random real drives, a set a row.

    python tests/studies/reach.py [--sets clips,error] [--cases 40] [--seed 2027] [--jobs 2] [--verbose]

The sets, what each draws and what the monitor is told stand in `reach_sets.py`. A case is *right* if the last verdict
names what is bad (``none`` where nothing is; the cause too where the set asks for it); *wrong* if any verdict accuses a
spline that is not bad, or the last one calls a bad unit sound; otherwise it is undetermined. That one line of a sound
unit is the larger, which is said at level OK for want of a torque (``HD_UNRATED``), accuses nothing. Beside them: the
wrong ones among all verdicts; how often the 95 % intervals of indexes and transmission errors hold the truth at the
end; processor time of the monitor per simulated second; and how often two plain rules name what is bad, and how often
something else, on the same data (see `plain_rules.py`).
"""

import argparse
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from hd_monitor.acquisition.record import Record
from hd_monitor.arrays import FloatArray
from hd_monitor.assessment import Assessment
from hd_monitor.diagnosis.verdict import Component, FaultCode, Verdict
from hd_monitor.settings import JointSettings
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation, Stretch

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.studies.false_alarms import watch
from tests.studies.plain_rules import higher_peak, linear_fit
from tests.studies.random_drives import SPLINES
from tests.studies.reach_sets import SETS, SOUND, Drive, random_drive

RULES = (
    ("higher peak", lambda settings, records: higher_peak(settings.reducer, records)),
    ("linear fit", linear_fit),
)
ACCUSES = {Component.FLEXSPLINE: {"flexspline"}, Component.CIRCULAR_SPLINE: {"circular_spline"}}
ACCUSES |= {Component.BOTH: set(SPLINES)}


def stretches_of(drive: Drive) -> Iterator[Stretch]:
    """Simulate a drive and add what its sensor hears of the surroundings."""
    heard = iter(_samples(drive.neighbour)) if drive.neighbour else None
    for stretch in Simulation(RigSettings.from_mapping(drive.rig)):
        samples, times = stretch.samples, stretch.motion.times
        for frequency, amplitude, phase in drive.tones:
            samples = samples + amplitude * np.cos(2.0 * np.pi * frequency * times + phase)
        if heard is not None:
            samples = samples + drive.leak * next(heard)
        yield replace(stretch, samples=samples)


def _samples(rig: dict[str, Any]) -> Iterator[FloatArray]:
    return (stretch.samples for stretch in Simulation(RigSettings.from_mapping(rig)))


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What became of one drive.

    Attributes
    ----------
    drive : Drive
    name, number
        The set and the number in it.
    verdicts : tuple of Verdict
        All of them, in order.
    last : Assessment
    rules : tuple of Component
        What each of `RULES` names.
    cost : float
        Processor time of the monitor per simulated second.
    """

    name: str
    number: int
    drive: Drive
    verdicts: tuple[Verdict, ...]
    last: Assessment
    rules: tuple[Component, ...]
    cost: float

    @property
    def wrong_verdicts(self) -> int:
        """Verdicts that accuse a spline that is not bad; the last one also where it calls a bad unit sound."""
        missed = self.verdicts[-1].component is Component.NONE and self.drive.bad != SOUND
        return sum(map(self._accuses, self.verdicts)) + missed

    def _accuses(self, verdict: Verdict) -> bool:
        """Whether a verdict accuses a spline that is not bad."""
        rated = self.drive.bad != SOUND or verdict.fault_code is not FaultCode.UNRATED
        return rated and bool(ACCUSES.get(verdict.component, set()) - {self.drive.bad})

    @property
    def right(self) -> bool:
        """Whether the last verdict names what is bad, and why."""
        verdict, cause = self.last.verdict, self.drive.cause
        return not self.wrong_verdicts and verdict.component == self.drive.bad and cause in ("", verdict.cause)

    def held(self, reading: str) -> list[bool]:
        """Whether the 95 % interval of each spline's ``index`` or ``error`` holds the truth; none without a result."""
        found = self.last.identification
        if found is None or found.relative or found.blockers:
            return []
        name = {"index": "index", "error": "transmission_error"}[reading]
        values, stds = getattr(found, name), getattr(found, f"{name}_std")
        if values is None:
            return []
        rows = zip(values, stds, getattr(self.drive, reading), strict=True)
        return [abs(value - truth) <= 1.96 * std for value, std, truth in rows]

    def __str__(self) -> str:
        """Say what went otherwise than it should."""
        names = [verdict.component for verdict in self.verdicts]
        said = [name.value for n, name in enumerate(names) if n == 0 or name is not names[n - 1]]
        verdict, found, drive = self.last.verdict, self.last.identification, self.drive
        index, error = (" ".join(f"{100 * v:.2f}" for v in drive.index), " ".join(f"{v:.2f}" for v in drive.error))
        line = f"{self.name} {self.number}: bad {drive.bad}, index {index} %, error {error}′; said {' > '.join(said)}"
        line += f" ({verdict.cause.value}): {verdict.reason}"
        if found is not None:
            readings = [f"{100 * v:.2f}±{100 * s:.2f} %" for v, s in zip(found.index, found.index_std, strict=True)]
            if found.transmission_error is not None and found.transmission_error_std is not None:
                pairs = zip(found.transmission_error, found.transmission_error_std, strict=True)
                readings += [f"{v:.3f}±{s:.3f}′" for v, s in pairs]
            line += f"; found {' '.join(readings)}, fn {found.natural_frequency:.2f}, ζ {found.damping_ratio:.4f}"
            line += f", misfit {found.misfit:.2f}, {len(found.blockers)} blockers"
        special = {
            name: value for name, value in drive.rig.items() if not name.startswith((*SPLINES, "reducer", "seed"))
        }
        told = {name: value for name, value in drive.told.items() if drive.rig.get(name) != value}
        line += f"\n    rig {_written(special)}; told {_written(told)}; {len(drive.tones)} tones, leak {drive.leak:.2g}"
        return line


def _written(values: dict[str, Any]) -> str:
    return ", ".join(
        f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}" for name, value in values.items()
    )


def last_assessment(drive: Drive) -> Assessment:
    """Return what a monitor says of a drive in the end."""
    *_, last = watch(stretches_of(drive), drive.told)
    return last


def judge(case: tuple[str, int, int]) -> Outcome:
    """Simulate and judge the drive of a set, a seed and a number."""
    drive = random_drive(*case)
    stretches = list(stretches_of(drive))
    begin = time.process_time()
    assessments = list(watch(stretches, drive.told))
    spent = time.process_time() - begin
    settings, records = JointSettings.from_mapping(drive.told), _records(assessments)
    return Outcome(
        name=case[0],
        number=case[2],
        drive=drive,
        verdicts=tuple(assessment.verdict for assessment in assessments),
        last=assessments[-1],
        rules=tuple(rule(settings, records) if records else Component.UNDETERMINED for _, rule in RULES),
        cost=spent / drive.rig["duration"],
    )


def _records(assessments: Iterable[Assessment]) -> list[Record]:
    return [record for assessment in assessments for record in assessment.records]


@dataclass
class Tally:
    """Counts of one set."""

    cases: int = 0
    right: int = 0
    wrong: int = 0
    verdicts: int = 0
    wrong_verdicts: int = 0
    cost: float = 0.0
    held: dict[str, list[bool]] = field(default_factory=lambda: {"index": [], "error": []})
    rules: list[list[int]] = field(default_factory=lambda: [[0, 0] for _ in RULES])
    """Of each rule: how often it names what is bad, and something else."""

    def add(self, outcome: Outcome) -> None:
        """Count another case."""
        self.cases += 1
        self.right += outcome.right
        self.wrong += outcome.wrong_verdicts > 0
        self.verdicts += len(outcome.verdicts)
        self.wrong_verdicts += outcome.wrong_verdicts
        self.cost += outcome.cost
        for reading, held in self.held.items():
            held += outcome.held(reading)
        for counts, component in zip(self.rules, outcome.rules, strict=True):
            counts[0] += component == outcome.drive.bad
            counts[1] += component not in (outcome.drive.bad, Component.UNDETERMINED)

    def row(self, name: str) -> str:
        """Return the row of the table."""
        shares = [f"{np.mean(held):.1%} of {len(held)}" if held else "–" for held in self.held.values()]
        wanted = SETS[name].wanted
        cells = [
            name,
            self.cases,
            f"{self.right} ({self.right / self.cases:.0%})",
            self.wrong,
            self.cases - self.right - self.wrong,
            f"≥ {wanted:.0%}" if wanted else "–",
            f"{self.wrong_verdicts} of {self.verdicts}",
            *shares,
            f"{self.cost / self.cases:.3f}",
            *(f"{right} / {wrong}" for right, wrong in self.rules),
        ]
        return f"| {' | '.join(map(str, cells))} |"


HEAD = (
    "| set | cases | right | wrong | undetermined | wanted | wrong verdicts | index held | error held | CPU s/s | "
    + " | ".join(f"{title}, right / wrong" for title, _ in RULES)
    + " |"
)


def study(
    cases: int, seed: int, jobs: int = 1, sets: Iterable[str] = SETS, *, verbose: bool = False
) -> Iterator[tuple[str, Tally]]:
    """Judge so many drives of every set and iterate over the sets' counts."""
    with ProcessPoolExecutor(jobs) as pool:
        for name in sets:
            tally = Tally()
            for outcome in (map if jobs == 1 else pool.map)(judge, [(name, seed, number) for number in range(cases)]):
                tally.add(outcome)
                if verbose and not outcome.right:
                    print(outcome, file=sys.stderr, flush=True)
            yield name, tally


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; status 1 if a case is wrong or a set has fewer right ones than it wants."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", default=",".join(SETS), help="comma-separated; all by default")
    parser.add_argument("--cases", type=int, default=40, help="of each set")
    parser.add_argument("--seed", type=int, default=2027)
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--verbose", action="store_true", help="print every case that is not right")
    given = parser.parse_args(arguments)
    failed = False
    print(HEAD, "|---" * HEAD.count(" | ") + "|---|", sep="\n", flush=True)
    for name, tally in study(given.cases, given.seed, given.jobs, given.sets.split(","), verbose=given.verbose):
        print(tally.row(name), flush=True)
        failed |= tally.wrong > 0 or tally.right < SETS[name].wanted * tally.cases
    return int(failed)


if __name__ == "__main__":
    raise SystemExit(main())

"""Which rule names the right part? Three rules on random cases, each a table of truth against verdict.

    python tests/studies/verdicts.py [--cases 300] [--seed 2021] [--jobs 2] [--verbose]

Every case is another reducer with another defect, motion, load, noise and sensor fault (see
tests/simulated/random_cases.py): the confounders of the field. The rules:

* ``higher peak``: the paper's, the higher of the two peaks in the zoom spectrum around the strongest pair;
* ``linear fit``: least squares of what the first order explains (see plain_rules.py for both);
* ``hd_monitor``: the identifier and the judge of this package, at the case's end.

The seeds of this study were never used to tune anything; tuning used others.
"""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path

import numpy as np

from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.identifier import Identifier
from hd_monitor.reducer import LinePair

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.simulated.cases import Case, simulate
from tests.simulated.random_cases import random_case
from tests.studies.plain_rules import higher_peak, linear_fit

RULES = ("higher peak", "linear fit", "hd_monitor")


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """Verdicts on one case, and the normalised errors of the identified indexes."""

    number: int
    case: Case
    verdicts: tuple[Component, ...]
    index: LinePair
    index_std: LinePair
    reason: str


def judge_case(number: int, seed: int) -> Outcome:
    """Draw, simulate and judge the case with this number."""
    case = random_case(np.random.default_rng([seed, number]))
    records = simulate(case)
    settings = case.settings(**{"diagnosis.confirm_count": 1, "diagnosis.confirm_window": 1})
    identifier = Identifier(settings)
    for record in records:
        identifier.add(record)
    result = identifier.finish()
    verdict = Judge(settings).judge(result, WAITING)
    unknown = LinePair(math.nan, math.nan)
    return Outcome(
        number=number,
        case=case,
        verdicts=(higher_peak(settings.reducer, records), linear_fit(settings, records), verdict.component),
        index=result.index if result else unknown,
        index_std=result.index_std if result else unknown,
        reason=verdict.reason,
    )


def outcomes(cases: int, seed: int, jobs: int) -> Iterable[Outcome]:
    """Judge cases, in their order."""
    if jobs <= 1:
        yield from map(judge_case, range(cases), repeat(seed))
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(judge_case, range(cases), repeat(seed))


def table(results: Sequence[Outcome], rule: int) -> str:
    """Confusion table of one rule."""
    counts = Counter((r.case.truth, r.verdicts[rule]) for r in results)
    columns = tuple(Component)
    lines = [f"{'truth / verdict':18}" + "".join(f"{c.value:>17}" for c in columns)]
    for truth in columns[:-1]:
        lines.append(f"{truth.value:18}" + "".join(f"{counts[truth, c]:17d}" for c in columns))
    return "\n".join(lines)


def summary(results: Sequence[Outcome], rule: int) -> str:
    """Shares of right names among the named, and of undetermined."""
    named = [r for r in results if r.verdicts[rule] is not Component.UNDETERMINED]
    right = sum(r.verdicts[rule] is r.case.truth for r in named)
    single = [r for r in named if r.case.truth in (Component.CIRCULAR_SPLINE, Component.FLEXSPLINE)]
    of_single = sum(r.verdicts[rule] is r.case.truth for r in single)
    return (
        f"right {right} of {len(named)} named = {100.0 * right / max(len(named), 1):.1f} %; where one spline is at "
        f"fault {of_single} of {len(single)} = {100.0 * of_single / max(len(single), 1):.1f} %; "
        f"undetermined {len(results) - len(named)} of {len(results)}"
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=300)
    parser.add_argument("--seed", type=int, default=2021)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--verbose", action="store_true", help="print every case that hd_monitor gets wrong or leaves")
    options = parser.parse_args(arguments)
    results = []
    for result in outcomes(options.cases, options.seed, options.jobs):
        results.append(result)
        print(f"\r{len(results)} of {options.cases} cases", end="", file=sys.stderr, flush=True)
        if options.verbose and result.verdicts[-1] is not result.case.truth:
            print(f"\n{result.number}: truth {result.case.truth.value} {result.case.index}, {result.reason}")
    print(file=sys.stderr)
    for rule, title in enumerate(RULES):
        print(f"\n{title}\n{table(results, rule)}\n{summary(results, rule)}")
    errors = np.array([np.subtract(r.index, r.case.index) / r.index_std for r in results])
    errors = errors[np.isfinite(errors).all(axis=1)]
    print(f"\n95 % intervals of the indexes cover the truth in {100.0 * np.mean(np.abs(errors) < 1.96):.1f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main())

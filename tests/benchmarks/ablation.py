"""What each mechanism of the estimator costs and saves: every one switched off, on the same random cases.

    python tests/benchmarks/ablation.py [--cases 40] [--seed 7] [--only NAME …]

A row is one mechanism switched off. ``CPU`` is the estimator's CPU time over that of the whole estimator in the same
run, ``error`` the median absolute error of the indexes over the same, ``cover`` the share of 95 % intervals that hold
the truth, and the rest counts verdicts. A mechanism that only saves time should change nothing but the first column, by
more than 10 %; one that makes results right should be missed in the others.
"""

import argparse
import contextlib
import math
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from unittest import mock

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.simulated.cases import Case, simulate
from tests.simulated.random_cases import random_case

from hd_monitor.acquisition.record import Record
from hd_monitor.arrays import BoolArray, FloatArray
from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.checks.residual import LineResidual, Overdispersion
from hd_monitor.identification.fit import multistart
from hd_monitor.identification.fit.gauss_newton import Fit, Problem
from hd_monitor.identification.identifier import Identifier
from hd_monitor.identification.segment import decimation, segment
from hd_monitor.identification.with_sensor import estimator, search
from hd_monitor.identification.with_sensor.context import Context
from hd_monitor.identification.with_sensor.estimator import Estimator
from hd_monitor.identification.with_sensor.state import Setup, State
from hd_monitor.process import set_up_process

Patch = Callable[[], contextlib.AbstractContextManager[object]]


def without(target: object, name: str, new: object) -> Patch:
    """Return what replaces an attribute while a mechanism is off."""
    return lambda: mock.patch.object(target, name, new)


def one_start(context: Context, state: State, fit: Fit | None) -> tuple[State, Fit]:
    """Look for no other solution; the first segment is fitted from a single start."""
    if fit is not None:
        return state, fit
    return REAL_RESTART(context, state, multistart.signal_level(state.recent), [state.values])


def best_only(self: Problem, starts: Sequence[FloatArray], *, rounds: int) -> tuple[Fit, None]:
    """Forget all solutions but the best."""
    return REAL_CONTEND(self, starts, rounds=rounds)[0], None


def phasors_only(self: Context, setup: Setup) -> BoolArray:
    """Take all that is given as exact."""
    return self.unknowns.mask(self.unknowns.stiffness, self.unknowns.load, self.unknowns.displacement)


def plain_decimation(raw: np.ndarray, period: float, line: float, natural: float) -> object:
    """Keep the sensor's rate."""
    return REAL_DECIMATION(raw, period, 1e9, 1e9)


REAL_DECIMATION, REAL_RESTART, REAL_CONTEND = decimation.decimate, search.restart, Problem.contend

MECHANISMS: dict[str, tuple[str, Patch]] = {
    "linear last step": (
        "a step too small to bend the model is taken without simulating its end",
        without(Problem, "_curvature", lambda self, fit: math.inf),
    ),
    "decimation": ("samples faster than the lines need are reduced", without(segment, "decimate", plain_decimation)),
    "tone removal": (
        "tones of fixed frequency are projected out",
        without(segment, "foreign_tones", lambda *a: np.empty(0)),
    ),
    "torque regression": (
        "measured torque is freed from its noise",
        without(segment, "regress_torque", lambda t, *a: t),
    ),
    "second look": (
        "other solutions are tried where the fit is poor",
        without(estimator, "look_elsewhere", one_start),
    ),
    "sensor sign": (
        "a sensor mounted the other way round is recognised",
        without(estimator, "turn_sensor", lambda c, s, f: (s, f)),
    ),
    "starts for what was given": (
        "natural frequency and delay have their own starts",
        without(search, "other_starts", lambda *a, **k: []),
    ),
    "starts for the load": ("the load's phase has its own starts", without(multistart, "START_LOADS", ())),
    "given scalars": (
        "natural frequency, damping, torque, inertia and clocks are estimated along",
        without(Context, "active", phasors_only),
    ),
    "rival": ("a second solution that is not excluded widens the intervals", without(Problem, "contend", best_only)),
    "line residual": (
        "intervals are widened by what is left at the lines",
        without(LineResidual, "inflation", lambda self, span: 1.0),
    ),
    "overdispersion": ("intervals are widened by what segments contradict", without(Overdispersion, "inflation", 1.0)),
    "tooth numbers": (
        "other tooth numbers are tried",
        without(Estimator, "_question_teeth", lambda self, state, fit: state.teeth),
    ),
    "sparing looks": ("once sure, only a part of the motion is looked at", without(Identifier, "_is_cruising", False)),
}


@dataclass(slots=True, kw_only=True)
class Outcome:
    """What an estimator made of all cases."""

    seconds: float = 0.0
    errors: list[float] = field(default_factory=list)
    inside: list[bool] = field(default_factory=list)
    verdicts: Counter[str] = field(default_factory=Counter)

    def add(self, case: Case, records: Sequence[Record]) -> None:
        """Identify and judge a case."""
        settings = case.settings(**{"diagnosis.confirm_count": 1, "diagnosis.confirm_window": 1})
        start = time.process_time()
        identifier = Identifier(settings)
        for record in records:
            identifier.add(record)
        found = identifier.finish()
        self.seconds += time.process_time() - start
        named = Judge(settings).judge(found, WAITING).component
        right = "right" if named is case.truth else "wrong"
        self.verdicts["undetermined" if named is Component.UNDETERMINED else right] += 1
        if found is not None and not found.relative:
            error = np.abs(np.subtract(found.index, case.index))
            self.errors.extend(error.tolist())
            self.inside.extend((error < 1.96 * np.asarray(found.index_std)).tolist())

    def row(self, whole: "Outcome") -> str:
        """Figures of a row, in relation to those of the whole estimator on the same cases."""
        counts = "".join(f"{self.verdicts[kind]:7d}" for kind in ("right", "wrong", "undetermined"))
        error = np.median(self.errors) / np.median(whole.errors)
        return f"{self.seconds / whole.seconds:6.2f} {error:6.2f} {np.mean(self.inside):6.1%}{counts}"


def compare(cases: Sequence[tuple[Case, list[Record]]], patch: Patch) -> tuple[Outcome, Outcome]:
    """Run the whole estimator and one without a mechanism in turn, so that the machine's pace affects both equally."""
    whole, without_it = Outcome(), Outcome()
    for case, records in cases:
        whole.add(case, records)
        with patch():
            without_it.add(case, records)
    return whole, without_it


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--only", nargs="*", choices=MECHANISMS, help="mechanisms to switch off (default: each)")
    options = parser.parse_args(arguments)
    set_up_process()
    cases = [random_case(np.random.default_rng([options.seed, number])) for number in range(options.cases)]
    simulated = [(case, simulate(case)) for case in cases]
    print(f"{'switched off':26} {'CPU':>6} {'error':>6} {'cover':>6}  right  wrong undet.")
    for number, name in enumerate(options.only or MECHANISMS):
        text, patch = MECHANISMS[name]
        whole, without_it = compare(simulated, patch)
        if not number:
            print(f"{'nothing':26} {whole.row(whole)}")
        print(f"{name:26} {without_it.row(whole)}  {text}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

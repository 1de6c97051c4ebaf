"""Do the standard deviations mean what they say, and is the estimate as good as any can be?

    python tests/benchmarks/estimator_calibration.py [--runs 500] [--seed 77] [--jobs 2]

Two figures. *Coverage*: on random cases (see estimator_cases.py; white noise, no sensor faults), how often do the 95 %
intervals, index ± 1.96 standard deviations, hold the truth? *Efficiency*: at one speed with separable lines, the
variance of the indexes over many noises against the Cramér-Rao bound, which is computed from the harmonic balance and
so shares no code with the estimator.
"""

import argparse
import math
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import repeat
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.stats import binom

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.identifier import Identifier
from hd_monitor.model import ParametricModel, StiffnessSeries, steady_state, table_1
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.benchmarks.estimator_cases import Case, random_case, simulate

FloatArray = npt.NDArray[np.float64]

CLEAN = {"colour": "white", "spikes": 0.0, "lost": 0.0}
SPEED = 1000.0  # rpm: lines at 33, 67 and 100 Hz, off the natural frequency of 55 Hz
RATE, DURATION = 1000.0, 20.0
NOISE = 0.5  # rad/s²


def coverage_errors(number: int, seed: int) -> tuple[float, float]:
    """Errors of both indexes on one random case, in standard deviations."""
    case = random_case(np.random.default_rng([seed, number]), **CLEAN)
    result = identify(simulate(case), case.settings())
    errors = np.subtract(result.index, case.index) / np.asarray(result.index_std)
    return float(errors[0]), float(errors[1])


def identify(records: Sequence[Record], settings: JointSettings):
    """Run the identifier over records."""
    identifier = Identifier(settings)
    for record in records:
        identifier.add(record)
    return identifier.finish()


def steady_case(seed: int) -> Case:
    """Return the case of the efficiency figure: Table 1 at a constant speed, noise added apart."""
    return Case(
        model=table_1(),
        motion="dwell",
        speed=SPEED,
        span=0.0,
        duration=DURATION,
        snr=400.0,
        colour="white",
        spikes=0.0,
        lost=0.0,
        measured=False,
        rate=RATE,
        seed=seed,
    )


def steady_indexes(number: int, seed: int) -> LinePair:
    """Indexes identified from the steady case with noise of its own."""
    case = steady_case(seed)
    noise = np.random.default_rng([seed, number])
    records = [replace(r, acceleration=r.acceleration + NOISE * noise.standard_normal(len(r))) for r in simulate(case)]
    index: LinePair = identify(records, case.settings()).index
    return index


def bound(model: ParametricModel, speed: float, samples: int, noise: float) -> LinePair:
    """Least standard deviations of the indexes: Fisher information of the amplitudes of all lines, white noise."""

    def lines(phasors: npt.NDArray[np.complex128]) -> FloatArray:
        circular, flex = np.split(phasors, 2)
        state = steady_state(
            replace(
                model,
                circular_spline=StiffnessSeries.from_phasors(circular),
                flexspline=StiffnessSeries.from_phasors(flex),
            ),
            speed,
        )
        positive = 2.0 * state.acceleration[state.orders > 0]
        return np.concatenate([positive.real, positive.imag])

    truth = np.concatenate([model.circular_spline.phasors, model.flexspline.phasors])
    step = 1e-5
    columns = []
    for unit in (1.0, 1j):
        for place in range(truth.size):
            change = np.zeros(truth.size, dtype=np.complex128)
            change[place] = unit * step
            columns.append((lines(truth + change) - lines(truth - change)) / (2.0 * step))
    jacobian = np.stack(columns, axis=1)
    # a line's real and imaginary part are each known to the variance 2 noise² / samples
    covariance = np.linalg.inv(jacobian.T @ jacobian) * 2.0 * noise**2 / samples
    stds = []
    for part in np.split(np.arange(truth.size), 2):
        both = np.concatenate([part, part + truth.size])
        direction = np.concatenate([truth[part].real, truth[part].imag]) / np.linalg.norm(truth[part])
        stds.append(math.sqrt(float(direction @ covariance[np.ix_(both, both)] @ direction)))
    return LinePair(*stds)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print both figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=77)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    runs = options.runs
    with ProcessPoolExecutor(options.jobs) as pool:
        errors = np.array(list(pool.map(coverage_errors, range(runs), repeat(options.seed))))
        hits = np.abs(errors) < 1.96
        low, high = binom.interval(0.95, runs, 0.95)
        for spline, hit in zip(LinePair._fields, hits.T, strict=True):
            print(
                f"coverage of the {spline} index: {100.0 * hit.mean():.1f} % of {runs} runs (chance leaves "
                f"{100.0 * low / runs:.1f} to {100.0 * high / runs:.1f} %)"
            )
        print(
            f"coverage of both together: {100.0 * hits.mean():.1f} %; RMS error {np.sqrt(np.mean(errors**2)):.2f} std"
        )
        found = np.array(list(pool.map(steady_indexes, range(runs), repeat(options.seed))))
    least = bound(table_1(), SPEED, int(DURATION * RATE), NOISE)
    chance = math.sqrt(2.0 / runs)
    for spline, values, std in zip(LinePair._fields, found.T, least, strict=True):
        ratio = float(np.var(values, ddof=1)) / std**2
        print(f"variance of the {spline} index over the Cramér-Rao bound: {ratio:.3f} ± {ratio * chance:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Do the standard deviations mean what they say, and is the estimate as good as any can be?

    python tests/studies/calibration.py [--runs 500] [--seed 777000] [--jobs 2]

*Coverage*: on random cases (see tests/simulated/random_cases.py; white noise, no sensor faults), how often do the 95 %
intervals, index ± 1.96 standard deviations, hold the truth? Near 0 an interval is meant to hold more.

*Efficiency*: Table 1 at a constant speed with separable lines, over many noises: the variance of the estimates over
the Cramér-Rao bound for all that is estimated along (see cramer_rao.py), for each index and for all β of each
spline, and the variance that the estimator reports over the same bound. The plain ratio is followed by one with less
chance in it: with the noise known, so is the error of the efficient estimate, whose variance *is* the bound; only
what the estimate adds to that error has to be measured. Twice the standard error follows every ±.
"""

import argparse
import math
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path

import numpy as np
from scipy.stats import binom

from hd_monitor.acquisition.record import Record
from hd_monitor.arrays import FloatArray
from hd_monitor.identification.identifier import Identifier
from hd_monitor.identification.result import Identification
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.oracle import table_1
from tests.simulated.cases import Case, simulate
from tests.simulated.random_cases import random_case
from tests.studies import cramer_rao

CLEAN = {"colour": "white", "spikes": 0.0, "lost": 0.0}
SPEED = 1000.0  # rpm: lines at 33, 67 and 100 Hz, off the natural frequency of 55 Hz; two output turns in 10 s
RATE, DURATION = 1000.0, 10.0
NOISE = 0.5  # rad/s²
FITTED = np.ones(cramer_rao.SIZE, dtype=np.bool_)
FITTED[[cramer_rao.FREQUENCY, cramer_rao.DAMPING]] = False  # at one speed they are taken as given
FITTED.flags.writeable = False
SPLINES = tuple(zip(LinePair._fields, (slice(0, 6), slice(6, 12)), strict=True))
WITHIN = 1.96


@dataclass(frozen=True, slots=True, kw_only=True)
class Ratio:
    """A ratio of variances and its standard error."""

    value: float
    std: float

    def __str__(self) -> str:
        """Return the ratio ± two standard errors."""
        return f"{self.value:.3f} ± {2.0 * self.std:.3f}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Efficiency:
    """Variance over the Cramér-Rao bound.

    Attributes
    ----------
    plain, controlled : Ratio
        Of the estimates, as it is, and with the efficient estimate's own error, whose variance is known, taken out.
    reported : float
        Of the variance that the estimator reports: the median, since a run in some hundred finds reason by chance to
        doubt what it was given, and then says so in its variance.
    """

    plain: Ratio
    controlled: Ratio
    reported: float


EXACT = {
    "dynamics.natural_frequency_uncertainty": 0.0,
    "dynamics.damping_uncertainty": 0.0,
    "dynamics.inertia_uncertainty": 0.0,
    "load.torque_uncertainty": 0.0,
    "load.assumed_uncertainty": 0.0,
    "input.delay_uncertainty": 0.0,
    "input.clock_drift": 0.0,
}
"""What the bound takes as known: all that is given."""


def identify(records: Sequence[Record], settings: JointSettings) -> Identification:
    """Run the identifier over records, all of them."""
    identifier = Identifier(settings, sparing=False)
    for record in records:
        identifier.add(record)
    result = identifier.finish()
    assert result is not None
    return result


# Coverage -------------------------------------------------------------------------------------------------------------


def coverage_errors(number: int, seed: int) -> tuple[float, float]:
    """Errors of both indexes on one random case, in standard deviations."""
    case = random_case(np.random.default_rng([seed, number]), **CLEAN)
    result = identify(simulate(case), case.settings())
    errors = np.subtract(result.index, case.index) / np.asarray(result.index_std)
    return float(errors[0]), float(errors[1])


def print_coverage(errors: FloatArray) -> None:
    """Print the table of coverage from errors in standard deviations, shape (runs, 2)."""
    print(
        f"{'95 % intervals':22}{'runs':>6}{'cover':>9}{'if exact, by chance':>22}{'median error':>14}{'RMS error':>11}"
    )
    pairs = [(name, errors[:, i]) for i, name in enumerate(LinePair._fields)]
    for name, values in [*pairs, ("both", errors.ravel())]:
        low, high = binom.interval(0.95, len(errors), 0.95)
        chance = f"{100.0 * low / len(errors):.1f} to {100.0 * high / len(errors):.1f} %"
        hits = np.abs(values) < WITHIN
        median = float(np.median(np.abs(values))) / 0.6745
        rms = math.sqrt(float(np.mean(values**2)))
        print(f"{name:22}{len(errors):6}{100.0 * hits.mean():8.1f} %{chance:>22}{median:12.2f} σ{rms:9.2f} σ")


# Efficiency -----------------------------------------------------------------------------------------------------------


@lru_cache(maxsize=1)
def steady_records() -> tuple[Case, tuple[Record, ...]]:
    """Return the case of the efficiency figures and its records without noise."""
    case = Case(
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
        seed=1,
    )
    return case, tuple(simulate(case))


def steady_bound() -> cramer_rao.Bound:
    """Bound for the steady case: all β, loads once and twice a turn, and the state at the start are unknown."""
    case, records = steady_records()
    angle = np.concatenate([record.angle for record in records])
    times = np.arange(angle.size) / RATE
    line = np.polyfit(times, angle, 1)
    return cramer_rao.bound(case.model, line, samples=angle.size, rate=RATE, noise=NOISE, unknown=FITTED, informed=True)


def steady_noise(number: int, seed: int) -> FloatArray:
    """White noise [rad/s²] of one run."""
    return NOISE * np.random.default_rng([seed, number]).standard_normal(int(DURATION * RATE))


def steady_run(number: int, seed: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """β (as in the bound) and indexes identified with noise of its own, and the variances reported of both."""
    case, records = steady_records()
    noise = np.split(steady_noise(number, seed), len(records))
    result = identify(
        [replace(r, acceleration=r.acceleration + n) for r, n in zip(records, noise, strict=True)],
        case.settings(**EXACT),
    )
    beta = np.concatenate([part for b in (result.circular_spline, result.flexspline) for part in (b.real, b.imag)])
    assert result.beta_covariance is not None
    variances = np.einsum("skii->sik", result.beta_covariance).ravel()
    return beta, variances, np.asarray(result.index), np.asarray(result.index_std) ** 2


def efficiencies(runs: Sequence[tuple[FloatArray, ...]], seed: int) -> dict[str, Efficiency]:
    """Efficiency of each index and of all β of each spline, from runs numbered from 0."""
    least = steady_bound()
    ideal = np.array([least.efficient_error(steady_noise(number, seed)) for number in range(len(runs))])
    beta, variances, index, index_variances = (np.array(part) for part in zip(*runs, strict=True))
    found: dict[str, Efficiency] = {}
    for spline, (name, part) in enumerate(SPLINES):
        covariance = least.covariance[part, part]
        truth = least.truth[part]
        direction = truth / np.linalg.norm(truth)
        found[f"{name} index"] = _efficiency(
            (index[:, [spline]] - np.linalg.norm(truth)),
            ideal[:, part] @ direction[:, None],
            np.array([[direction @ covariance @ direction]]),
            index_variances[:, [spline]],
        )
        found[f"{name} β"] = _efficiency(beta[:, part] - truth, ideal[:, part], covariance, variances[:, part])
    return found


def _efficiency(error: FloatArray, ideal: FloatArray, least: FloatArray, reported: FloatArray) -> Efficiency:
    """Compare errors, shape (runs, quantities), with those of the efficient estimate, whose covariance is `least`."""
    inverse = np.linalg.inv(least)
    count, size = error.shape
    spread = error - error.mean(axis=0)
    added = error - ideal
    added = added - added.mean(axis=0)
    plain = np.einsum("ni,ij,nj->n", spread, inverse, spread) / size
    control = np.einsum("ni,ij,nj->n", 2.0 * ideal + added, inverse, added) / size
    bessel = count / (count - 1.0)
    return Efficiency(
        plain=Ratio(value=bessel * float(plain.mean()), std=float(plain.std()) / math.sqrt(count)),
        controlled=Ratio(value=1.0 + bessel * float(control.mean()), std=float(control.std()) / math.sqrt(count)),
        reported=float(np.median(np.mean(reported / least.diagonal(), axis=1))),
    )


def print_efficiency(found: dict[str, Efficiency]) -> None:
    """Print the table of efficiencies."""
    print(f"{'over the bound':22}{'variance':>16}{'with less chance':>18}{'variance reported':>19}")
    for name, value in found.items():
        print(f"{name:22}{value.plain!s:>16}{value.controlled!s:>18}{value.reported:19.3f}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=777_000)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    numbers = range(options.runs)
    with ProcessPoolExecutor(options.jobs) as pool:
        print_coverage(np.array(list(pool.map(partial(coverage_errors, seed=options.seed), numbers))))
        print(flush=True)
        print_efficiency(efficiencies(list(pool.map(partial(steady_run, seed=options.seed), numbers)), options.seed))
    return 0


if __name__ == "__main__":
    sys.exit(main())

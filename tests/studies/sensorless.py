"""Study of the sensorless mode: what it finds, misses and invents, on random joints with a known truth.

    python tests/studies/sensorless.py [--cases 100] [--seed 2024] [--recordings DIR]

prints the tables that the documentation quotes. With ``--recordings`` (a folder of UR10e joint states, one CSV a run:
time, six positions, six velocities, six currents …) also what a real arm shows, and what is found where no line is.
"""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy import stats

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.arrays import FloatArray
from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.result import Identification
from hd_monitor.identification.sensorless.identifier import SensorlessIdentifier
from hd_monitor.offline.identify_teeth import rank_tooth_pairs
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.simulated.joints import random_joint, simulate_joint

UR10E = {
    "reducer.flexspline_teeth": 200,
    "reducer.circular_spline_teeth": 202,
    "reducer.mount": "flexspline_fixed",
}
TRUTHS = [(0.0, 0.0), (0.3, 0.3), (1.0, 1.0), (0.3, 0.1), (0.1, 0.3), (1.0, 0.3), (0.3, 1.0), (1.0, 0.7), (0.7, 1.0)]
PLACEBO_TEETH = [(z, z + 2) for z in (*range(188, 193), *range(208, 213), 80, 100, 120, 160, 180, 220, 240, 300)]

REPEATED = 0.1
"""Part of the motion that may come again at a shift, at the same speed within 2 %."""


def verdict(found: Identification | None, settings: JointSettings) -> Component:
    """Component that the monitor would show if this evidence stays."""
    judge = Judge(settings)
    for _ in range(settings.diagnosis.confirm_window):
        shown = judge.judge(found, WAITING)
    return shown.component


def run(samples: JointSamples, settings: JointSettings) -> SensorlessIdentifier:
    """Identify from a whole recording."""
    identifier = SensorlessIdentifier(settings)
    identifier.add(samples)
    identifier.estimate()
    return identifier


def study_names(cases: int, seed: int) -> list[str]:
    """Verdicts by the true ratio and size of the two lines."""
    rows = [
        "Verdicts; a line's size is in standard deviations of the current's noise. Right is the larger one, both where",
        "they are equal, and undetermined where there is none.",
        "circular spline  flexspline |   right   wrong  undetermined",
    ]
    for cs, fs in TRUTHS:
        rng = np.random.default_rng([seed, round(10 * cs), round(10 * fs)])
        counts: Counter[Component] = Counter()
        for _ in range(cases):
            case = random_joint(rng, LinePair(cs, fs))
            settings = case.settings()
            counts[verdict(run(simulate_joint(case), settings).estimate(), settings)] += 1
        right = {1: Component.CIRCULAR_SPLINE, -1: Component.FLEXSPLINE, 0: Component.BOTH}[(cs > fs) - (cs < fs)]
        if cs == fs == 0.0:
            right = Component.UNDETERMINED
        undetermined = counts[Component.UNDETERMINED] if right is not Component.UNDETERMINED else 0
        wrong = cases - counts[right] - undetermined
        rows.append(
            f"{cs:15.1f}  {fs:10.1f} | {counts[right] / cases:7.1%} {wrong / cases:7.1%} {undetermined / cases:13.1%}"
        )
    return rows


def study_chances(cases: int, seed: int) -> list[str]:
    """How often a line is found, direction by direction, where there is none."""
    rng = np.random.default_rng([seed, 1])
    chances: list[float] = []
    for _ in range(cases):
        case = random_joint(rng, LinePair(0.0, 0.0))
        chances += [chance for side in run(simulate_joint(case), case.settings()).directions for chance in side.chance]
    return false_alarms("Joints without lines", np.array(chances))


def false_alarms(title: str, chances: np.ndarray) -> list[str]:
    """Share of lines below each probability; an honest test finds no more than that."""
    shares = "  ".join(f"{np.mean(chances < level):.4f} below {level:g}" for level in (0.1, 0.01, 0.001))
    return [f"{title}: {chances.size} lines looked for, {shares}"]


def study_coverage(cases: int, seed: int) -> list[str]:
    """Share of 95 % intervals of the amplitudes that hold the truth; a lag makes the phases change with the speed."""
    rows = []
    for title, lag in (("no lag of the current", {"lag": 0.0}), ("a lag of up to 4 ms", {})):
        rng = np.random.default_rng([seed, 2])
        inside = total = 0
        for _ in range(cases):
            case = random_joint(rng, LinePair(*rng.uniform(0.3, 1.0, 2)), speed_dependence=0.0, **lag)
            for side in run(simulate_joint(case), case.settings()).directions:
                truth = case.lines[1 if side.name.startswith("reverse") else 0]
                for found, std, true in zip(side.amplitude, side.std, truth, strict=True):
                    inside += abs(found - true) < 1.96 * std
                    total += 1
        low, high = stats.binomtest(inside, total).proportion_ci()
        rows.append(
            f"95 % intervals of the amplitudes, {title}: {inside / total:.1%} hold the truth ({low:.1%} to {high:.1%})"
        )
    return rows


def study_teeth(cases: int, seed: int) -> list[str]:
    """Tooth pairs ranked out of every pair."""
    rows = []
    for cs, fs in ((0.0, 0.0), (0.5, 0.0), (0.5, 0.5)):
        rng = np.random.default_rng([seed, 3, round(10 * fs)])
        first = sure = wrong = 0
        for _ in range(cases):
            case = random_joint(rng, LinePair(cs, fs))
            teeth = (case.reducer.flexspline_teeth, case.reducer.circular_spline_teeth)
            ranking = rank_tooth_pairs(simulate_joint(case))
            best = ranking.ranked[0].teeth == teeth
            first += best
            sure += ranking.conclusive and best
            wrong += ranking.conclusive and not best
        rows.append(
            f"Tooth pairs, lines {cs:.1f} and {fs:.1f}: ranked first {first / cases:.0%}, conclusive and right "
            f"{sure / cases:.0%}, conclusive and wrong {wrong / cases:.1%} of {cases}"
        )
    return rows


def read_recordings(folder: Path) -> Iterable[tuple[str, JointSamples]]:
    """Joints of a UR10e's recordings that move by more than 30°."""
    for file in sorted(folder.glob("*.csv")):
        table = np.loadtxt(file, delimiter=",")
        for joint in range(1, 7):
            angle = table[:, joint]
            if np.ptp(angle) > math.radians(30.0):
                yield (
                    f"{file.stem} J{joint}",
                    JointSamples(
                        times=table[:, 0] - table[0, 0],
                        angle=angle,
                        speed=table[:, 6 + joint],
                        effort=table[:, 12 + joint],
                    ),
                )


def study_recordings(folder: Path) -> list[str]:
    """What a real arm's joints show, and what they show where no line should be."""
    rows = []
    for source, unit, scale in (("joint_effort", "mA", 1e3), ("joint_velocity", "mrad/s", 1e3)):
        settings = JointSettings.from_mapping(UR10E | {"input.source": source})
        rows.append(
            f"UR10e, {source}: 200 line and 202 line [{unit}], chance of noise, confidence that 200 | 202 leads"
        )
        placebo: list[float] = []
        detections = looked = 0
        for name, samples in read_recordings(folder):
            identifier = run(samples, settings)
            rows.append(f"{name}: {verdict(identifier.estimate(), settings)}")
            for side in identifier.directions:
                sizes = ", ".join(
                    f"{scale * size:.1f} ± {scale * std:.1f} ({chance:.0e})"
                    for size, std, chance in zip(side.amplitude, side.std, side.chance, strict=True)
                )
                rows.append(f"    {side.name}: {sizes}; {side.dominance[0]:.3f} | {side.dominance[1]:.3f}")
            rows.append(f"    teeth: {rank_tooth_pairs(samples, source=source).statement}")
            for z1, z2 in PLACEBO_TEETH:
                other = JointSettings.from_mapping(
                    UR10E
                    | {
                        "input.source": source,
                        "reducer.flexspline_teeth": z1,
                        "reducer.circular_spline_teeth": z2,
                        "analysis.harmonics": 1,
                    }
                )
                sides = run(samples, other)
                placebo += [chance for side in sides.directions for chance in side.chance]
                looked += 1
                detections += verdict(sides.estimate(), other) is not Component.UNDETERMINED
        rows += false_alarms(f"UR10e, {source}, with other tooth numbers", np.array(placebo))
        rows.append(f"… and {detections} of {looked} verdicts with other tooth numbers name a spline")
    return rows


def phase_randomised(samples: JointSamples, rng: np.random.Generator) -> FloatArray:
    """Effort with the same spectrum and nothing else in common with the motion."""
    values = samples.effort
    spectrum = np.fft.rfft(values - values.mean())
    turned = np.abs(spectrum) * np.exp(1j * rng.uniform(0.0, math.tau, spectrum.size))
    return np.fft.irfft(turned, values.size) + values.mean()


def shifted(samples: JointSamples, rng: np.random.Generator) -> FloatArray:
    """Effort moved in time, by a tenth of the recording at least.

    Where the joint then moves as before, or in its mirror image, the lines still stand at their orders: such a shift
    is no control.
    """
    pace = np.abs(samples.speed)
    moves = pace > 0.1 * pace.max()
    for _ in range(100):
        by = int(rng.uniform(0.1, 0.9) * pace.size)
        alike = np.abs(np.roll(pace, by) - pace) < 0.02 * pace
        if alike[moves].mean() < REPEATED:
            return np.roll(samples.effort, by)
    raise ValueError("the motion repeats itself at every shift")


def controls(folder: Path, each: int, seed: int) -> Iterable[tuple[str, JointSamples]]:
    """Recordings whose effort has lost its relation to the angle: `each` of either kind for every joint."""
    rng = np.random.default_rng(seed)
    for name, samples in read_recordings(folder):
        for spoil in (phase_randomised, shifted):
            for _ in range(each):
                yield f"{name}, {spoil.__name__}", replace(samples, effort=spoil(samples, rng))


def study_controls(folder: Path, seed: int) -> list[str]:
    """What is named where the effort has nothing to do with the angle."""
    settings = JointSettings.from_mapping(UR10E | {"input.source": "joint_effort"})
    named, count = [], 0
    for name, samples in controls(folder, 4, seed):
        component = verdict(run(samples, settings).estimate(), settings)
        count += 1
        if component is not Component.UNDETERMINED:
            named.append(f"{name}: {component}")
    return [f"UR10e, controls with phase-randomised or shifted effort: {len(named)} of {count} named", *named]


def study_histories(folder: Path) -> list[str]:
    """What all recordings of a joint show together."""
    rows = []
    for source in ("joint_effort", "joint_velocity"):
        settings = JointSettings.from_mapping(UR10E | {"input.source": source, "analysis.memory": 3600.0})
        identifiers = {joint: SensorlessIdentifier(settings) for joint in range(1, 7)}
        for name, samples in read_recordings(folder):
            identifiers[int(name[-1])].add(samples)
            identifiers[int(name[-1])].cut()
        for joint, identifier in identifiers.items():
            rows.append(f"UR10e, {source}, joint {joint}, all recordings: {verdict(identifier.estimate(), settings)}")
    return rows


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=100, help="random joints per row (100)")
    parser.add_argument("--seed", type=int, default=2024)
    parser.add_argument("--recordings", type=Path, help="folder of UR10e recordings (CSV)")
    options = parser.parse_args()
    studies: list[Callable[[int, int], list[str]]] = [study_names, study_chances, study_coverage, study_teeth]
    for study in studies:
        print(*study(options.cases, options.seed), "", sep="\n", flush=True)
    if options.recordings is not None:
        print(*study_recordings(options.recordings), *study_histories(options.recordings), sep="\n")
        print(*study_controls(options.recordings, options.seed), sep="\n")


if __name__ == "__main__":
    main()

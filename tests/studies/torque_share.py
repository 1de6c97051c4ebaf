"""Study of the torque share: how often its interval holds the truth, and what it reads, on random joints.

    python tests/studies/torque_share.py [--cases 100] [--seed 7]

The torque swings with gravity and acceleration behind the friction. A line's size may also change with the speed, by up
to 30 %, which the fit does not know.
"""

import argparse
import math
import sys
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hd_monitor.identification.sensorless.identifier import SensorlessIdentifier
from hd_monitor.identification.sensorless.torque_share import TorqueShare
from hd_monitor.reducer import LinePair

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.simulated.joints import random_joint, simulate_joint

TRUTHS = (0.0, 0.2, 0.5, 0.8, 1.0)
"""Part of the lines' power that follows the torque: all of it with a stiffness defect, none with a pitch error."""

RESOLVED = 0.01
"""Share that the joint's other imperfections may imitate."""


class Row(NamedTuple):
    """One line of a joint."""

    truth: float
    found: TorqueShare

    @property
    def covered(self) -> bool:
        """Whether the interval holds the truth."""
        return self.found.low - RESOLVED <= self.truth <= self.found.high + RESOLVED

    @property
    def wrong(self) -> bool:
        """Whether it reads the one where the other dominates."""
        wrong = "transmission_error" if self.truth > 0.5 else "stiffness" if self.truth < 0.5 else ""
        return self.found.reading == wrong


def study(cases: int, seed: int) -> list[Row]:
    """Identify random joints that swing, each with one of the truths in turn."""
    rows = []
    for number in range(cases):
        rng = np.random.default_rng([seed, number])
        truth = TRUTHS[number % len(TRUTHS)]
        lines = LinePair(*rng.uniform(0.3, 1.0, 2).tolist())
        case = random_joint(rng, lines, motion=str(rng.choice(["harmonics", "strokes"])), following=truth)
        identifier = SensorlessIdentifier(case.settings())
        identifier.add(simulate_joint(case))
        found = identifier.finish()
        rows += [Row(truth, share) for share in (found.torque_shares if found else ())]
    return rows


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=7)
    arguments = parser.parse_args()
    rows = study(arguments.cases, arguments.seed)
    print("truth  lines  covered  median width  readings")
    for truth in TRUTHS:
        own = [row for row in rows if row.truth == truth]
        width = float(np.median([row.found.high - row.found.low for row in own])) if own else math.nan
        readings = ", ".join(f"{name} {count}" for name, count in Counter(row.found.reading for row in own).items())
        print(f"{truth:5.1f}  {len(own):5d}  {np.mean([row.covered for row in own]):7.2f}  {width:12.2f}  {readings}")
    print(f"wrong readings: {sum(row.wrong for row in rows)} of {len(rows)}")


if __name__ == "__main__":
    main()

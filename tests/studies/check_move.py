"""How well does one health-check move repeat, and is a line that grows by 30 % noticed within one?

    python tests/studies/check_move.py [--moves 20] [--seed 2024]

From joint states alone. The rig has the effects of a real drive (`drive: catalogue`), and each move other noise.
Repeatability is the standard deviation of a reading over moves; growth is noticed where the change against the first
five moves is significant at 1 in 1000.
"""

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from hd_monitor.history.entry import Entry, Kind
from hd_monitor.history.series import series_of
from hd_monitor.history.trend import change_of
from hd_monitor.offline.move import MoveLimits, plan_move
from hd_monitor.settings import JointSettings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.studies.false_alarms import watch

SOUND = {"flexspline.beta": [0.012, 0.008, 0.004], "circular_spline.beta": [0.012, 0.008, 0.004]}
ERRORS = {"flexspline.transmission_error": [0.3, 0.08, 0.03], "circular_spline.transmission_error": [0.25, 0.08, 0.03]}
"""[arcmin], as `drive: catalogue` has them."""
GROWTH = 1.3
LIMITS = MoveLimits(lower=-1.5, upper=1.5, speed=2.0, acceleration=5.0)
BASE = 5
"""Moves of the baseline."""
CHANCE = 1e-3
JOINT_STATES = {"input.source": "joint_effort", "input.expected_rate": 250.0}


class OnTheMove(RigSettings):
    """A rig that drives the move of a monitor of joint states."""

    @property
    def programme(self) -> SpeedProgramme:
        """Corners of the move, in rpm of the wave generator."""
        move = plan_move(JointSettings.from_mapping(JOINT_STATES), LIMITS, 60.0)
        rpm = move.velocities * self.reducer.reduction * 60.0 / math.tau
        return SpeedProgramme(times=move.times, speeds=rpm, cycles=1)


def drive(seed: int, number: int, **rig: object) -> Entry:
    """Drive one move and sum it up."""
    effort = {"joint_states.effort": "reaction", "joint_states.effort_noise": 0.3, "joint_states.rate": 250.0}
    given = {"drive": "catalogue", "defect": "custom", "duration": 60.0, "seed": seed} | effort | rig
    *_, last = watch(Simulation(OnTheMove.from_mapping(given)), JOINT_STATES)
    entry = Entry.of(last, "joint", kind=Kind.EVIDENCE)
    return replace(entry, time=float(number), seconds=3600.0 / BASE, revolutions=1000.0)


def repeatability(entries: Sequence[Entry]) -> Iterator[str]:
    """Standard deviation of each reading over the moves, beside what the moves say of themselves."""
    for series in series_of(entries):
        values, own = series.values, float(series.stds.mean())
        yield (
            f"{series.name}: mean {values.mean():.4g}, standard deviation over {values.size} moves "
            f"{values.std(ddof=1):.2g}, said {own:.2g}"
        )


def noticed(base: Sequence[Entry], moves: Sequence[Entry], name: str) -> int:
    """In how many single moves after the baseline a reading's change is significant at `CHANCE`."""
    count = 0
    for move in moves:
        entries = [*base, replace(move, time=1e3)]
        series = next(one for one in series_of(entries) if one.name == name)
        change = change_of(series)
        count += change is not None and change.p_value < CHANCE
    return count


def main() -> None:
    """Print the study's figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=20, help="moves of each kind")
    parser.add_argument("--seed", type=int, default=2024)
    options = parser.parse_args()
    sound = [drive(options.seed + n, n, **(SOUND | ERRORS)) for n in range(BASE + options.moves)]
    print(*repeatability(sound), sep="\n", flush=True)
    base, later = sound[:BASE], sound[BASE:]
    for name in ("flexspline line 1", "circular spline line 1"):
        print(f"{name}: {noticed(base, later, name)} false alarms in {len(later)} moves", flush=True)
    for spline in ("flexspline", "circular_spline"):
        both = SOUND | ERRORS
        grown = {key: [GROWTH * k for k in value] for key, value in both.items() if key.startswith(spline)}
        first = options.seed + 1000
        moves = [drive(first + n, n, **(both | grown)) for n in range(options.moves)]
        name = f"{spline.replace('_', ' ')} line 1"
        print(f"{name} grown by 30 %: noticed in {noticed(base, moves, name)} of {len(moves)} moves", flush=True)


if __name__ == "__main__":
    main()

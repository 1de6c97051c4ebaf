"""The sensorless mode on many random joints and real recordings: it invents no line and names no wrong spline."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from tests.simulated.joints import random_joint, simulate_joint
from tests.studies.sensorless import PLACEBO_TEETH, UR10E, controls, read_recordings, run, verdict

from hd_monitor.diagnosis.verdict import Component
from hd_monitor.offline.identify_teeth import rank_tooth_pairs
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings

RECORDINGS = Path(__file__).parents[2].parent / "shared" / "data" / "ur10e"
"""Real recordings beside the checkout; they are not part of it (licences)."""
RUNS = ("ur-20_01_22-joint_1", "ur-20_01_22-joint_5", "ur-20_02_06-20sec_10harm", "ur-20_02_12-50sec_12harm")


def assert_no_more_than_chance(chances):
    """Probabilities are what they say: as many below each level as an honest test gives in 999 runs of 1000."""
    for level in (0.1, 0.01, 0.001):
        assert np.count_nonzero(np.array(chances) < level) <= stats.binom.ppf(0.999, len(chances), level)


def test_invents_no_line_on_random_joints():
    rng = np.random.default_rng(424)
    chances, names = [], []
    for _ in range(60):
        case = random_joint(rng, LinePair(0.0, 0.0), rate=float(rng.choice([100.0, 125.0, 250.0])))
        identifier = run(simulate_joint(case), case.settings())
        chances += [chance for side in identifier.directions for chance in side.chance]
        names.append(verdict(identifier.estimate(), case.settings()))
    assert set(names) == {Component.UNDETERMINED}
    assert len(chances) >= 200
    assert_no_more_than_chance(chances)


@pytest.mark.parametrize(
    ("lines", "right"),
    [((1.0, 0.4), Component.CIRCULAR_SPLINE), ((0.4, 1.0), Component.FLEXSPLINE), ((0.6, 0.6), Component.BOTH)],
)
def test_never_names_the_wrong_spline_on_random_joints(lines, right):
    rng = np.random.default_rng([31, *(round(10 * size) for size in lines)])
    names = []
    for _ in range(30):
        case = random_joint(rng, LinePair(*lines), rate=float(rng.choice([100.0, 125.0, 250.0])))
        settings = case.settings()
        names.append(verdict(run(simulate_joint(case), settings).estimate(), settings))
    assert set(names) <= {right, Component.UNDETERMINED}
    assert names.count(right) >= (27 if right is not Component.BOTH else 3)


def test_the_teeth_are_never_conclusive_and_wrong_on_random_joints():
    rng = np.random.default_rng(77)
    right = 0
    for lines in ((0.0, 0.0), (0.6, 0.0), (0.6, 0.6)):
        for _ in range(8):
            case = random_joint(rng, LinePair(*lines), rate=float(rng.choice([100.0, 250.0])))
            teeth = (case.reducer.flexspline_teeth, case.reducer.circular_spline_teeth)
            ranking = rank_tooth_pairs(simulate_joint(case))
            assert not ranking.conclusive or ranking.ranked[0].teeth == teeth
            right += ranking.conclusive
    assert right >= 6


@pytest.mark.shared_data
@pytest.mark.skipif(not RECORDINGS.exists(), reason=f"no recordings in {RECORDINGS}")
@pytest.mark.parametrize("source", ["joint_effort", "joint_velocity"])
def test_no_lines_are_found_in_recordings_where_there_are_none(source):
    """Orders shifted beside the lines, and other tooth counts: never found in both directions, never named."""
    recordings = [samples for name, samples in read_recordings(RECORDINGS) if name.startswith(RUNS)]
    assert len(recordings) == 14
    chances = []
    for z1, z2 in PLACEBO_TEETH:
        teeth = {"reducer.flexspline_teeth": z1, "reducer.circular_spline_teeth": z2}
        settings = JointSettings.from_mapping(UR10E | teeth | {"input.source": source, "analysis.harmonics": 1})
        shifted = 188 <= z1 <= 212  # beside the true 200
        for samples in recordings:
            identifier = run(samples, settings)
            assert not all(side.found for side in identifier.directions)
            assert not shifted or not any(side.found for side in identifier.directions)
            assert verdict(identifier.estimate(), settings) is Component.UNDETERMINED
            chances += [chance for side in identifier.directions for chance in side.chance]
    assert len(chances) > 900
    assert_no_more_than_chance(chances)


@pytest.mark.shared_data
@pytest.mark.skipif(not RECORDINGS.exists(), reason=f"no recordings in {RECORDINGS}")
@pytest.mark.parametrize("seed", [1, 2])
def test_effort_that_has_nothing_to_do_with_the_angle_names_nothing(seed):
    settings = JointSettings.from_mapping(UR10E | {"input.source": "joint_effort"})
    names = [verdict(run(samples, settings).estimate(), settings) for _, samples in controls(RECORDINGS, 4, seed)]
    assert len(names) >= 200
    assert set(names) == {Component.UNDETERMINED}

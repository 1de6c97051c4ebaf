"""The right part is named on real drives, and no other one at any time: a short run of the study, against limits."""

import pytest
from tests.studies.reach import study

SEED, CASES = 700, 4
RIGHT = {
    "paper's world": 4,
    "clips": 4,
    "short strokes": 4,
    "torque varies": 4,
    "speed varies": 4,
    "steady": 3,
    "error": 4,
    "nonlinear": 1,
    "wrongly given": 4,
    "disturbed": 1,
    "sound": 0,
}
"""Right verdicts of `CASES` that a set reaches at least."""


@pytest.mark.parametrize("name", RIGHT)
def test_a_set(name):
    ((_, tally),) = study(CASES, SEED, sets=[name])
    assert tally.wrong == 0, tally.row(name)
    assert tally.right >= RIGHT[name], tally.row(name)

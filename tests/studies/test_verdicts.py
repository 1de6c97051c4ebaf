"""The rule of this package on random cases with the field's confounders: it names the right part, and nearly always."""

import pytest
from scipy.stats import binom
from tests.studies.verdicts import RULES, judge_case

from hd_monitor.diagnosis.verdict import Component

SEED, CASES, PARTS = 90_210, 160, 4
RARE = 1e-3
OURS = RULES.index("hd_monitor")
"""The other rules are there for comparison; nobody relies on them."""


@pytest.mark.parametrize("part", range(PARTS))
def test_names_the_right_part_and_seldom_none(part):
    """No wrong name, and no more cases left undetermined than 1 in 100 would give."""
    outcomes = [judge_case(number, SEED) for number in range(part, CASES, PARTS)]
    undetermined = [o.number for o in outcomes if o.verdicts[OURS] is Component.UNDETERMINED]
    wrong = [o.number for o in outcomes if o.number not in undetermined and o.verdicts[OURS] is not o.case.truth]
    assert wrong == []
    assert len(undetermined) <= binom.ppf(1.0 - RARE, len(outcomes), 0.01)

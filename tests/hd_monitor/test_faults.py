"""A few cheap rows of the fault campaign; tests/studies/test_faults.py runs all of them."""

import pytest
from tests.studies.faults import check

ROWS = ("stuck", "not finite", "label", "cut off", "joint twice", "velocity 0", "reversed velocity", "wrapped")


@pytest.mark.parametrize("name", ROWS)
def test_a_faults_row_of_the_page_is_what_the_monitor_says(name: str) -> None:
    check(name)

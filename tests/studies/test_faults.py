"""No fault around the reducer leads to a wrong name, and the page of faults is what the monitor says today."""

import pytest
from tests.studies.fault_rows import FAULTS
from tests.studies.faults import HEAD, PAGE, check


@pytest.mark.parametrize("name", FAULTS)
def test_a_row(name: str) -> None:
    check(name)


def test_the_page_has_a_row_for_each_fault() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert text.startswith(HEAD)
    assert [line.split("`")[-2] for line in text.removeprefix(HEAD).splitlines()] == list(FAULTS)

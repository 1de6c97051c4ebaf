"""The paper's cases as installed, and each exhibit computed once."""

from collections.abc import Callable
from functools import cache

import pytest

from hd_monitor.paper.cases import Cases, load_paper_cases
from hd_monitor.paper.exhibit import Exhibit, Outcome
from hd_monitor.paper.reproduction import EXHIBITS


@pytest.fixture(scope="session")
def cases() -> Cases:
    return load_paper_cases()


@pytest.fixture(scope="session")
def exhibit(cases) -> Callable[[str], Exhibit]:
    """An exhibit by its id."""
    compute = {entry.id: entry.compute for entry in EXHIBITS}
    return cache(lambda name: compute[name](cases))


@pytest.fixture(scope="session")
def outcomes() -> Callable[[Exhibit], list[Outcome]]:
    return lambda shown: [claim.outcome for claim in shown.claims]


@pytest.fixture
def altered(cases) -> Callable[..., Cases]:
    """The cases with one or some of them exchanged, to see a claim fail."""

    def alter(**others) -> Cases:
        return Cases(dict(cases) | others, "altered cases")

    return alter

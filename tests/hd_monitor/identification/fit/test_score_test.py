"""The efficient score of one unknown equals what a fit with it set free would find."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.identification.fit.information import Information
from hd_monitor.identification.fit.normal_equations import NormalEquations
from hd_monitor.identification.fit.score_test import score_tests

UNKNOWNS = 5
STD = np.array([0.3, 2.0, 0.1, 0.5, 0.01])


def learnt(seed: int, fitted: np.ndarray) -> tuple[Information, np.ndarray]:
    """Information from random linear data, and the best values of the unknowns fitted."""
    rng = np.random.default_rng(seed)
    columns = rng.normal(size=(200, UNKNOWNS)) / STD
    data = columns @ (STD * rng.normal(size=UNKNOWNS)) + rng.normal(size=200)
    evidence = NormalEquations(
        information=columns.T @ columns, score=columns.T @ data, cost=float(data @ data), freedom=200.0
    )
    information = Information.gaussian(STD).plus(evidence, np.zeros(UNKNOWNS))
    values = np.zeros(UNKNOWNS)
    place = np.ix_(fitted, fitted)
    values[fitted] = np.linalg.solve(information.matrix[place], information.vector[fitted])
    return information, values


@given(seed=st.integers(0, 2**32), fitted=st.sets(st.integers(0, UNKNOWNS - 1), min_size=1, max_size=UNKNOWNS))
def test_a_score_is_what_setting_the_unknown_free_would_find(seed: int, fitted: set[int]) -> None:
    active = np.isin(np.arange(UNKNOWNS), list(fitted))
    information, values = learnt(seed, active)
    found = score_tests(range(UNKNOWNS), information, values, active, STD)
    for place in range(UNKNOWNS):
        if fitted == {place}:
            continue
        free = active.copy()
        free[place] = True
        fisher = information.matrix.copy()
        fisher[place, place] -= 1.0 / STD[place] ** 2  # its own prior has no say
        inside = np.ix_(free, free)
        covariance = np.zeros_like(fisher)
        covariance[inside] = np.linalg.inv(fisher[inside])
        assert found[place].value == pytest.approx(float(covariance[place] @ information.vector), rel=1e-6, abs=1e-9)
        assert found[place].std == pytest.approx(math.sqrt(covariance[place, place]), rel=1e-6)
        # the others' best values along this one: the ridge of the cost
        others = free.copy()
        others[place] = False
        ridge = -np.linalg.solve(fisher[np.ix_(others, others)], information.matrix[others, place])
        assert found[place].response[others] == pytest.approx(ridge, rel=1e-6, abs=1e-9)


def test_data_that_say_nothing_of_an_unknown_leave_it_open() -> None:
    active = np.array([True, True, True, False, False])
    information = Information.gaussian(STD)
    (score,) = score_tests([4], information, np.zeros(UNKNOWNS), active, STD).values()
    assert (score.value, score.std, score.significance) == (0.0, math.inf, 0.0)

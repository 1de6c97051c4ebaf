"""Orthonormal directions span what they are made of, no more and no less."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.orders.orthonormal import orthonormal


@given(seed=st.integers(0, 1000), columns=st.integers(1, 12), scale=st.floats(-6.0, 6.0))
def test_they_are_orthonormal_and_leave_nothing_of_the_columns(seed: int, columns: int, scale: float) -> None:
    given_columns = np.random.default_rng(seed).normal(size=(200, columns)) * 10.0 ** np.linspace(0.0, scale, columns)
    directions = orthonormal(given_columns)
    np.testing.assert_allclose(directions.T @ directions, np.eye(columns), atol=1e-9)
    rest = given_columns - directions @ (directions.T @ given_columns)
    assert (np.linalg.norm(rest, axis=0) < 1e-9 * np.linalg.norm(given_columns, axis=0)).all()


def test_dependent_and_empty_columns_give_no_direction() -> None:
    first, second = np.random.default_rng(1).normal(size=(2, 50))
    directions = orthonormal(np.column_stack([first, second, first - 2.0 * second, np.zeros(50)]))
    assert directions.shape == (50, 2)

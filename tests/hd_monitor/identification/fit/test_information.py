"""Information: information adds up, and its covariance is that of the values it leads to, faded or not."""

import numpy as np
import pytest

from hd_monitor.identification.fit.information import Information
from hd_monitor.identification.fit.normal_equations import NormalEquations

SIZE = 4
ALL = np.ones(SIZE, dtype=np.bool_)
TRUTH = np.array([0.3, -0.2, 0.5, 0.1])


def designs(seed=1, count=3, rows=30):
    rng = np.random.default_rng(seed)
    return [rng.standard_normal((rows, SIZE)) * [1.0, 2.0, 0.5, 1.0] for _ in range(count)]


def equations(design, values, data):
    """LinearisedSegment of a linear model with noise of unit variance, linearised at some values."""
    residual = data - design @ values
    return NormalEquations(
        information=design.T @ design,
        score=design.T @ residual,
        cost=float(residual @ residual),
        freedom=float(len(data)),
    )


def best(information):
    return np.linalg.solve(information.matrix, information.vector)


def test_pieces_linearised_at_different_places_give_the_least_squares_solution():
    rng = np.random.default_rng(2)
    blocks = designs()
    data = [design @ TRUTH + rng.standard_normal(len(design)) for design in blocks]
    information = Information.none(SIZE)
    for place, (design, values) in enumerate(zip(blocks, data, strict=True)):
        information = information.plus(
            equations(design, np.full(SIZE, 0.2 * place), values), np.full(SIZE, 0.2 * place)
        )
    solution = np.linalg.lstsq(np.concatenate(blocks), np.concatenate(data), rcond=None)[0]
    assert best(information) == pytest.approx(solution)
    assert information.score(solution) == pytest.approx(0.0, abs=1e-9)
    assert information.cost(solution) < information.cost(solution + 0.01)


def test_a_prior_alone_has_its_own_covariance():
    std = np.array([0.1, 0.5, 1.0, 2.0])
    assert Information.gaussian(std).covariance(ALL) == pytest.approx(np.diag(std**2))


def test_covariance_is_that_of_the_best_values_when_evidence_has_faded():
    """Each segment halves what was known before: the inverse of the information would be far too large a variance."""
    blocks = designs(count=6)
    rng = np.random.default_rng(3)
    found = []
    for _ in range(4000):
        information = Information.none(SIZE)
        for design in blocks:
            data = design @ TRUTH + rng.standard_normal(len(design))
            information = information.faded(0.5).plus(equations(design, np.zeros(SIZE), data), np.zeros(SIZE))
        found.append(best(information))
    errors = np.array(found) - TRUTH
    covariance = information.covariance(ALL)
    # chi-square of 4 unknowns x 4000 runs: 1.1 % by chance
    assert np.mean(np.einsum("ni,ij,nj->n", errors, np.linalg.inv(covariance), errors)) / SIZE == pytest.approx(
        1.0, abs=0.045
    )
    naive = np.linalg.inv(information.matrix)
    assert np.mean(np.einsum("ni,ij,nj->n", errors, np.linalg.inv(naive), errors)) / SIZE < 0.8


def test_unknowns_that_are_not_fitted_have_no_variance_and_do_not_widen_the_others():
    information = Information.none(SIZE)
    for design in designs():
        information = information.plus(equations(design, TRUTH, design @ TRUTH), TRUTH)
    active = np.array([True, True, False, True])
    covariance = information.covariance(active)
    assert not covariance[2].any()
    inner = np.linalg.inv(information.matrix[np.ix_(active, active)])
    assert covariance[np.ix_(active, active)] == pytest.approx(inner)
    assert np.all(covariance.diagonal() <= information.covariance(ALL).diagonal() + 1e-12)


def test_a_random_step_of_one_unknown_adds_its_variance_to_the_covariance_and_moves_nothing():
    known = Information.gaussian(np.array([0.0, 0.5, 1.0, 0.0]))  # of two unknowns nothing but what the data say
    for design in designs():
        known = known.plus(equations(design, TRUTH, design @ TRUTH), TRUTH).faded(0.7)
    for place, variance in enumerate([1e-6, 0.1, 3.0, 1e4]):
        after = known.diffused(place, variance)
        added = np.zeros((SIZE, SIZE))
        added[place, place] = variance
        assert np.linalg.inv(after.matrix) == pytest.approx(np.linalg.inv(known.matrix) + added, rel=1e-6)
        assert after.covariance(ALL) == pytest.approx(known.covariance(ALL) + added, rel=1e-6)
        assert best(after) == pytest.approx(best(known))


def test_of_what_is_not_known_a_random_step_takes_nothing():
    nothing = Information.none(SIZE).diffused(1, 0.3)
    assert not nothing.matrix.any()
    assert not nothing.vector.any()
    assert not nothing.spread.any()


def test_a_step_of_the_equations_is_the_same_as_linearising_there():
    design = designs()[0]
    data = design @ TRUTH + np.random.default_rng(4).standard_normal(len(design))
    step = np.array([0.1, -0.3, 0.2, 0.05])
    moved, there = equations(design, np.zeros(SIZE), data).moved(step), equations(design, step, data)
    assert moved.score == pytest.approx(there.score)
    assert moved.cost == pytest.approx(there.cost)

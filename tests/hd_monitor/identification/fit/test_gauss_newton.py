"""The fit: it reaches the truth, and the last step it takes without a simulation leads where a simulation says."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.fit.gauss_newton import DISTINCT, EXCLUDED, NEGLIGIBLE, FitStatus, Problem
from hd_monitor.identification.fit.information import Information
from hd_monitor.identification.fit.linearisation import Predictor
from hd_monitor.identification.fit.noise import NoiseFloor
from hd_monitor.identification.fit.unknowns import Unknowns
from hd_monitor.identification.segment.segment import SegmentBuilder
from hd_monitor.model import Dynamics
from hd_monitor.reducer import Reducer

UNKNOWNS = Unknowns(harmonics=1, load_orders=(1, 2))
RATE, TORQUE, NOISE = 500.0, 10.0, 0.1  # Hz, too low to be reduced; N·m; rad/s²
PREDICTOR = Predictor(unknowns=UNKNOWNS, given=Dynamics(), reference_torque=TORQUE)
BUILDER = SegmentBuilder(reducer=Reducer(), harmonics=1, load_orders=(1, 2), natural_frequency=55.0)
ACTIVE = UNKNOWNS.mask(UNKNOWNS.stiffness, UNKNOWNS.load)
TRUTH = UNKNOWNS.zero()
TRUTH[UNKNOWNS.stiffness] = [0.02, -0.01, 0.03, 0.05]
TRUTH[UNKNOWNS.load] = [0.1, 0.0, 0.05, -0.1]


def segment(seed, seconds=2.0):
    """A run-up from 600 to 1000 rpm with the vibration that the model predicts, and noise."""
    times = np.arange(round(seconds * RATE)) / RATE
    speed = np.linspace(600.0, 1000.0, times.size) * 2.0 * np.pi / 60.0 / 80.0
    angle = np.cumsum(speed) / RATE

    def built(acceleration):
        record = Record(
            start=0.0,
            period=1.0 / RATE,
            acceleration=acceleration,
            angle=angle,
            speed=speed,
            torque=np.full(times.size, TORQUE),
        )
        return BUILDER.build([record], None)

    noise = NOISE * np.random.default_rng(seed).standard_normal(times.size)
    line = PREDICTOR.linearise(built(noise), TRUTH)
    return built(line.predicted + noise)


def problem(*segments, prior=None):
    return Problem(
        segments=segments,
        predictor=PREDICTOR,
        prior=prior or Information.gaussian(np.full(UNKNOWNS.size, 0.5)),
        floor=NoiseFloor.white(2.0 * NOISE**2 / RATE),
        active=ACTIVE,
    )


@pytest.fixture(scope="module")
def fitted():
    task = problem(segment(1), segment(2))
    return task, task.solve(UNKNOWNS.zero(), rounds=10)


def test_the_truth_is_reached_within_its_uncertainty(fitted):
    _, fit = fitted
    information = fit.equations.information[np.ix_(ACTIVE, ACTIVE)]
    error = (fit.values - TRUTH)[ACTIVE]
    # chi-square of 8 degrees of freedom: above 26 once in a thousand seeds
    assert error @ information @ error < 26.0


def test_no_step_makes_the_stiffness_negative():
    wild = problem(segment(5), prior=Information.gaussian(np.full(UNKNOWNS.size, 10.0)))
    start = UNKNOWNS.zero()
    start[UNKNOWNS.stiffness] = [0.35, 0.0, 0.0, 0.35]
    fit = wild.solve(start, rounds=8)
    total = sum(
        float(np.abs(UNKNOWNS.phasors(fit.values, part)).sum())
        for part in (UNKNOWNS.circular_spline, UNKNOWNS.flexspline)
    )
    assert total < 0.8


def test_a_fit_says_why_it_ended(fitted):
    task, fit = fitted
    assert fit.status is FitStatus.CONVERGED
    far = UNKNOWNS.zero()
    far[UNKNOWNS.stiffness] = 0.15
    assert task.solve(far, rounds=1).status is FitStatus.ROUNDS_USED_UP
    beyond = replace(task, active=ACTIVE | UNKNOWNS.mask(UNKNOWNS.delay))
    late = UNKNOWNS.zero()
    late[UNKNOWNS.delay] = UNKNOWNS.bounds()[UNKNOWNS.delay]
    assert beyond.solve(late, rounds=0).status is FitStatus.ON_BOUND


def test_a_fit_without_descent_says_so(fitted, monkeypatch):
    task, _ = fitted
    start = task.at(UNKNOWNS.zero())
    monkeypatch.setattr(Problem, "at", lambda self, values: replace(start, values=values, cost=start.cost + 1.0))
    assert task.solve(start.values, rounds=3).status is FitStatus.NO_DESCENT


def test_the_last_step_leads_where_a_simulation_says(fitted):
    task, fit = fitted
    there = task.at(fit.values)
    assert there.step_size < NEGLIGIBLE
    assert fit.cost == pytest.approx(there.cost, rel=1e-4)
    for moved, simulated in zip(fit.segments, there.segments, strict=True):
        scale = np.linalg.norm(simulated.residual)
        assert np.linalg.norm(moved.residual - simulated.residual) < 0.01 * scale


def contended(monkeypatch, fitted, *, apart, dearer):
    """What is made of two solutions, `apart` [standard deviations] from each other, the second dearer than the first.

    Returns
    -------
    tuple of ndarray
        Values of the first, those kept in mind as a rival, and those of the second.
    """
    task, fit = fitted
    information = fit.equations.information + task.prior.matrix
    step = UNKNOWNS.zero()
    step[0] = apart / np.sqrt(information[0, 0])
    other = replace(fit, values=fit.values + step, cost=fit.cost + dearer)
    ends = {id(fit.values): fit, id(other.values): other}
    monkeypatch.setattr(Problem, "solve", lambda self, start, *, rounds: ends[id(start)])
    best, rival = task.contend([other.values, fit.values], rounds=1)
    return best.values, rival, other.values


def test_of_two_solutions_that_the_data_do_not_separate_the_second_is_kept_in_mind(monkeypatch, fitted):
    best, rival, other = contended(monkeypatch, fitted, apart=1.1 * DISTINCT, dearer=0.9 * EXCLUDED)
    assert best is fitted[1].values
    assert rival is other


@pytest.mark.parametrize(
    ("apart", "dearer"), [(1.1 * DISTINCT, 1.1 * EXCLUDED), (0.9 * DISTINCT, 0.1)], ids=["excluded", "the same"]
)
def test_a_solution_that_is_excluded_or_the_same_is_no_rival(monkeypatch, fitted, apart, dearer):
    best, rival, _ = contended(monkeypatch, fitted, apart=apart, dearer=dearer)
    assert best is fitted[1].values
    assert rival is None


def test_starts_that_lead_to_the_truth_leave_no_rival(fitted):
    task, fit = fitted
    far = UNKNOWNS.zero()
    far[UNKNOWNS.stiffness] = 0.05
    best, rival = task.contend([far, UNKNOWNS.zero()], rounds=10)
    assert rival is None
    assert best.cost == pytest.approx(fit.cost, rel=1e-3)


@pytest.fixture
def simulated(monkeypatch):
    """Every simulation there is from now on."""
    arguments_of_all = []
    original = Predictor.linearise

    def linearise(self, *arguments):
        arguments_of_all.append(arguments)
        return original(self, *arguments)

    monkeypatch.setattr(Predictor, "linearise", linearise)
    return arguments_of_all


def test_a_small_step_costs_a_single_simulation(fitted, simulated):
    """Information that is good already: the newest segment is evaluated once."""
    _, fit = fitted
    information = Information.none(UNKNOWNS.size).plus(fit.equations, fit.values)
    task = problem(segment(3, seconds=0.5), prior=information)
    simulated.clear()
    better = task.solve(fit.values, rounds=3)
    assert len(simulated) == 1
    assert better.cost < task.at(fit.values).cost


def test_a_large_step_is_not_believed_without_a_simulation():
    task = problem(segment(4))
    start = UNKNOWNS.zero()
    fit = task.solve(start, rounds=1)
    np.testing.assert_allclose(fit.cost, task.at(fit.values).cost, rtol=1e-9)


def test_the_first_step_from_a_start_leaves_clocks_and_oscillator_as_the_start_has_them():
    """Without lines the data say nothing of them, and the prior alone would take them back to 0."""
    held = {UNKNOWNS.frequency: 0.1, UNKNOWNS.damping: 0.2, UNKNOWNS.delay: 0.02}
    start = UNKNOWNS.zero()
    for place, value in held.items():
        start[place] = value
    free = replace(problem(segment(6)), active=ACTIVE | UNKNOWNS.mask(*held))
    ((_, fit),) = free.multistart([start], rounds=0)
    assert {place: fit.values[place] for place in held} == held
    assert fit.values[ACTIVE].any()

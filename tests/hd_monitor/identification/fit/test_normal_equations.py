"""What a segment says: the information of a weighted least-squares fit, and what the fit takes from the noise."""

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.fit.linearisation import Predictor
from hd_monitor.identification.fit.noise import NoiseFloor
from hd_monitor.identification.fit.normal_equations import linearise
from hd_monitor.identification.fit.unknowns import Unknowns
from hd_monitor.identification.segment.segment import SegmentBuilder
from hd_monitor.model import Dynamics
from hd_monitor.reducer import Reducer

UNKNOWNS = Unknowns(harmonics=2, load_orders=(2,))
RATE, NOISE, TORQUE = 400.0, 0.2, 10.0  # Hz, too low to be reduced; rad/s²; N·m
FLOOR = NoiseFloor.white(2.0 * NOISE**2 / RATE)
BUILDER = SegmentBuilder(reducer=Reducer(), harmonics=2, load_orders=(2,), natural_frequency=55.0)
PREDICTOR = Predictor(unknowns=UNKNOWNS, given=Dynamics(), reference_torque=TORQUE)
FITTED = UNKNOWNS.mask(UNKNOWNS.stiffness, UNKNOWNS.load)
TRUTH = UNKNOWNS.zero()
TRUTH[UNKNOWNS.stiffness] = [0.03, 0.01, 0.0, 0.02, 0.05, 0.0, 0.01, -0.02]


def segment(acceleration):
    """Two thirds of an output turn in 4 s, from 400 to 600 rpm."""
    speed = np.linspace(400.0, 600.0, acceleration.size) * 2.0 * np.pi / 60.0 / 80.0
    record = Record(
        start=0.0,
        period=1.0 / RATE,
        acceleration=acceleration,
        angle=np.cumsum(speed) / RATE,
        speed=speed,
        torque=np.full(acceleration.size, TORQUE),
    )
    return BUILDER.build([record], None)


def noise(seed, count=1600):
    return NOISE * np.random.default_rng(seed).standard_normal(count)


@pytest.fixture(scope="module")
def clean():
    """Vibration of the truth, as the model predicts it from rest."""
    return PREDICTOR.linearise(segment(noise(0)), TRUTH).predicted


def at_truth(clean, seed):
    return linearise(segment(clean + noise(seed)), PREDICTOR, TRUTH, FLOOR)


def test_the_cost_of_the_truth_is_what_noise_leads_to_expect(clean):
    costs = [at_truth(clean, seed).equations for seed in range(1, 21)]
    # some 1500 degrees of freedom each: 0.8 % by chance
    assert sum(c.cost for c in costs) / sum(c.freedom for c in costs) == pytest.approx(1.0, abs=0.025)


def test_the_covariance_of_the_score_is_the_information(clean):
    squares = []
    for seed in range(1, 121):
        equations = at_truth(clean, seed).equations
        place = np.ix_(FITTED, FITTED)
        squares.append(equations.score[FITTED] @ np.linalg.solve(equations.information[place], equations.score[FITTED]))
    # chi-square of 10 unknowns x 120 segments: 4 % by chance
    assert np.mean(squares) / FITTED.sum() == pytest.approx(1.0, abs=0.16)


def test_a_fit_takes_as_much_noise_as_it_has_unknowns_and_takes_it_at_the_lines(clean):
    evidence = at_truth(clean, 1)
    covariance = np.zeros((UNKNOWNS.size, UNKNOWNS.size))
    place = np.ix_(FITTED, FITTED)
    covariance[place] = np.linalg.inv(evidence.equations.information[place])
    leverage = evidence.leverage(covariance)
    assert leverage.sum() == pytest.approx(FITTED.sum() + 2.0)  # and two free vibrations
    assert leverage.min() >= 0.0
    assert leverage.max() <= 1.0 + 1e-9
    frequencies = np.tile(evidence.segment.frequencies, 2)
    # lines from 13 to 20 Hz and from 27 to 41 Hz, free vibration around 55 Hz
    assert leverage[(frequencies > 75.0)].sum() < 0.1 * leverage.sum()


def test_twice_the_noise_is_a_quarter_of_the_information(clean):
    item = segment(clean + noise(1))
    loud = linearise(item, PREDICTOR, TRUTH, NoiseFloor.white(8.0 * NOISE**2 / RATE)).equations
    quiet = linearise(item, PREDICTOR, TRUTH, FLOOR).equations
    assert 4.0 * loud.information == pytest.approx(quiet.information, abs=1e-9 * np.abs(quiet.information).max())
    assert 4.0 * loud.cost == pytest.approx(quiet.cost)


def test_a_small_step_agrees_with_linearising_again(clean):
    step = UNKNOWNS.zero()
    step[UNKNOWNS.stiffness] = 1e-5
    moved = at_truth(clean, 1).moved(step)
    there = linearise(segment(clean + noise(1)), PREDICTOR, TRUTH + step, FLOOR)
    assert moved.residual == pytest.approx(there.residual, abs=2e-4 * np.abs(there.residual).max())
    assert moved.equations.cost == pytest.approx(there.equations.cost, rel=1e-6)

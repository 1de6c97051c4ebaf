"""Misfit: pure noise widens nothing, and what the noise floor does not show widens the intervals."""

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.checks.residual import LineResidual, Overdispersion
from hd_monitor.identification.fit.gauss_newton import Problem
from hd_monitor.identification.fit.information import Information
from hd_monitor.identification.fit.linearisation import Predictor
from hd_monitor.identification.fit.noise import NoiseFloor
from hd_monitor.identification.fit.unknowns import Unknowns
from hd_monitor.identification.segment.segment import SegmentBuilder
from hd_monitor.model import Dynamics
from hd_monitor.reducer import Reducer

REDUCER = Reducer()
UNKNOWNS = Unknowns(harmonics=2, load_orders=(2,))
RATE, NOISE, TORQUE = 400.0, 0.2, 10.0  # Hz, too low to be reduced; rad/s²; N·m
FLOOR = NoiseFloor.white(2.0 * NOISE**2 / RATE)
BUILDER = SegmentBuilder(reducer=REDUCER, harmonics=2, load_orders=(2,), natural_frequency=55.0)
PREDICTOR = Predictor(unknowns=UNKNOWNS, given=Dynamics(), reference_torque=TORQUE)
FITTED = UNKNOWNS.mask(UNKNOWNS.stiffness, UNKNOWNS.load)
TRUTH = UNKNOWNS.zero()
TRUTH[UNKNOWNS.stiffness] = [0.03, 0.01, 0.0, 0.02, 0.05, 0.0, 0.01, -0.02]
SECONDS, SEGMENTS = 1.0, 8
TIMES = np.arange(int(SECONDS * SEGMENTS * RATE)) / RATE
SPEED = 900.0 * 2.0 * np.pi / 60.0 / 80.0  # rad/s: one and a half output turns; lines at 30 and 60 Hz
ANGLE = SPEED * TIMES


def segments(acceleration):
    parts = []
    for values, angle in zip(np.split(acceleration, SEGMENTS), np.split(ANGLE, SEGMENTS), strict=True):
        record = Record(
            start=0.0,
            period=1.0 / RATE,
            acceleration=values,
            angle=angle,
            speed=np.full(values.size, SPEED),
            torque=np.full(values.size, TORQUE),
        )
        parts.append(BUILDER.build([record], None))
    return parts


@pytest.fixture(scope="module")
def clean():
    """Vibration of the truth; every segment begins at rest, which is one of the free vibrations that are fitted."""
    return np.concatenate([PREDICTOR.linearise(s, TRUTH).predicted for s in segments(np.ones(TIMES.size))])


def noise(seed):
    return NOISE * np.random.default_rng(seed).standard_normal(TIMES.size)


def residual(signal):
    """What a fit leaves of a signal; the floor is known."""
    problem = Problem(
        segments=segments(signal),
        predictor=PREDICTOR,
        prior=Information.gaussian(np.full(UNKNOWNS.size, 1.0)),
        floor=FLOOR,
        active=FITTED,
    )
    fit = problem.solve(TRUTH, rounds=5)
    rest = LineResidual.empty(UNKNOWNS.harmonics)
    for item in fit.segments:
        rest = rest.plus(item, fit.covariance, FLOOR, REDUCER)
    return rest


@pytest.fixture(scope="module")
def of_noise(clean):
    return [residual(clean + noise(seed)) for seed in range(40)]


def test_noise_disperses_the_segments_no_more_than_expected(of_noise):
    squares, freedom = (sum(getattr(rest.overdispersion, name) for rest in of_noise) for name in ("squares", "freedom"))
    # each of the 8 segments is asked 10 unknowns, and all together have fixed 10: 2800 degrees of freedom, 2.7 %
    assert freedom == pytest.approx(40 * 10 * (SEGMENTS - 1), rel=0.02)
    assert squares / freedom == pytest.approx(1.0, abs=0.08)


def test_pure_noise_is_hardly_ever_inflated(of_noise):
    assert np.mean([rest.overdispersion.inflation for rest in of_noise]) < 1.06
    assert np.mean([rest.inflation(ANGLE[-1]) > 1.0 for rest in of_noise]) < 0.1
    # what the unknowns follow is no longer part of the residual
    assert 0.4 < np.mean([rest.misfit for rest in of_noise]) < 1.0


def test_noise_that_comes_with_the_vibration_overdisperses_the_segments(clean):
    """Three per cent of slow noise on the amplitude: a quarter octave's floor would hardly see it."""
    rng = np.random.default_rng(7)
    slow = np.repeat(rng.standard_normal(4 * SEGMENTS), TIMES.size // (4 * SEGMENTS))
    rest = residual(clean * (1.0 + 0.03 * slow) + noise(8))
    assert rest.overdispersion.inflation > 2.0


def test_a_line_that_the_model_lacks_widens_the_intervals(clean):
    foreign = 0.3 * np.cos((REDUCER.output_orders.flexspline + 1.0) * ANGLE)
    rest = residual(clean + foreign + noise(9))
    # beside one pair's 7 orders of 2 x 7, with an amplitude of 0.3 over 0.2 · √(2 / 3200) of noise
    assert rest.inflation(ANGLE[-1]) > 10.0
    power = np.mean(foreign**2) / np.mean(clean**2)
    assert rest.unexplained == pytest.approx(np.sqrt(power), rel=0.5)


def test_fading_keeps_the_ratio_of_squares_to_expectation():
    overdispersion = Overdispersion(squares=300.0, freedom=100.0)
    faded = overdispersion.faded(0.25)
    assert faded.squares / faded.freedom == pytest.approx(3.0)
    assert 1.0 < faded.inflation < overdispersion.inflation < 3.0


def test_nothing_seen_says_nothing():
    empty = LineResidual.empty(2)
    assert empty.misfit == 1.0
    assert empty.inflation(1.0) == 1.0
    assert empty.overdispersion.inflation == 1.0
    assert empty.unexplained == 0.0

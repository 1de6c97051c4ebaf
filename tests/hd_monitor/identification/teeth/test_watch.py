"""Wrong tooth numbers must be noticed, right ones never doubted."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.identification.identifier import Identifier
from hd_monitor.identification.teeth.candidates import STRONGEST, ToothPair, strongest
from hd_monitor.identification.teeth.watch import FIRST_LOOK, GROWTH, ToothWatch
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque
from hd_monitor.orders.order_spectrum import PER_TURN, TURNS, OrderSpectrum
from hd_monitor.reducer import Reducer

RIG = Reducer()
MISTYPED = Reducer(flexspline_teeth=158, circular_spline_teeth=160)
MODEL = ParametricModel(
    dynamics=Dynamics(),
    flexspline=StiffnessSeries((0.10, 0.03, 0.02), (0.4, 1.1, 2.0)),
    circular_spline=StiffnessSeries((0.035, 0.012, 0.01), (2.5, 0.3, 1.0)),
    torque=Torque(mean=10.0, load_fluctuation=2.0, load_phase=1.0),
)


def case(**changes):
    values = {"model": MODEL, "speed": 1900.0, "span": np.radians(110.0), "duration": 10.0, "seed": 3}
    return Case(**(values | changes))


def identify(records, settings):
    identifier = Identifier(settings)
    results = []
    for record in records:
        identifier.add(record)
        results.append(identifier.estimate())
    return [result for result in (*results, identifier.finish()) if result is not None]


def spectrum(lines, turns=6.0, noise=0.2, seed=0, tone=0.0):
    """Spectrum of lines {order: amplitude} in noise, at one speed."""
    rng = np.random.default_rng(seed)
    angle = np.linspace(0.0, turns * math.tau, 12_000)
    values = noise * rng.standard_normal(angle.size) + np.cos(tone * angle) * bool(tone)
    for order, amplitude in lines.items():
        values += amplitude * np.cos(order * angle + order)
    size = TURNS * PER_TURN
    place = np.floor(angle / math.tau * PER_TURN).astype(int) % size
    return OrderSpectrum(
        sums=np.bincount(place, values, size),
        counts=np.bincount(place, minlength=size).astype(float),
        power=float(values @ values),
        lowest=0.0,
        highest=turns * math.tau,
    )


@pytest.mark.parametrize("given", [200, 100, 162, 158])
@pytest.mark.parametrize("motion", [{}, {"motion": "strokes", "speed": 1500.0}], ids=["one speed", "strokes"])
def test_wrong_teeth_forbid_a_name_from_the_first_look_at_them_on(motion, given):
    truth = case(**motion)
    wrong = {"reducer.flexspline_teeth": given, "reducer.circular_spline_teeth": given + 2}
    results = identify(simulate(truth), truth.settings(**wrong))
    looked = results[math.ceil(FIRST_LOOK) :]
    assert len(looked) >= 5
    assert all(result.blockers for result in looked)
    assert any("tooth numbers" in describe_limitation(text) for text in results[-1].blockers)
    if not motion:
        assert "160/162 teeth" in describe_limitation(results[-1].blockers[0])


@pytest.mark.parametrize("hum", [47.0, 50.0, 95.0])
@pytest.mark.parametrize("motion", [{}, {"motion": "strokes", "speed": 1500.0}], ids=["one speed", "strokes"])
def test_right_teeth_are_not_doubted_for_a_tone(motion, hum):
    truth = case(**motion)
    level = float(np.std(np.concatenate([record.acceleration for record in simulate(truth)])))
    records = [
        replace(r, acceleration=r.acceleration + 0.5 * level * np.cos(math.tau * hum * r.times))
        for r in simulate(truth)
    ]
    for result in identify(records, truth.settings()):
        assert not any("tooth numbers" in describe_limitation(text) for text in result.blockers)


def test_products_are_those_of_the_lines():
    orders = np.array([3.0, 7.5, 160.0, 162.0])
    found = spectrum({160: 1.0}, turns=1.3)
    place = np.arange(TURNS * PER_TURN)
    angle = place / PER_TURN * math.tau
    waves = np.concatenate([np.cos(np.outer(orders, angle)), -np.sin(np.outer(orders, angle))])
    products = found.products(orders).matrix
    np.testing.assert_allclose(products[:-1, :-1], (waves * found.counts) @ waves.T, atol=1e-6)
    np.testing.assert_allclose(products[:-1, -1], waves @ found.sums, atol=1e-6)
    assert products[-1, -1] == found.power


def test_amplitudes_are_those_of_the_lines():
    amplitudes = spectrum({160: 1.0, 486: 0.5}).amplitudes
    np.testing.assert_allclose(amplitudes[[160, 486]], [1.0, 0.5], rtol=0.12)
    assert amplitudes[100:150].max() < 0.02


def watching(lines, left=None, **changes):
    residual = spectrum(lines if left is None else left, **changes)
    return ToothWatch(signal=spectrum(lines, **changes), residual=residual)


def no_trial(given, others):
    raise AssertionError(f"tried {others} against {given}")


def look(watch, seconds=5.0, one_speed=True, trial=no_trial, given=RIG):
    return watch.look(given, 3, trial, seconds=seconds, one_speed=one_speed)


def said(watch):
    return "" if watch.doubt is None else describe_limitation(watch.doubt)


def test_the_pairs_with_the_strongest_lines_are_compared_with_the_one_given():
    candidates = strongest(spectrum({200: 1.0, 202: 0.3, 400: 0.2}, tone=103.3).amplitudes, RIG, 3)
    pairs = [candidate.teeth for candidate in candidates]
    assert len(pairs) == STRONGEST + 1
    assert {ToothPair(160, 162), ToothPair(200, 202)} <= set(pairs)


def test_the_motors_orders_count_for_no_other_pair():
    counted = {c.teeth: c.multiples for c in strongest(spectrum({160: 1.0, 164: 1.0}).amplitudes, RIG, 3)}
    assert counted[ToothPair(160, 162)] == (1.0, 2.0, 3.0)
    assert counted[ToothPair(80, 82)] == (2.0,)


def test_both_lines_contradict_the_teeth_and_one_does_not_at_one_speed():
    doubtful = look(watching({200: 1.0, 202: 0.3}))
    assert said(doubtful).startswith("Check the tooth numbers: lines are at 200, 202 cycles per output revolution")
    assert "200/202 teeth explain them far better than the 160/162 given" in said(doubtful)
    assert look(watching({200: 1.0})).doubt is None
    assert look(watching({200: 1.0, 600: 0.3})).doubt is None
    assert look(watching({200: 1.0, 600: 0.3}), one_speed=False).doubt is not None


@pytest.mark.parametrize("order", [103.0, 103.3, 200.0, 480.5])
@pytest.mark.parametrize("turns", [0.9, 1.5, 6.0])
def test_a_tone_contradicts_nothing(order, turns):
    assert look(watching({160: 0.3, 162: 0.5}, turns=turns, tone=order)).doubt is None
    assert look(watching({}, turns=turns, tone=order)).doubt is None


def test_the_motors_lines_and_their_side_lines_contradict_nothing():
    lines = {78: 0.2, 80: 1.0, 82: 0.3, 160: 0.3, 162: 0.5, 240: 0.2, 242: 0.2}
    assert look(watching(lines)).doubt is None
    assert look(watching(lines), one_speed=False).doubt is None


@pytest.mark.parametrize("shift", [-40, -20, -2, -1, 1, 2, 20, 40])
def test_other_teeth_are_recognised_by_their_lines_even_if_some_are_shared(shift):
    lines = {160: 0.3, 162: 1.0, 320: 0.3, 324: 0.2}
    moved = {(order // 160) * shift + order: size for order, size in lines.items()}
    assert f"{160 + shift}/{162 + shift} teeth" in said(look(watching(moved)))
    assert look(watching(lines)).doubt is None


def test_teeth_are_not_compared_while_nothing_is_unexplained():
    lines = {200: 1.0, 202: 0.5}
    for seed in range(40):
        quiet = ToothWatch(signal=spectrum(lines), residual=spectrum({}, seed=seed))
        assert look(quiet).asked == ()
    assert look(watching(lines, left={200: 0.1})).asked
    assert not look(watching(lines, left={200: 0.01})).asked
    assert not look(watching(lines, turns=0.1)).asked
    assert look(watching(lines), seconds=FIRST_LOOK - 0.1).asked == ()


def test_the_same_candidates_are_compared_once_until_the_motion_has_grown():
    watch = look(watching({200: 1.0, 202: 0.5}), seconds=20.0)
    assert watch.doubt is not None
    assert look(watch, seconds=20.0 * GROWTH - 1.0) is watch
    assert look(watch, seconds=20.0 * GROWTH + 1.0).seconds == 20.0 * GROWTH + 1.0
    other = replace(watch, signal=spectrum({120: 1.0, 122: 0.5}))
    assert "120/122 teeth" in said(look(other, seconds=21.0))


def test_a_doubt_ends_once_nothing_is_unexplained_and_comes_back_with_it():
    watch = look(watching({200: 1.0, 202: 0.5}), seconds=20.0)
    cured = look(replace(watch, residual=spectrum({})), seconds=21.0)
    assert cured.doubt is None
    assert look(replace(cured, residual=watch.residual), seconds=22.0).doubt == watch.doubt


def test_where_the_travel_does_not_separate_lines_a_trial_decides_between_neighbours():
    tried = []

    def trial(given, others):
        tried.append([other.flexspline_teeth for other in others])
        return others[0]

    blurred = watching({162: 1.0, 164: 0.5}, turns=0.3, noise=2.0)
    doubtful = look(blurred, one_speed=False, trial=trial, given=MISTYPED)
    ((first, *rest),) = tried
    assert all(0 < abs(teeth - 158) <= 4 for teeth in (first, *rest))
    assert said(doubtful).startswith(f"Check the tooth numbers: {first}/{first + 2} teeth, or numbers close to these")
    assert look(blurred, one_speed=False, trial=lambda given, others: None, given=MISTYPED).doubt is None
    assert look(blurred, trial=no_trial, given=MISTYPED).doubt is None


def test_teeth_that_catalogues_list_are_not_tried_against_neighbours_that_none_lists():
    assert look(watching({162: 1.0, 164: 0.5}, turns=0.3, noise=2.0), one_speed=False).doubt is None


def test_neighbours_are_put_to_trial_once_until_the_motion_has_grown():
    tried = []

    def trial(given, others):
        tried.append(others)

    blurred = watching({162: 1.0, 164: 0.5}, turns=0.3, noise=2.0)
    for seconds in np.arange(10.0, 10.0 * GROWTH + 1.0):
        blurred = look(replace(blurred, asked=()), seconds=seconds, one_speed=False, trial=trial, given=MISTYPED)
    assert len(tried) == 2


@pytest.mark.parametrize("tone", [0.3, 1.0])
@pytest.mark.parametrize("order", [158, 164])
def test_a_tone_beside_both_lines_given_makes_no_pair_with_one_of_them(order, tone):
    assert look(watching({160: 0.5, 162: 1.0, order: tone})).doubt is None


def test_fading_keeps_the_amplitudes():
    watch = watching({200: 1.0}).faded(0.5)
    np.testing.assert_allclose(watch.signal.amplitudes, spectrum({200: 1.0}).amplitudes)

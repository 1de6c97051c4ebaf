"""Wrong tooth numbers must be noticed, right ones never doubted."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.identification.identifier import Identifier
from hd_monitor.identification.teeth.candidates import tooth_suspects, unexplained
from hd_monitor.identification.teeth.trial import Lead
from hd_monitor.identification.teeth.watch import FIRST_LOOK, GAIN, GAIN_NEAR, PROOF, ToothWatch
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque
from hd_monitor.orders.spectrum import PER_TURN, TURNS, OrderSpectrum
from hd_monitor.reducer import Reducer

RIG = Reducer()
MODEL = ParametricModel(
    dynamics=Dynamics(),
    flexspline=StiffnessSeries((0.10, 0.03, 0.02), (0.4, 1.1, 2.0)),
    circular_spline=StiffnessSeries((0.035, 0.012, 0.01), (2.5, 0.3, 1.0)),
    torque=Torque(mean=10.0, load_fluctuation=2.0, load_phase=1.0),
)


def teeth(flexspline):
    return Reducer(flexspline_teeth=flexspline, circular_spline_teeth=flexspline + 2)


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
def test_wrong_teeth_forbid_a_name_from_the_first_verdict_on(motion, given):
    truth = case(**motion)
    wrong = {"reducer.flexspline_teeth": given, "reducer.circular_spline_teeth": given + 2}
    results = identify(simulate(truth), truth.settings(**wrong))
    assert all(result.blockers for result in results)
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


def test_both_lines_raise_suspicion_and_one_does_not_at_one_speed():
    (suspect, *_) = tooth_suspects(spectrum({200: 1.0, 202: 0.3}), RIG, 3, one_speed=True)
    assert suspect.reducer == teeth(200)
    assert suspect.lines == (200.0, 202.0)
    assert tooth_suspects(spectrum({200: 1.0}), RIG, 3, one_speed=True) == ()
    (suspect, *_) = tooth_suspects(spectrum({200: 1.0, 400: 0.3}), RIG, 3, one_speed=False)
    assert suspect.reducer in (teeth(200), teeth(198))


@pytest.mark.parametrize("order", [103.0, 103.3, 200.0, 480.5])
def test_a_tone_raises_no_suspicion(order):
    signal = spectrum({160: 0.3, 162: 0.5}, tone=order)
    assert tooth_suspects(signal, RIG, 3, one_speed=True) == ()


def test_the_motors_lines_and_their_side_lines_raise_no_suspicion():
    signal = spectrum({78: 0.2, 80: 1.0, 82: 0.3, 160: 0.3, 162: 0.5, 240: 0.2, 242: 0.2})
    assert tooth_suspects(signal, RIG, 3, one_speed=True) == ()


def test_noise_alone_leaves_nothing_unexplained():
    signal = spectrum({160: 1.0})
    assert not any(unexplained(signal, spectrum({}, seed=seed)) for seed in range(40))
    assert unexplained(signal, spectrum({200: 0.1}))
    assert not unexplained(signal, spectrum({200: 0.01}))
    assert not unexplained(spectrum({160: 1.0}, turns=0.1), spectrum({200: 0.5}, turns=0.1))


def looked(watch, lead, seconds=5.0, one_speed=True):
    return watch.look(lambda given, others: (lead,) * len(others), RIG, 3, seconds=seconds, one_speed=one_speed)


def watching(lines, **changes):
    return ToothWatch(signal=spectrum(lines, **changes), residual=spectrum(lines, **changes))


def test_suspicion_needs_proof():
    watch = watching({200: 1.0, 202: 0.5})
    assert looked(watch, Lead(PROOF - 1.0, 2.0)).rival is None
    assert looked(watch, Lead(PROOF + 1.0, 1.01)).rival.reducer == teeth(200)
    assert looked(watch, Lead(-math.inf, 0.0)).rival is None
    assert looked(watch, Lead(1e3, 2.0), seconds=FIRST_LOOK - 0.1).rival is None


def test_lines_that_travel_does_not_part_need_more_proof():
    far, near = watching({200: 1.0}, turns=0.3), watching({161: 1.0}, turns=0.3)
    assert looked(far, Lead(1e3, GAIN - 0.01), one_speed=False).rival is None
    assert looked(far, Lead(1e3, GAIN + 0.01), one_speed=False).rival.lines == ()
    assert looked(near, Lead(1e3, GAIN_NEAR + 0.01), one_speed=False).rival is not None


def test_looks_get_rare_and_a_suspicion_ends_once_nothing_is_unexplained():
    watch = looked(watching({200: 1.0, 202: 0.5}), Lead(1e3, 2.0), seconds=20.0)
    assert looked(watch, Lead(0.0, 1.0), seconds=59.0) is watch
    assert watch.blocker(RIG).startswith("Check the tooth numbers: lines stand at 200, 202")
    assert "200/202 teeth" in watch.blocker(RIG)
    cured = looked(replace(watch, residual=spectrum({})), Lead(1e3, 2.0), seconds=61.0)
    assert cured.rival is None
    assert cured.blocker(RIG) == ""


def test_fading_keeps_the_amplitudes():
    watch = watching({200: 1.0}).faded(0.5)
    np.testing.assert_allclose(watch.signal.amplitudes, spectrum({200: 1.0}).amplitudes)

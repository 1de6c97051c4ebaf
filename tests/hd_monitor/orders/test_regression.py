import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.orders.joint_segment import JointSegmentCutter
from hd_monitor.orders.line_orders import LineOrders
from hd_monitor.orders.orthonormal import project
from hd_monitor.orders.regression import pool, solve
from hd_monitor.orders.segment_products import products_of_segment, residual_of_segment, trend_columns
from hd_monitor.orders.whitening import learn_whitening
from hd_monitor.reducer import LinePair

PAIR = LinePair(200.0, 202.0)
ORDERS = LineOrders.of_pair(PAIR, 1, (101.0, 202.0))


def segments(rng, signal=lambda angle: 0.0, noise=0.1, count=4, span=3.0):
    """Segments forward over one arc, each at another speed, with friction and gravity."""
    found = []
    for number in range(count):
        seconds = 3.0 + 0.5 * number
        times = np.arange(0.0, seconds, 0.01)
        angle = span * times / seconds
        effort = 2.0 + 4.0 * np.sin(angle) + signal(angle) + noise * rng.standard_normal(times.size)
        cutter = JointSegmentCutter("joint_effort", (200.0, 202.0), 0.03)
        speed = np.full(times.size, span / seconds)
        found += cutter.add(JointSamples(times=times, angle=angle, speed=speed, effort=effort)) + cutter.finish()
    return found


def pooled(found, orders=ORDERS):
    coefficients = learn_whitening([residual_of_segment(segment, orders) for segment in found])
    products = [products_of_segment(segment, orders, coefficients) for segment in found]
    return pool(each for each in products if each is not None)


def fit(found, orders=ORDERS):
    return solve(pooled(found, orders), orders)


def test_reference_orders_are_beside_the_pair_and_away_from_the_motor():
    assert ORDERS.nuisance.tolist() == [101.0]  # twice the motor's order is the flexspline's own line in this mount
    assert len(ORDERS.reference_orders) == 24
    assert np.abs(np.subtract.outer(ORDERS.reference_orders, PAIR)).min() == pytest.approx(2.0)
    assert LineOrders.of_pair(LinePair(60.0, 62.0)).reference_orders.min() >= 60.0 - 5 * 2.0
    near = LineOrders.of_pair(LinePair(16.0, 18.0), 1, (8.0,))
    assert np.abs(near.reference_orders - 8.0).min() > 1.0
    assert near.reference_orders.min() > 2.0


def test_finds_phasors_under_friction_and_gravity():
    phasors = np.array([0.2 * np.exp(0.7j), 0.1 * np.exp(-2.0j)])

    def lines(angle):
        return (np.exp(1j * np.multiply.outer(angle, [200.0, 202.0])) @ phasors).real

    found = fit(segments(np.random.default_rng(1), lines, noise=0.02))
    np.testing.assert_allclose(found.phasors, phasors, atol=5.0 * max(found.amplitude_stds))
    assert max(found.amplitude_stds) < 0.01
    assert max(found.chances) < 1e-9
    assert found.noise == pytest.approx(0.02, rel=0.1)


def test_errors_follow_the_covariance():
    rng = np.random.default_rng(2)
    pulls, floors = [], []
    for _ in range(150):
        phases = rng.uniform(0.0, math.tau, 2)
        found = fit(
            segments(rng, lambda angle, p=phases: 0.1 * np.cos(200 * angle + p[0]) + 0.06 * np.cos(202 * angle + p[1]))
        )
        error = found.phasors - np.array([0.1, 0.06]) * np.exp(1j * phases)
        parts = np.concatenate([error.real, error.imag])
        pulls.append(float(parts @ np.linalg.solve(found.covariance, parts)) / 4.0)
        floors.append(found.floor)
    # The ratio follows F with 4 and the floor's degrees of freedom (about 33 here); its mean is ν / (ν - 2).
    assert np.mean(pulls) == pytest.approx(1.06, abs=4.0 * math.sqrt(0.5 / 150))
    assert np.mean(floors) == pytest.approx(1.0, abs=0.15)


def test_chance_is_uniform_where_there_is_no_line():
    rng = np.random.default_rng(3)
    chances = [chance for _ in range(150) for chance in fit(segments(rng)).chances]
    assert stats.kstest(chances, "uniform").pvalue > 1e-3


def test_varying_amplitudes_widen_the_covariance():
    """Over the arc or from segment to stroke: a line then spreads into skirts, which the floor beside the pair sees."""
    rng = np.random.default_rng(4)

    def varying(angle):
        return 0.3 * np.cos(200.0 * angle) * (1.0 + 0.8 * np.cos(5.0 * angle + rng.uniform(0.0, math.tau)))

    steady = fit(segments(rng, lambda angle: 0.3 * np.cos(200.0 * angle)))
    uneven = fit(segments(rng, varying))
    assert steady.floor < 2.0
    assert uneven.floor > 3.0 * steady.floor
    assert uneven.amplitude_stds[0] > 1.5 * steady.amplitude_stds[0]


def test_a_stronger_line_beside_the_pair_is_reported():
    rng = np.random.default_rng(5)
    found = fit(segments(rng, lambda angle: 0.4 * np.cos(190.0 * angle)))
    assert found.rival == pytest.approx(190.0, abs=2.0)
    assert min(found.chances) > 1e-3
    assert fit(segments(rng, lambda angle: 0.4 * np.cos(200.0 * angle))).rival is None


def test_spikes_are_clipped():
    rng = np.random.default_rng(6)

    def spiky(angle):
        return 0.2 * np.cos(200.0 * angle) + 30.0 * (rng.random(angle.size) < 0.01)

    found = fit(segments(rng, spiky))
    assert found.amplitudes[0] == pytest.approx(0.2, abs=0.05)
    assert found.noise < 0.2


def test_two_lines_explain_more_than_one_only_if_there_are_two():
    rng = np.random.default_rng(7)
    for second, more in ((0.0, False), (0.2, True)):
        found = segments(rng, lambda angle, a=second: 0.2 * np.cos(200.0 * angle) + a * np.cos(202.0 * angle))
        single = replace(ORDERS, lines=np.array([200.0]))
        evidence = []
        for orders in (ORDERS, single):
            solution = fit(found, orders)
            assert solution is not None
            evidence.append(solution.log_evidence)
        assert (evidence[0] - evidence[1] > math.log(1000.0)) is more


def test_too_little_data_gives_no_fit():
    rng = np.random.default_rng(8)
    assert pool([]) is None
    (short,) = segments(rng, count=1, span=0.3)
    assert short.values.size == 300
    assert fit([short]) is None  # 17° cannot separate lines 2 cycles per revolution apart
    still = replace(short, values=np.full(short.values.size, 2.0))
    assert products_of_segment(still, ORDERS, np.ones(1)) is None
    brief = segments(rng, count=1)[0]
    few = slice(0, 24)
    brief = replace(
        brief,
        angle=brief.angle[few],
        speed=brief.speed[few],
        values=brief.values[few],
        starts=brief.starts[few],
    )
    assert products_of_segment(brief, ORDERS, np.ones(9)) is None


def test_the_trend_cannot_follow_a_line():
    segment = segments(np.random.default_rng(9), count=1)[0]
    trend = trend_columns(segment, ORDERS.trend)
    line = segment.columns([200.0])
    assert np.sum(project(trend, line) ** 2) > 0.99 * np.sum(line**2)
    slow = np.column_stack([np.ones(segment.angle.size), np.sin(segment.angle), np.sin(2.0 * segment.angle)])
    assert np.abs(project(trend, slow)).max() < 1e-4

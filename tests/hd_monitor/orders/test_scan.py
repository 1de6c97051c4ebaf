import numpy as np
import pytest

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.orders.joint_segment import JointSegmentCutter
from hd_monitor.orders.line_orders import LineOrders
from hd_monitor.orders.regression import solve
from hd_monitor.orders.scan import PARTS, OrderScan
from hd_monitor.reducer import LinePair

ORDERS = np.arange(170, 232)


def segments(cs=0.2, fs=0.1, seconds=60.0):
    times = np.arange(0.0, seconds, 0.01)
    angle = 1.5 * np.sin(0.5 * times)
    effort = 3.0 * np.sin(angle) + cs * np.cos(200 * angle + 1.0) + fs * np.cos(202 * angle)
    effort += 0.05 * np.random.default_rng(1).standard_normal(times.size)
    cutter = JointSegmentCutter("joint_effort", (200.0, 202.0), 0.03)
    samples = JointSamples(times=times, angle=angle, speed=0.75 * np.cos(0.5 * times), effort=effort)
    return cutter.add(samples) + cutter.finish()


def test_any_lines_of_the_range_can_be_fitted_from_the_sums():
    scan = OrderScan(segments(), ORDERS)
    assert scan.highest == 231
    sums = scan.by_direction()
    assert len(sums) == 2
    for part in sums:
        fit = solve(part, LineOrders.of_pair(LinePair(200.0, 202.0)))
        assert fit is not None
        np.testing.assert_allclose(fit.phasors, [0.2 * np.exp(1j), 0.1], atol=0.02)
        beside = solve(part, LineOrders.of_pair(LinePair(186.0, 188.0)))
        assert beside is not None
        assert np.abs(beside.phasors).max() < 0.05
        assert fit.log_evidence > beside.log_evidence + 20.0


def turning(speed=0.8, seconds=60.0):
    times = np.arange(0.0, seconds, 0.01)
    effort = np.random.default_rng(1).standard_normal(times.size)
    cutter = JointSegmentCutter("joint_effort", (200.0, 202.0), 0.03)
    samples = JointSamples(times=times, angle=speed * times, speed=np.full(times.size, speed), effort=effort)
    return cutter.add(samples) + cutter.finish()


def test_parts_cover_a_revolution_and_add_up_to_the_whole():
    scan = OrderScan(turning(), ORDERS)
    parts, whole = scan.by_parts(), scan.by_direction()
    assert len(parts) == PARTS
    assert len(OrderScan(turning(seconds=25.0), ORDERS).by_parts()) == 3
    assert OrderScan(segments(), ORDERS).by_parts() == []
    assert sum(part.rows for part in parts) == sum(part.rows for part in whole)
    np.testing.assert_allclose(
        np.sum([part.matrix for part in parts], axis=0), np.sum([part.matrix for part in whole], axis=0), atol=1e-6
    )


@pytest.mark.parametrize("pair", [LinePair(100.0, 102.0), LinePair(230.0, 232.0), LinePair(200.5, 202.5)])
def test_lines_outside_the_range_or_between_its_orders_are_not_fitted(pair):
    scan = OrderScan(segments(), ORDERS)
    assert solve(scan.by_direction()[0], LineOrders.of_pair(pair)) is None


def test_no_segments_make_no_sums():
    assert OrderScan([], ORDERS).by_direction() == OrderScan([], ORDERS).by_parts() == []

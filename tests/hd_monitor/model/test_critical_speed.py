"""The instability speed: against the known threshold, and against the Floquet growth rate on either side."""

import math
from dataclasses import replace

import pytest
from tests.oracle import table_1

from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque, growth_rate
from hd_monitor.model.critical_speed import critical_speed
from hd_monitor.reducer import Reducer


def model(circular=(), flex=(), damping=0.023):
    return ParametricModel(
        reducer=Reducer(),
        dynamics=replace(Dynamics(), damping_ratio=damping),
        circular_spline=StiffnessSeries(circular),
        flexspline=StiffnessSeries(flex),
        torque=Torque(mean=0.0),
    )


@pytest.mark.parametrize("damping", [0.015, 0.023, 0.04])
@pytest.mark.parametrize("spline", ["circular", "flex"])
def test_a_single_index_destabilises_above_four_times_the_damping_ratio(spline, damping):
    below, above = (model(**{spline: (factor * 4.0 * damping,)}, damping=damping) for factor in (0.97, 1.03))
    assert critical_speed(below) == math.inf
    order = Reducer().circular_spline_order if spline == "circular" else Reducer().flexspline_order
    # just above the threshold the tongue is narrow: twice the natural frequency, less what β² shifts it
    assert critical_speed(above) == pytest.approx(2.0 * 55.0 * 60.0 / order, rel=0.03)


@pytest.mark.parametrize(("circular", "flex"), [((), (0.14,)), ((0.10,), (0.14,)), ((0.2, 0.1), (0.15, 0.12))])
def test_growth_changes_its_sign_at_the_speed(circular, flex):
    reducer = model(circular, flex)
    speed = critical_speed(reducer)
    assert growth_rate(reducer, 0.99 * speed) < 0.0 < growth_rate(reducer, 1.01 * speed)


def test_nothing_below_the_speed_is_unstable():
    reducer = model((0.2, 0.1), (0.15, 0.12))
    speed = critical_speed(reducer)
    assert all(growth_rate(reducer, fraction * speed) < 0.0 for fraction in (0.3, 0.45, 0.6, 0.75, 0.9, 0.97))


def test_small_indexes_are_stable_at_any_speed():
    assert critical_speed(model((0.03, 0.01), (0.02,))) == math.inf
    assert critical_speed(model()) == math.inf


def test_more_of_the_same_defect_is_unstable_earlier():
    speeds = [critical_speed(model(flex=(beta,))) for beta in (0.1, 0.14, 0.2, 0.3)]
    assert speeds == sorted(speeds, reverse=True)
    assert math.isfinite(speeds[0])


def test_the_papers_reducer_is_stable_at_the_papers_speed():
    assert critical_speed(replace(table_1(), torque=Torque(mean=0.0))) > 25.0 / 2.0 * 60.0

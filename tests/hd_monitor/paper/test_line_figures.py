"""Figure 8, equation 5 and Table 1."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.model import StiffnessSeries, steady_state
from hd_monitor.paper import printed
from hd_monitor.paper.diagnosis import diagnose
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.line_figures import equation_5, figure_8, line_distance, peak_near, table_1
from hd_monitor.paper.records import amplitude, steady_record


def test_figure_8_lines_are_at_k_times_25_and_25_3125_hz(cases):
    case = cases["table_1"]
    record = steady_record(case.model, case.speed)
    for k in (1, 2, 3):
        for line in (25.0 * k, 25.3125 * k):
            assert peak_near(record, record.displacement, line, 1e-8) == pytest.approx(line, abs=0.02)


def test_figure_8_time_integration_and_harmonic_balance_agree(cases):
    case = cases["table_1"]
    record = steady_record(case.model, case.speed)
    state = steady_state(case.model, case.speed)
    orders = [k * order for k in (1, 2, 3) for order in case.model.reducer.output_orders]
    balance = [abs(state.acceleration_phasor(order)) for order in orders]
    integrated = [amplitude(record.acceleration, order) for order in orders]
    assert integrated == pytest.approx(balance, abs=1e-4 * max(balance))


def test_figure_8_claims(exhibit, outcomes):
    assert outcomes(exhibit("F8")) == [Outcome.PASS] * 3


def test_figure_8_fails_at_another_speed_or_without_defects(cases, altered, outcomes):
    case = cases["table_1"]
    assert outcomes(figure_8(altered(table_1=replace(case, speed=760.0))))[0] is Outcome.FAIL
    weak = replace(case.model, flexspline=StiffnessSeries((1e-9,)), circular_spline=StiffnessSeries((0.06, 0.04, 0.02)))
    assert outcomes(figure_8(altered(table_1=replace(case, model=weak))))[1] is Outcome.FAIL


@pytest.mark.parametrize("speed", [400.0, 850.0])
@pytest.mark.parametrize("k", [1, 2, 3])
def test_equation_5(cases, speed, k):
    model = cases["table_1"].model
    record = steady_record(model, speed)
    orders = model.reducer.output_orders
    measured = line_distance(record, k * orders.circular_spline, k * orders.flexspline)
    assert measured == pytest.approx(k * speed / 30.0 * (162 / 160 - 1.0), rel=0.01)


def test_equation_5_claim(exhibit, outcomes):
    assert outcomes(exhibit("E5")) == [Outcome.PASS]


def test_equation_5_fails_with_other_teeth(cases, altered, outcomes):
    case = cases["table_1"]
    other = replace(case.model, reducer=replace(case.model.reducer, flexspline_teeth=120, circular_spline_teeth=122))
    assert outcomes(equation_5(altered(table_1=replace(case, model=other)))) == [Outcome.FAIL]


def test_the_case_is_the_printed_table(cases):
    model = cases["table_1"].model
    assert model.flexspline.beta == printed.TABLE_1["flexspline"]
    assert model.circular_spline.beta == printed.TABLE_1["circular_spline"]


def test_table_1_is_recovered_from_vibration(cases):
    case = cases["table_1"]
    found = diagnose(case).identification
    assert found is not None
    np.testing.assert_allclose(np.abs(found.flexspline), printed.TABLE_1["flexspline"], atol=1e-3)
    np.testing.assert_allclose(np.abs(found.circular_spline), printed.TABLE_1["circular_spline"], atol=1e-3)


def test_table_1_claims(exhibit, outcomes):
    assert outcomes(exhibit("T1")) == [Outcome.PASS, Outcome.PASS]


def test_table_1_fails_for_other_indexes(cases, altered, outcomes):
    case = cases["table_1"]
    other = replace(case, model=replace(case.model, flexspline=StiffnessSeries((0.05, 0.03, 0.025))))
    assert outcomes(table_1(altered(table_1=other))) == [Outcome.FAIL, Outcome.PASS]

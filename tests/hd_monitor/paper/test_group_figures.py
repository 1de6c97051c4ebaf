"""Figures 9 and 14."""

from dataclasses import replace

import pytest

from hd_monitor.model import StiffnessSeries, steady_state
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.group_figures import GROUP_2, figure_9, figure_14, group_lines, record_pair, without_fluctuation
from hd_monitor.paper.records import amplitude, steady_record


def lines_of_second_group(case):
    return {line.name: line for line in group_lines(case.model, record_pair(case), GROUP_2)}


def test_figure_9_second_group_is_spaced_by_one_line_distance(cases):
    case = cases["combined_groups"]
    lines = lines_of_second_group(case)
    frequencies = sorted(line.frequency for line in lines.values())
    assert frequencies == pytest.approx([49.6875, 50.0, 50.3125, 50.625, 50.9375])
    for name in ("3ωo2 − ωo1", "3ωo1 − ωo2"):
        assert lines[name].amplitude > 30.0 * lines[name].unloaded
    for name in ("2ωo2", "2ωo1"):
        assert lines[name].amplitude == pytest.approx(lines[name].unloaded, rel=0.1)


def test_figure_9_agrees_with_harmonic_balance(cases):
    case = cases["combined_groups"]
    state = steady_state(case.model, case.speed)
    record = steady_record(case.model, case.speed)
    measured = {order: amplitude(record.acceleration, order) for order in (318, 320, 322, 324, 326)}
    largest = max(measured.values())
    for order, height in measured.items():
        assert abs(state.acceleration_phasor(order)) == pytest.approx(height, abs=1e-3 * largest)


def test_figure_9_claims(exhibit, outcomes):
    assert outcomes(exhibit("F9")) == [Outcome.PASS, Outcome.PASS, Outcome.CONTRADICTION, Outcome.CONTRADICTION]


def test_figure_9_fails_without_load_fluctuation(cases, altered, outcomes):
    case = cases["combined_groups"]
    calm = replace(case, model=without_fluctuation(case.model))
    assert outcomes(figure_9(altered(combined_groups=calm)))[1:3] == [Outcome.FAIL, Outcome.FAIL]


def test_figure_14_claims(exhibit, outcomes):
    assert outcomes(exhibit("F14")) == [Outcome.PASS, Outcome.CONTRADICTION]


def test_figure_14_fails_where_the_splines_neither_couple_nor_feel_the_load(cases, altered, outcomes):
    case = cases["rig_loaded"]
    single = replace(without_fluctuation(case.model), flexspline=StiffnessSeries())
    assert outcomes(figure_14(altered(rig_loaded=replace(case, model=single))))[0] is Outcome.FAIL

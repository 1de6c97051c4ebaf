"""Figures 4 and 7."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.model import StiffnessSeries
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.stiffness_figures import (
    cycles_per_revolution,
    figure_4,
    figure_7,
    static_measurement,
    stiffness_curves,
)


def test_figure_4_periods(cases):
    case = cases["stiffness_sketch"]
    curves = stiffness_curves(case.model, 80.0)
    assert cycles_per_revolution(curves["angle"], curves["circular spline"]) == pytest.approx(2.0, abs=1e-5)
    assert cycles_per_revolution(curves["angle"], curves["flexspline"]) == pytest.approx(2.025, abs=1e-5)


def test_figure_4_claims(exhibit, outcomes):
    assert outcomes(exhibit("F4")) == [Outcome.PASS, Outcome.PASS]


def test_figure_4_fails_with_other_teeth(cases, altered, outcomes):
    case = cases["stiffness_sketch"]
    other = replace(
        case,
        model=replace(case.model, reducer=replace(case.model.reducer, flexspline_teeth=158, circular_spline_teeth=160)),
    )
    assert outcomes(figure_4(altered(stiffness_sketch=other))) == [Outcome.PASS, Outcome.FAIL]


def test_no_cycles_are_found_where_there_are_none():
    assert np.isnan(cycles_per_revolution(np.arange(10.0), np.ones(10)))


def test_figure_7_index_and_positions(cases):
    measured = static_measurement(cases["static_sample"])
    assert np.rad2deg(np.diff(measured.angle)) == pytest.approx(np.full(12, 30.0))
    assert measured.index == pytest.approx(0.082, abs=1e-3)
    assert measured.mean == pytest.approx(cases["static_sample"].model.dynamics.stiffness, rel=2e-3)


def test_figure_7_claims_and_the_contradiction_of_kav(exhibit, outcomes):
    shown = exhibit("F7")
    assert outcomes(shown) == [Outcome.PASS, Outcome.CONTRADICTION]
    assert shown.claims[1].ours.startswith("4.61 Hz")


def test_figure_7_fails_for_another_sample(cases, altered, outcomes):
    case = cases["static_sample"]
    weaker = replace(case, model=replace(case.model, flexspline=StiffnessSeries((0.01,))))
    assert outcomes(figure_7(altered(static_sample=weaker)))[0] is Outcome.FAIL

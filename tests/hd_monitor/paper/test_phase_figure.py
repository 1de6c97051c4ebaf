"""Figure 17."""

from dataclasses import replace

import pytest

from hd_monitor.model import StiffnessSeries
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.records import steady_record
from hd_monitor.paper.rig_figures import figure_17, quasiperiodicity


def test_figure_17_is_quasi_periodic_and_closes_after_40_wave_generator_revolutions(cases):
    case = cases["rig"]
    measured = quasiperiodicity(case, steady_record(case.model, case.speed))
    assert measured.stroboscopic_spread > 0.5
    assert measured.closing_error < 1e-6
    assert measured.lattice_power == pytest.approx(1.0, abs=1e-9)


def test_figure_17_claim(exhibit, outcomes):
    assert outcomes(exhibit("F17")) == [Outcome.PASS]


def test_figure_17_fails_for_a_motion_of_one_period(cases, altered, outcomes):
    case = cases["rig"]
    periodic = replace(case, model=replace(case.model, flexspline=StiffnessSeries()))
    assert outcomes(figure_17(altered(rig=periodic))) == [Outcome.FAIL]

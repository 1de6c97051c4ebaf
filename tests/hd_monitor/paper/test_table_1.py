"""Table 1."""

from dataclasses import replace

import numpy as np

from hd_monitor.model import StiffnessSeries
from hd_monitor.paper import printed
from hd_monitor.paper.diagnosis import diagnose
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.line_figures import table_1


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

"""Figures 18 to 20."""

import pytest

from hd_monitor.diagnosis.verdict import Component
from hd_monitor.paper.diagnosis import diagnose
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.reassembly_figures import figure_18a, figure_18b, figure_19, figure_20
from hd_monitor.paper.speed_figures import property_curve


@pytest.fixture
def unchanged(cases, altered):
    """The new circular spline is as bad as the old one."""
    return altered(sample_after=cases["sample_before"])


@pytest.fixture
def reversed_order(cases, altered):
    """The good circular spline was taken out."""
    return altered(sample_before=cases["sample_after"], sample_after=cases["sample_before"])


def test_figure_18_peak_halves(cases):
    before, after = (property_curve(cases[name]).highest for name in ("sample_before", "sample_after"))
    assert before[0] == after[0] == 1300.0
    assert after[1] / before[1] == pytest.approx(0.5, abs=0.1)


def test_figure_18_verdicts(cases):
    assert cases["sample_before"].speed == cases["sample_after"].speed == 1300.0
    before, after = (diagnose(cases[name]) for name in ("sample_before", "sample_after"))
    assert before.verdict.component is Component.CIRCULAR_SPLINE
    assert after.verdict.component is Component.NONE
    for name, assessment in (("sample_before", before), ("sample_after", after)):
        model, found = cases[name].model, assessment.identification
        assert found is not None
        assert found.index.circular_spline == pytest.approx(model.circular_spline.index, abs=1e-3)
        assert found.index.flexspline == pytest.approx(model.flexspline.index, abs=1e-3)


@pytest.mark.parametrize(("name", "count"), [("F18a", 3), ("F18b", 2), ("F19", 3), ("F20", 1)])
def test_figures_18_to_20_claims(exhibit, outcomes, name, count):
    assert outcomes(exhibit(name)) == [Outcome.PASS] * count


def test_figure_18a_fails_for_a_good_driver(reversed_order, outcomes):
    assert outcomes(figure_18a(reversed_order)) == [Outcome.PASS, Outcome.PASS, Outcome.FAIL]


def test_figure_18b_fails_when_nothing_was_changed(unchanged, outcomes):
    assert outcomes(figure_18b(unchanged)) == [Outcome.FAIL, Outcome.FAIL]


def test_figure_19_fails_when_nothing_was_changed(unchanged, outcomes):
    assert outcomes(figure_19(unchanged)) == [Outcome.FAIL, Outcome.PASS, Outcome.FAIL]


def test_figure_20_fails_when_nothing_was_changed(unchanged, outcomes):
    assert outcomes(figure_20(unchanged)) == [Outcome.FAIL]

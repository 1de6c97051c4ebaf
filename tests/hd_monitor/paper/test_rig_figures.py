"""Figures 13, 15 and 17."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.model import StiffnessSeries
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.records import steady_record
from hd_monitor.paper.rig_figures import (
    beat,
    figure_13a,
    figure_13c,
    figure_17,
    quasiperiodicity,
    strongest_pair,
)


@pytest.fixture
def swapped(cases, altered):
    """The rig with the defects of the two splines exchanged."""
    case = cases["rig"]
    model = replace(case.model, flexspline=case.model.circular_spline, circular_spline=case.model.flexspline)
    return altered(rig=replace(case, model=model))


@pytest.fixture
def single(cases, altered):
    """The rig with a perfect circular spline."""
    case = cases["rig"]
    return altered(rig=replace(case, model=replace(case.model, circular_spline=StiffnessSeries())))


def test_beat_of_two_tones():
    times = np.arange(20_000) / 1000.0
    measured = beat(np.cos(2 * np.pi * 50.0 * times) + 0.5 * np.cos(2 * np.pi * 50.7 * times), 1000.0)
    assert measured.frequency == pytest.approx(0.7, abs=0.01)
    assert measured.depth == pytest.approx(0.5, abs=0.01)


def test_figure_13a_claim(exhibit, outcomes):
    assert outcomes(exhibit("F13a")) == [Outcome.PASS]


def test_figure_13a_fails_without_a_second_line(single, outcomes):
    assert outcomes(figure_13a(single)) == [Outcome.FAIL]


def test_figure_13b_and_15_dominant_pair_is_near_the_resonance(cases):
    case = cases["rig"]
    assert strongest_pair(case, 850.0) == 2
    assert strongest_pair(case, 1700.0) == 1
    for speed, k in ((850.0, 2), (1700.0, 1)):
        assert case.model.reducer.line_frequencies(speed, k).circular_spline == pytest.approx(56.67, abs=0.01)


def test_figure_13b_claims(exhibit, outcomes):
    assert outcomes(exhibit("F13b")) == [Outcome.PASS, Outcome.CONTRADICTION]


def test_figure_13c_claims(exhibit, outcomes):
    assert outcomes(exhibit("F13c")) == [Outcome.PASS, Outcome.PASS]


def test_figure_13c_fails_with_the_defect_on_the_other_spline(swapped, outcomes):
    assert outcomes(figure_13c(swapped)) == [Outcome.FAIL, Outcome.FAIL]


def test_figure_15_claim(exhibit, outcomes):
    assert outcomes(exhibit("F15")) == [Outcome.CONTRADICTION]


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

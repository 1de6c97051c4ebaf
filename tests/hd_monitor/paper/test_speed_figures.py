"""Figure 16 and the stability chart."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.model import Dynamics, StiffnessSeries
from hd_monitor.paper.cases import Range
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.records import steady_record
from hd_monitor.paper.speed_figures import (
    figure_16,
    principal_threshold,
    property_curve,
    stability,
    stability_over_speed,
)


def test_figure_16_speeds_and_peaks(cases):
    curve = property_curve(cases["rig"])
    assert curve.speed == pytest.approx(np.arange(200.0, 3001.0, 100.0))
    assert curve.peaks == pytest.approx([800.0, 1600.0])
    assert curve.highest[0] == 1600.0


@pytest.mark.parametrize("speed", [500.0, 1600.0, 2900.0])
def test_figure_16_agrees_with_time_integration(cases, speed):
    case = cases["rig"]
    record = steady_record(case.model, speed)
    integrated = case.in_g(np.sqrt(np.mean(record.acceleration**2)))
    assert property_curve(case, np.array([speed])).rms[0] == pytest.approx(integrated, rel=2e-3)


def test_figure_16_is_in_g_at_the_sensor(cases):
    near, far = (replace(cases["rig"], sensor_radius=r) for r in (0.55, 1.10))
    at = np.array([1000.0])
    assert property_curve(far, at).rms[0] == pytest.approx(2.0 * property_curve(near, at).rms[0])


def test_unstable_speeds_are_left_out(cases):
    case = cases["sweep_single"]
    curve = property_curve(case, np.array([1000.0, 3260.0]))
    assert np.isfinite(curve.rms[0])
    assert np.isnan(curve.rms[1])
    assert curve.growth[1] > 0.0


def test_figure_16_claims(exhibit, outcomes):
    assert outcomes(exhibit("F16")) == [Outcome.PASS, Outcome.PASS, Outcome.CONTRADICTION, Outcome.PASS]


def test_figure_16_fails_without_a_second_harmonic(cases, altered, outcomes):
    case = cases["rig"]
    plain = replace(case.model, flexspline=StiffnessSeries((0.0, 0.0, 0.01)), circular_spline=StiffnessSeries())
    assert outcomes(figure_16(altered(rig=replace(case, model=plain))))[0] is Outcome.FAIL


def test_figure_16_instability_would_lie_in_the_figure_for_a_softer_driver(cases, altered, outcomes):
    case = cases["rig"]
    soft = replace(case, model=replace(case.model, dynamics=Dynamics(natural_frequency=43.4)))
    assert outcomes(figure_16(altered(rig=soft)))[2] is Outcome.FAIL


@pytest.mark.parametrize("zeta", [0.01, 0.023, 0.027])
def test_principal_threshold_is_four_times_the_damping(cases, zeta):
    model = cases["stability"].model
    damped = replace(model, dynamics=replace(model.dynamics, damping_ratio=zeta))
    assert principal_threshold(damped) == pytest.approx(4.0 * zeta, rel=0.01)


def test_chart_shows_the_tongue(cases):
    case = replace(cases["stability"], speeds=Range(3059.26, 3459.26, 100.0), scales=Range(0.0, 2.0, 0.5))
    surface = stability_over_speed(case).panels[0].surface
    assert surface is not None
    middle = surface.values[:, 2]  # ωo1 = 2ωn
    assert surface.y == pytest.approx(0.14 * np.arange(0.0, 2.1, 0.5))
    assert (middle > 0.0).tolist() == [False, False, True, True, True]
    assert middle[2] == pytest.approx(4.14, abs=0.05)
    assert surface.values[2, 0] < 0.0


def test_stability_claims(exhibit, outcomes):
    assert outcomes(exhibit("ST")) == [Outcome.PASS, Outcome.PASS]


def test_stability_fails_for_an_unstable_table(cases, altered, outcomes):
    unstable = replace(cases["sweep_single"], speed=3260.0)
    coarse = replace(cases["stability"], speeds=Range(3000.0, 3400.0, 200.0), scales=Range(0.0, 1.0, 0.5))
    assert outcomes(stability(altered(table_1=unstable, stability=coarse)))[1] is Outcome.FAIL

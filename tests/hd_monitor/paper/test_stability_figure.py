"""The stability chart."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.paper.cases import Range
from hd_monitor.paper.exhibit import Outcome
from hd_monitor.paper.speed_figures import chart_panel, principal_threshold, stability


@pytest.mark.parametrize("zeta", [0.01, 0.023, 0.027])
def test_principal_threshold_is_four_times_the_damping(cases, zeta):
    model = cases["stability"].model
    damped = replace(model, dynamics=replace(model.dynamics, damping_ratio=zeta))
    assert principal_threshold(damped) == pytest.approx(4.0 * zeta, rel=0.01)


def test_chart_shows_the_tongue(cases):
    case = replace(cases["stability"], speeds=Range(3059.26, 3459.26, 100.0), scales=Range(0.0, 2.0, 0.5))
    surface = chart_panel(case).surface
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

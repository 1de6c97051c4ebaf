from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.model import scale_defects
from hd_monitor.paper.cases import Range, load_own_case, paper_file
from hd_monitor.paper.reproduction import OWN_EXHIBITS, compute


@pytest.fixture(scope="module")
def case():
    return load_own_case(paper_file().with_name("my_reducer.yaml"))


def test_every_figure_is_shown_for_another_reducer(case):
    exhibits = compute(OWN_EXHIBITS, case)
    assert list(exhibits) == [entry.id for entry in OWN_EXHIBITS]
    assert all(shown.panels and not shown.claims for shown in exhibits.values())
    assert exhibits["F10"].caption.startswith("β1 = 0.0458, β2 = 0.0374, ζ = 0.03, ")


def test_characteristic_numbers_are_this_reducers(case):
    (shown,) = compute(OWN_EXHIBITS, case, ["F4"]).values()
    facts = dict(shown.facts)
    assert facts["reduction"] == "101"
    assert facts["flexspline, cycles per wave-generator revolution"] == "2.00000"
    assert facts["circular spline, cycles per wave-generator revolution"] == f"{2 * 200 / 202:.5f}"
    assert facts["output travel that separates the pairs k = 1, 2, 3"].startswith("180°, 90°, 60°")


def test_unstable_speeds_are_named(case):
    wild = replace(case, model=scale_defects(case.model, 4.0), speeds=Range(1480.0, 1740.0, 20.0))
    (shown,) = compute(OWN_EXHIBITS, wild, ["F16"]).values()
    curve = shown.panels[0].curves[0]
    assert np.isnan(curve.y).any()
    assert "1680" in dict(shown.facts)["unstable speeds (left out of the curve)"]


def test_a_reducer_unstable_at_every_speed_is_reported_so(case):
    wild = replace(case, model=scale_defects(case.model, 5.0), speeds=Range(1660.0, 1700.0, 20.0))
    (shown,) = compute(OWN_EXHIBITS, wild, ["F16"]).values()
    assert dict(shown.facts)["highest"] == "none: no stable speed"

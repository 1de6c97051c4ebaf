import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.errors import ParameterError
from hd_monitor.model import ParametricModel, StiffnessSeries
from hd_monitor.model.static_test import StaticTestBed, fit_stiffness

EVERY_30 = np.deg2rad(np.arange(0.0, 361.0, 30.0))
IDEAL = StaticTestBed(force_resolution=0.0, dial_resolution=0.0)


@given(st.floats(0.0, 0.2), st.floats(0.0, 0.2))
def test_an_ideal_bed_reads_the_models_stiffness(flexspline, circular_spline):
    model = ParametricModel(
        flexspline=StiffnessSeries((flexspline,)), circular_spline=StiffnessSeries((circular_spline,))
    )
    expected = model.dynamics.stiffness * (1.0 + model.stiffness_fluctuation(EVERY_30 / model.reducer.reduction))
    assert IDEAL.measure(model, EVERY_30) == pytest.approx(expected, rel=1e-12)


def test_instruments_steps_show_but_little():
    model = ParametricModel(circular_spline=StiffnessSeries((0.08,)))
    real, ideal = StaticTestBed().measure(model, EVERY_30), IDEAL.measure(model, EVERY_30)
    assert (real != ideal).any()
    assert real == pytest.approx(ideal, rel=5e-3)


@given(st.floats(0.001, 0.3), st.floats(-3.1, 3.1))
def test_fit_returns_mean_index_and_phase(beta, phase):
    readings = 30_000.0 * (1.0 + beta * np.cos(2.0 * EVERY_30 + phase))
    fit = fit_stiffness(EVERY_30, readings)
    assert fit.mean == pytest.approx(30_000.0)
    assert fit.index == pytest.approx(beta, rel=1e-5)
    assert np.exp(1j * np.angle(fit.series.phasors[0])) == pytest.approx(np.exp(1j * phase))
    assert fit(EVERY_30) == pytest.approx(readings)


def test_index_is_half_the_range():
    readings = 100.0 * (1.0 + 0.05 * np.cos(2.0 * EVERY_30) + 0.03 * np.cos(4.0 * EVERY_30))
    dense = np.linspace(0.0, np.pi, 100_001)
    curve = 0.05 * np.cos(2.0 * dense) + 0.03 * np.cos(4.0 * dense)
    assert fit_stiffness(EVERY_30, readings).index == pytest.approx(np.ptp(curve) / 2.0, rel=1e-4)


def test_too_few_positions_are_refused():
    every_90 = np.deg2rad(np.arange(0.0, 361.0, 90.0))
    with pytest.raises(ParameterError, match="do not separate 2 harmonics"):
        fit_stiffness(every_90, np.ones(every_90.size))


@pytest.mark.parametrize("wrong", [{"torque": 0.0}, {"dial_arm": -1.0}, {"force_arm": math.nan}])
def test_an_impossible_bed_is_refused(wrong):
    with pytest.raises(ParameterError, match="not possible for a test bed"):
        StaticTestBed(**wrong)


def test_a_negative_resolution_is_refused():
    with pytest.raises(ParameterError, match="is not a resolution"):
        StaticTestBed(dial_resolution=-1e-6)

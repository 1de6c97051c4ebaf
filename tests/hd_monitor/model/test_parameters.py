"""The model's parameters: eq. 2 to 4 as functions of the output angle."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle import table_1

from hd_monitor.errors import ParameterError
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque
from hd_monitor.reducer import Reducer

ANGLES = np.linspace(-7.0, 7.0, 501)
REDUCERS = st.builds(
    lambda z1, extra, mount: Reducer(flexspline_teeth=z1, circular_spline_teeth=z1 + 2 * extra, mount=mount),
    st.integers(60, 400),
    st.integers(1, 3),
    st.sampled_from(["circular_spline_fixed", "flexspline_fixed"]),
)
BETAS = st.lists(st.floats(-0.2, 0.2), min_size=1, max_size=5)


class TestDynamics:
    def test_stiffness_and_inertia_give_the_natural_frequency(self):
        dynamics = Dynamics(natural_frequency=55.0, inertia=0.29)
        assert math.sqrt(dynamics.stiffness / 0.29) / math.tau == pytest.approx(55.0, rel=1e-12)

    def test_receptance_is_one_at_rest_and_1_over_2_zeta_at_resonance(self):
        dynamics = Dynamics(natural_frequency=55.0, damping_ratio=0.023)
        assert dynamics.receptance(0.0) == 1.0
        assert abs(dynamics.receptance(55.0)) == pytest.approx(1 / 0.046, rel=1e-12)
        assert np.angle(dynamics.receptance(55.0)) == pytest.approx(-np.pi / 2)

    @pytest.mark.parametrize(
        ("field", "value"),
        [
            ("natural_frequency", 0.0),
            ("natural_frequency", -1.0),
            ("natural_frequency", math.nan),
            ("damping_ratio", -0.01),
            ("damping_ratio", math.inf),
            ("inertia", 0.0),
        ],
    )
    def test_impossible_values_are_refused_by_name(self, field, value):
        with pytest.raises(ParameterError, match=field):
            Dynamics(**{field: value})

    def test_no_damping_is_possible(self):
        assert Dynamics(damping_ratio=0.0).damping_ratio == 0.0


class TestStiffnessSeries:
    @given(BETAS, st.data())
    def test_is_the_sum_of_cosines(self, beta, data):
        phase = data.draw(st.lists(st.floats(-4, 4), min_size=len(beta), max_size=len(beta)))
        expected = sum(b * np.cos(i * ANGLES + p) for i, (b, p) in enumerate(zip(beta, phase, strict=True), start=1))
        np.testing.assert_allclose(StiffnessSeries(beta, phase)(ANGLES), expected, atol=1e-13)

    @given(st.lists(st.complex_numbers(max_magnitude=0.5), min_size=1, max_size=5))
    def test_phasors_are_a_round_trip(self, phasors):
        np.testing.assert_allclose(StiffnessSeries.from_phasors(phasors).phasors, phasors, atol=1e-14)

    def test_index_is_the_root_sum_square(self):
        assert StiffnessSeries((0.03, -0.04)).index == pytest.approx(0.05)

    def test_an_empty_series_means_no_fluctuation(self):
        assert StiffnessSeries().index == 0.0
        assert not StiffnessSeries()(ANGLES).any()

    def test_any_shape_is_kept(self):
        assert StiffnessSeries((0.1,))(np.zeros((2, 3))).shape == (2, 3)

    def test_phases_default_to_zero(self):
        assert StiffnessSeries((0.1, 0.2)).phase == (0.0, 0.0)

    def test_a_phase_too_few_is_refused(self):
        with pytest.raises(ParameterError, match="1 phases for 2 harmonics"):
            StiffnessSeries((0.1, 0.2), (0.0,))

    @pytest.mark.parametrize("beta", [(math.nan,), (0.1, math.inf)])
    def test_values_that_are_not_finite_are_refused(self, beta):
        with pytest.raises(ParameterError, match="not finite"):
            StiffnessSeries(beta)


class TestTorque:
    @pytest.mark.parametrize("order", [0, -1, 1.5])
    def test_a_load_repeats_with_the_output(self, order):
        with pytest.raises(ParameterError, match="load_order"):
            Torque(load_order=order)

    @pytest.mark.parametrize("field", ["drive_fluctuation", "load_fluctuation"])
    def test_amplitudes_are_not_negative(self, field):
        with pytest.raises(ParameterError, match=field):
            replace(Torque(), **{field: -1.0})  # type: ignore[arg-type]

    @pytest.mark.parametrize("field", ["mean", "drive_phase", "load_phase"])
    def test_nan_is_refused(self, field):
        with pytest.raises(ParameterError, match=field):
            replace(Torque(), **{field: math.nan})  # type: ignore[arg-type]


class TestParametricModel:
    @given(REDUCERS, BETAS, BETAS)
    def test_each_spline_repeats_with_its_own_teeth(self, reducer, flexspline, circular_spline):
        """Per output revolution z1 cycles of the circular spline and z2 of the flexspline, over half the difference."""
        half = reducer.tooth_difference / 2
        q = np.linspace(0.0, 1.0, 50)
        only_cs = ParametricModel(reducer=reducer, circular_spline=StiffnessSeries(circular_spline))
        shift = math.tau * half / reducer.flexspline_teeth
        np.testing.assert_allclose(
            only_cs.stiffness_fluctuation(q + shift), only_cs.stiffness_fluctuation(q), atol=1e-9
        )
        only_fs = ParametricModel(reducer=reducer, flexspline=StiffnessSeries(flexspline))
        shift = math.tau * half / reducer.circular_spline_teeth
        np.testing.assert_allclose(
            only_fs.stiffness_fluctuation(q + shift), only_fs.stiffness_fluctuation(q), atol=1e-9
        )

    def test_the_rig_follows_the_papers_frequencies(self):
        """At 750 rpm the paper's ωo1 (flexspline) is 25.3125 Hz and its ωo2 (circular spline) 25 Hz (section 3.2)."""
        model = table_1()
        t = np.linspace(0.0, 1.0, 1000)
        q = math.tau * 750.0 / 60.0 * t / 80.0
        expected = sum(b * np.cos(i * math.tau * 25.3125 * t) for i, b in enumerate((0.05, 0.03, 0.02), start=1)) + sum(
            b * np.cos(j * math.tau * 25.0 * t) for j, b in enumerate((0.06, 0.04, 0.02), start=1)
        )
        np.testing.assert_allclose(model.stiffness_fluctuation(q), expected, atol=1e-12)

    def test_the_papers_load_has_the_difference_of_the_line_frequencies(self):
        """Two cycles per output revolution at 750 rpm are 0.3125 Hz; the drive's ripple is at 25 Hz."""
        model = ParametricModel(torque=Torque(mean=10.0, drive_fluctuation=1.0, load_fluctuation=5.0, load_phase=0.3))
        t = np.linspace(0.0, 4.0, 1000)
        q = math.tau * 750.0 / 60.0 * t / 80.0
        expected = 10.0 + 5.0 * np.cos(math.tau * 0.3125 * t + 0.3) + np.cos(math.tau * 25.0 * t)
        np.testing.assert_allclose(model.torque_at(q), expected, atol=1e-12)

    def test_the_static_deflection_balances_the_torque(self):
        model = table_1(torque=Torque(mean=40.0, load_fluctuation=3.0))
        theta = model.static_deflection(ANGLES)
        np.testing.assert_allclose(model.acceleration(ANGLES, theta, 0.0), 0.0, atol=1e-10)

    def test_the_acceleration_is_eq_3(self):
        model = table_1()
        q, theta, velocity = 0.4, 3e-4, 0.02
        stiffness = model.dynamics.stiffness * (1.0 + float(model.stiffness_fluctuation(q)))
        damping = 2 * 0.023 * model.dynamics.angular_frequency * 0.29
        expected = (10.0 - damping * velocity - stiffness * theta) / 0.29
        assert model.acceleration(q, theta, velocity) == pytest.approx(expected, rel=1e-12)

    def test_table_1_takes_changes(self):
        assert table_1(dynamics=Dynamics(natural_frequency=40.0)).dynamics.natural_frequency == 40.0

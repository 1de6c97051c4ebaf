"""The defects to choose from give a clear verdict and a stable rig over the whole programme."""

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries
from hd_monitor.settings import JointSettings
from hd_sim_node.drive.defects import DEFECTS, stiffness_of
from hd_sim_node.drive.stability import describe, unstable_speeds
from hd_sim_node.motion.programmes import build_programme
from hd_sim_node.settings import RigSettings

LIMITS = JointSettings.from_mapping().diagnosis
NOTHING = StiffnessSeries()


def model_of(defect):
    flexspline, circular_spline = stiffness_of(defect, NOTHING, NOTHING)
    return ParametricModel(flexspline=flexspline, circular_spline=circular_spline)


@pytest.mark.parametrize(
    ("defect", "bad_flexspline", "bad_circular_spline"),
    [("none", False, False), ("flexspline", True, False), ("circular_spline", False, True), ("both", True, True)],
)
def test_indexes_are_clear_of_the_monitors_limits(defect, bad_flexspline, bad_circular_spline):
    model = model_of(defect)
    for index, bad in ((model.flexspline.index, bad_flexspline), (model.circular_spline.index, bad_circular_spline)):
        if bad:
            assert index > 1.2 * LIMITS.error_index
        else:
            assert 0.005 < index < 0.5 * LIMITS.warn_index


@pytest.mark.parametrize("defect", DEFECTS)
def test_every_defect_is_stable_over_the_papers_speeds(defect):
    programme = build_programme("dwell", {}, ParametricModel().reducer)
    assert unstable_speeds(model_of(defect), programme) == []


def test_custom_takes_the_series_given():
    flexspline, circular_spline = StiffnessSeries((0.1,)), StiffnessSeries((0.2,))
    assert stiffness_of("custom", flexspline, circular_spline) == (flexspline, circular_spline)


def test_an_unknown_defect_is_refused_with_the_choice():
    with pytest.raises(ParameterError, match="none, flexspline, circular_spline, both, custom"):
        RigSettings.from_mapping({"defect": "rust"})


def test_a_stiffness_that_could_vanish_is_refused():
    with pytest.raises(ParameterError, match=r"add up to 1\.1"):
        stiffness_of("custom", StiffnessSeries((0.6, -0.2)), StiffnessSeries((0.3,)))


def fixed(speed):
    return build_programme("fixed", {"fixed.speed": speed}, ParametricModel().reducer)


class TestStability:
    wild = ParametricModel(circular_spline=StiffnessSeries((0.14,)))

    def test_the_unstable_speed_is_named(self):
        found = unstable_speeds(self.wild, fixed(3300.0))
        assert [u.speed_rpm for u in found] == [3300.0]
        assert found[0].growth_rate == pytest.approx(4.1, abs=0.1)
        assert "at 3300 rpm" in describe(found)
        assert "0.24 s" in describe(found)

    def test_a_reversed_speed_is_as_unstable(self):
        assert unstable_speeds(self.wild, fixed(-3300.0)) == unstable_speeds(self.wild, fixed(3300.0))

    def test_a_stable_speed_is_not(self):
        assert unstable_speeds(self.wild, fixed(2000.0)) == []

    def test_speeds_within_a_sweep_are_searched(self):
        sweep = build_programme("sweep", {"sweep.first": 2000.0, "sweep.last": 4000.0}, self.wild.reducer)
        found = unstable_speeds(self.wild, sweep)
        assert 3300.0 in [u.speed_rpm for u in found]
        assert all(3100.0 < u.speed_rpm < 3500.0 for u in found)
        assert "speeds from" in describe(found)

    def test_a_tongue_of_the_third_harmonic_is_found(self):
        """β at k = 3 reaches 2 fn at a third of the speed."""
        third = ParametricModel(circular_spline=StiffnessSeries((0.0, 0.0, 0.14)))
        assert [u.speed_rpm for u in unstable_speeds(third, fixed(1100.0))] == [1100.0]

    def test_without_damping_the_second_tongue_is_found(self):
        """At half the principal speed, where damping usually hides it."""
        light = ParametricModel(dynamics=Dynamics(damping_ratio=1e-4), circular_spline=StiffnessSeries((0.14,)))
        at = 1650.0
        assert any(unstable_speeds(light, fixed(at + shift)) for shift in (-10.0, -5.0, 0.0, 5.0))

    def test_a_rig_without_defects_or_motion_is_stable(self):
        assert unstable_speeds(ParametricModel(), fixed(3300.0)) == []
        assert unstable_speeds(self.wild, fixed(0.0)) == []

"""The sensorless identification on recordings of a real arm, whose joint 2 shows the circular spline."""

import numpy as np
import pytest
from tests.hd_monitor.identification.sensorless.runs import (
    identify,
    named,
    settings_of,
)

from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.diagnosis.status import status_of
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.monitor import Monitor
from hd_monitor.sources import Quantity

LONG, SHORT = "ur-20_02_12-50sec_12harm", "ur-20_02_06-20sec_10harm"
J1_ONLY, J5_ONLY = "ur-20_01_22-joint_1", "ur-20_01_22-joint_5"
MOVING = [(J1_ONLY, 1), (J5_ONLY, 5), *((file, joint) for file in (SHORT, LONG) for joint in range(1, 7))]
UR10E = {
    "reducer__flexspline_teeth": 200,
    "reducer__circular_spline_teeth": 202,
    "reducer__mount": "flexspline_fixed",
}


@pytest.mark.shared_data
@pytest.mark.parametrize("source", ["joint_effort", "joint_velocity"])
@pytest.mark.parametrize("file", [SHORT, LONG])
def test_joint_2_of_a_real_arm_shows_the_circular_spline_in_every_file_and_direction(ur10e, file, source):
    identifier = identify(ur10e(file, 2), settings_of(**UR10E, input__source=source))
    assert len(identifier.directions) == 2
    for side in identifier.directions:
        assert side.amplitude.circular_spline > side.amplitude.flexspline
        assert side.dominance.circular_spline > 0.9
        assert side.chance.circular_spline < (1e-3 if source == "joint_effort" else 1e-2)


@pytest.mark.shared_data
@pytest.mark.parametrize("file", [SHORT, LONG])
def test_joint_2_is_named(ur10e, file):
    identifier = identify(ur10e(file, 2), settings_of(**UR10E))
    assert named(identifier, settings_of(**UR10E)) is Component.CIRCULAR_SPLINE


@pytest.mark.shared_data
@pytest.mark.parametrize("file", [SHORT, LONG])
def test_the_monitor_shows_joint_2_in_its_status(ur10e, file):
    samples, parameters = ur10e(file, 2), settings_of(**UR10E)
    monitor = Monitor(parameters)
    monitor.add(
        Quantity.MOTION, np.rint(1e9 * samples.times).astype(np.int64), samples.angle, samples.speed, samples.effort
    )
    assessment = monitor.finish()
    assert assessment is not None
    status = status_of(assessment, "joint_2")
    assert status.value("component") == "circular_spline"
    assert status.value("index kind") == "relative"
    assert status.value("unstable from (rpm)") == "unknown"
    assert "relative only" in status.message


@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("file", "joint"), [(J5_ONLY, 5), *((file, joint) for file in (SHORT, LONG) for joint in range(3, 7))]
)
def test_joints_whose_directions_do_not_agree_are_undetermined(ur10e, file, joint):
    identifier = identify(ur10e(file, joint), settings_of(**UR10E))
    assert named(identifier, settings_of(**UR10E)) is Component.UNDETERMINED
    assert identifier.estimate().blockers


@pytest.mark.shared_data
def test_files_of_one_joint_never_name_different_splines(ur10e):
    for source in ("joint_effort", "joint_velocity"):
        for joint in range(1, 7):
            names = {
                named(identify(ur10e(file, number), parameters), parameters)
                for file, number in MOVING
                if number == joint and (parameters := settings_of(**UR10E, input__source=source))
            }
            assert len(names - {Component.UNDETERMINED}) <= 1


@pytest.mark.shared_data
def test_the_lines_are_where_the_kinematics_says_in_most_directions(ur10e):
    sides = [side for file, joint in MOVING for side in identify(ur10e(file, joint), settings_of(**UR10E)).directions]
    assert len(sides) == 28
    assert sum(side.found for side in sides) >= 20
    assert sum(min(side.chance) < 0.05 for side in sides) >= 26


@pytest.mark.shared_data
def test_wrong_teeth_near_by_are_noticed_on_the_real_arm(ur10e):
    other = UR10E | {"reducer__flexspline_teeth": 190, "reducer__circular_spline_teeth": 192}
    blockers = identify(ur10e(LONG, 2), settings_of(**other)).estimate().blockers
    assert any("stronger line at about 200" in describe_limitation(reason) for reason in blockers)

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
from hd_monitor.identification.sensorless.identifier import SensorlessIdentifier
from hd_monitor.limitation import LimitationCode
from hd_monitor.monitor import Monitor
from hd_monitor.offline.identify_teeth import rank_tooth_pairs
from hd_monitor.sources import Quantity

LONG, SHORT = "ur-20_02_12-50sec_12harm", "ur-20_02_06-20sec_10harm"
J1_ONLY, J5_ONLY = "ur-20_01_22-joint_1", "ur-20_01_22-joint_5"
J2_ONLY, LOADED, MIDDLE = "ur-20_01_22-joint_2", "ur-20_01_31-load", "ur-20_02_10-30sec_12harm"
EVERY = [
    (J1_ONLY, 1),
    (J2_ONLY, 2),
    (J5_ONLY, 5),
    *((file, joint) for file in (LOADED, SHORT, MIDDLE, LONG) for joint in range(1, 7)),
]
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
    assert "unstable from (rpm)" not in dict(status.values)
    assert "relative only" in status.message


@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("file", "joint"), [(J5_ONLY, 5), (SHORT, 3), (SHORT, 4), (SHORT, 5), *((LONG, joint) for joint in range(3, 7))]
)
def test_joints_whose_directions_do_not_agree_are_undetermined(ur10e, file, joint):
    identifier = identify(ur10e(file, joint), settings_of(**UR10E))
    assert named(identifier, settings_of(**UR10E)) is Component.UNDETERMINED
    assert identifier.estimate().blockers


@pytest.mark.shared_data
def test_what_the_recordings_bear_is_named(ur10e):
    """A strong direction carries a weak one that agrees, as those of joint 1 do in nearly every recording."""
    parameters = settings_of(**UR10E)
    names = {(file, joint): named(identify(ur10e(file, joint), parameters), parameters) for file, joint in EVERY}
    assert {key: name for key, name in names.items() if name is not Component.UNDETERMINED} == {
        **{(file, 2): Component.CIRCULAR_SPLINE for file in (J2_ONLY, LOADED, SHORT, MIDDLE, LONG)},
        **{(file, 1): Component.FLEXSPLINE for file in (J1_ONLY, MIDDLE, LONG)},
        (SHORT, 6): Component.CIRCULAR_SPLINE,
    }


@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("joint", "component"),
    [
        (1, Component.FLEXSPLINE),
        (2, Component.CIRCULAR_SPLINE),
        (3, Component.UNDETERMINED),
        (4, Component.UNDETERMINED),
        (5, Component.UNDETERMINED),
        (6, Component.UNDETERMINED),
    ],
)
def test_all_recordings_of_a_joint_add_up(ur10e, joint, component):
    parameters = settings_of(**UR10E, analysis__memory=3600.0)
    identifier = SensorlessIdentifier(parameters)
    for file, number in EVERY:
        if number == joint:
            identifier.add(ur10e(file, joint))
            identifier.cut()
    assert named(identifier, parameters) is component


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


@pytest.mark.shared_data
@pytest.mark.parametrize("source", ["joint_effort", "joint_velocity"])
def test_the_right_teeth_are_never_questioned_on_the_real_arm(ur10e, source):
    parameters = settings_of(**UR10E, input__source=source)
    for file, joint in EVERY:
        blockers = identify(ur10e(file, joint), parameters).estimate().blockers
        assert not {reason.code for reason in blockers} & {
            LimitationCode.TEETH_CONTRADICTED,
            LimitationCode.TEETH_AMBIGUOUS,
            LimitationCode.MOTOR_LINE,
        }


@pytest.mark.shared_data
@pytest.mark.parametrize("file", [J2_ONLY, LOADED, MIDDLE])
def test_joint_2_is_named_where_travel_is_short(ur10e, file):
    assert named(identify(ur10e(file, 2), settings_of(**UR10E)), settings_of(**UR10E)) is Component.CIRCULAR_SPLINE


@pytest.mark.shared_data
@pytest.mark.parametrize("source", ["joint_effort", "joint_velocity"])
@pytest.mark.parametrize("teeth", [198, 202])
def test_teeth_that_share_a_line_with_the_right_ones_name_nothing(ur10e, source, teeth):
    wrong = UR10E | {"reducer__flexspline_teeth": teeth, "reducer__circular_spline_teeth": teeth + 2}
    parameters = settings_of(**wrong, input__source=source)
    names = {named(identify(ur10e(file, joint), parameters), parameters) for file, joint in EVERY}
    assert names == {Component.UNDETERMINED}


@pytest.mark.shared_data
@pytest.mark.parametrize("mount", ["circular_spline_fixed", "flexspline_fixed"])
def test_a_line_once_per_motor_revolution_is_not_a_splines(franka, mount):
    parameters = settings_of(reducer__flexspline_teeth=120, reducer__circular_spline_teeth=122, reducer__mount=mount)
    identifier = identify(franka(1), parameters)
    assert named(identifier, parameters) is Component.UNDETERMINED
    (reason,) = map(describe_limitation, identifier.estimate().blockers)
    assert "120 cycles per output revolution is once per motor revolution of 240/242 teeth" in reason
    assert "is once per motor revolution of 240/242" in rank_tooth_pairs(franka(1)).statement

"""How much of a line follows the torque, from joint states alone."""

import numpy as np
import pytest
from tests.hd_monitor.identification.sensorless.runs import identify, settings_of
from tests.simulated.joints import random_joint, simulate_joint

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.reducer import LinePair


def shares(seed=4, source="joint_effort", **fixed):
    plain = {
        "motion": "harmonics",
        "noise": 0.03,
        "redness": 0.5,
        "spikes": 0.0,
        "rate": 125.0,
        "speed_dependence": 0.0,
    }
    case = random_joint(np.random.default_rng(seed), LinePair(3.0, 3.0), **(plain | fixed))
    identifier = identify(simulate_joint(case), case.settings(**{"input.source": source}))
    return identifier.finish().torque_shares


@pytest.mark.parametrize(("following", "reading"), [(0.0, "transmission_error"), (1.0, "stiffness")])
def test_what_follows_the_torque_is_read_as_stiffness_and_what_does_not_as_transmission_error(following, reading):
    found = shares(following=following)
    assert [row.spline for row in found] == ["circular_spline", "flexspline"]
    for row in found:
        assert row.reading == reading
        assert row.low - 0.01 <= following <= row.high + 0.01
        assert row.low <= row.share <= row.high


def test_where_both_are_alike_neither_is_read():
    assert {row.reading for row in shares(following=0.5)} == {"either"}


def test_without_both_directions_or_without_effort_nothing_is_said():
    assert shares(motion="rotation", following=1.0) == ()
    assert shares(source="joint_velocity", following=1.0) == ()


def test_where_the_torque_hardly_swings_the_interval_holds_nearly_everything():
    rng, times = np.random.default_rng(1), np.arange(0.0, 60.0, 0.01)
    angle, speed = 0.8 * np.sin(0.9 * times), 0.72 * np.cos(0.9 * times)
    effort = 5.0 + 0.3 * np.cos(160 * angle) + 0.05 * rng.standard_normal(times.size)
    found = identify(JointSamples(times=times, angle=angle, speed=speed, effort=effort), settings_of()).finish()
    assert all(row.reading == "either" for row in found.torque_shares)


@pytest.mark.shared_data
def test_on_a_real_arm_more_than_one_line_is_read_as_transmission_error_and_none_as_stiffness(ur10e):
    teeth = {"reducer__flexspline_teeth": 200, "reducer__circular_spline_teeth": 202}
    settings = settings_of(**teeth, reducer__mount="flexspline_fixed")
    joints = [identify(ur10e("ur-20_02_12-50sec_12harm", joint), settings).finish() for joint in range(1, 7)]
    readings = [row.reading for joint in joints for row in joint.torque_shares]
    assert readings.count("transmission_error") > 1
    assert "stiffness" not in readings

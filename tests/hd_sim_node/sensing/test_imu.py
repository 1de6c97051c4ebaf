"""An IMU on the output link feels vibration, turning and gravity on the right axes."""

import numpy as np
import pytest
from tests.oracle import table_1

from hd_monitor.model import ParametricModel
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.surroundings import Surroundings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.imu import imu_readings

AROUND = Surroundings()
RIG = Rig(table_1(), SpeedProgramme(times=[0.0, 1.0], speeds=[900.0, 900.0]), rate=1000.0)
MOTION = RIG.advance(500)
SAMPLES = MOTION.acceleration


def test_the_tangential_axis_carries_the_vibration():
    force, _ = imu_readings(MOTION, SAMPLES, radius=0.55, axis="y", surroundings=AROUND)
    np.testing.assert_allclose(force[:, 1], 0.55 * SAMPLES)
    np.testing.assert_allclose(force[:, 0], -0.55 * MOTION.speed**2)
    np.testing.assert_allclose(force[:, 2], 9.80665)


@pytest.mark.parametrize(("axis", "tangential", "along"), [("x", 0, 1), ("y", 1, 2), ("z", 2, 0)])
def test_axes_follow_each_other(axis, tangential, along):
    force, turning = imu_readings(MOTION, SAMPLES, radius=0.5, axis=axis, surroundings=AROUND)
    np.testing.assert_allclose(force[:, tangential], 0.5 * SAMPLES)
    np.testing.assert_allclose(turning[:, along], MOTION.speed + MOTION.velocity)
    assert np.count_nonzero(turning.any(axis=0)) == 1


def test_a_minus_turns_the_sensor_around():
    plain = imu_readings(MOTION, SAMPLES, radius=0.5, axis="y", surroundings=AROUND)
    turned = imu_readings(MOTION, SAMPLES, radius=0.5, axis="-y", surroundings=AROUND)
    for one, other in zip(plain, turned, strict=True):
        np.testing.assert_allclose(one * [1.0, -1.0, -1.0], other)


def test_gravity_is_felt_in_the_plane_of_motion_where_it_loads_the_joint():
    """At rest the specific force is 1 g whatever the angle, and its tangential part is largest where the torque is."""
    around = Surroundings(gravity=3.0, gravity_angle=0.7)
    slow = SpeedProgramme(times=[0.0, 1.0], speeds=[60.0, 60.0])
    rig = Rig(ParametricModel(), slow, rate=50.0, surroundings=around)
    motion = rig.advance(4000)
    force, _ = imu_readings(motion, 0.0 * motion.times, radius=0.0, axis="y", surroundings=around)
    np.testing.assert_allclose(np.linalg.norm(force, axis=1), 9.80665)
    assert not force[:, 2].any()
    torque = rig.torque(motion.times) - 10.0
    np.testing.assert_allclose(force[:, 1], -9.80665 * torque / 3.0, atol=1e-9)


def test_a_joint_that_only_the_payload_loads_lies_the_same_way():
    readings = [
        imu_readings(MOTION, SAMPLES, radius=0.5, axis="y", surroundings=around)
        for around in (Surroundings(gravity=3.0), Surroundings(payload=3.0))
    ]
    np.testing.assert_array_equal(readings[0][0], readings[1][0])


def test_turning_by_gravity_has_the_sense_of_the_motion():
    """As the link turns by dq, gravity turns by -dq seen from it: d(force)/dq is force turned by a right angle."""
    around = Surroundings(gravity=3.0)
    motion = Rig(ParametricModel(), SpeedProgramme(times=[0.0, 1.0], speeds=[60.0, 60.0]), rate=1000.0).advance(2000)
    force, _ = imu_readings(motion, 0.0 * motion.times, radius=0.0, axis="y", surroundings=around)
    slope = np.gradient(force, motion.angle, axis=0)[1:-1]
    np.testing.assert_allclose(slope[:, 0], force[1:-1, 1], atol=1e-4)
    np.testing.assert_allclose(slope[:, 1], -force[1:-1, 0], atol=1e-4)

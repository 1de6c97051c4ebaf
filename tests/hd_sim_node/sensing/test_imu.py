"""An IMU on the output link feels vibration, turning and gravity on the right axes."""

import numpy as np
import pytest
from tests.oracle import table_1

from hd_monitor.model import ParametricModel
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.surroundings import Surroundings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.fault import FaultSettings
from hd_sim_node.sensing.imu import Imu, ImuReadings, ImuSettings

AROUND = Surroundings()
RIG = Rig(table_1(), SpeedProgramme(times=[0.0, 1.0], speeds=[900.0, 900.0]), rate=1000.0)
MOTION = RIG.advance(500)
SAMPLES = MOTION.acceleration


def read(motion=MOTION, samples=SAMPLES, *, surroundings=AROUND, gain=1.0, fault=None, **settings) -> ImuReadings:
    return Imu(ImuSettings(**settings), fault).measure(motion, samples, surroundings=surroundings, gain=gain)


def test_the_tangential_axis_carries_the_vibration():
    force, _ = read(radius=0.55)
    np.testing.assert_allclose(force[:, 1], 0.55 * SAMPLES)
    np.testing.assert_allclose(force[:, 0], -0.55 * MOTION.speed**2)
    np.testing.assert_allclose(force[:, 2], 9.80665)


@pytest.mark.parametrize(("axis", "tangential", "along"), [("x", 0, 1), ("y", 1, 2), ("z", 2, 0)])
def test_axes_follow_each_other(axis, tangential, along):
    force, turning = read(radius=0.5, imu_axis=axis)
    np.testing.assert_allclose(force[:, tangential], 0.5 * SAMPLES)
    np.testing.assert_allclose(turning[:, along], MOTION.speed + MOTION.velocity)
    assert np.count_nonzero(turning.any(axis=0)) == 1


def test_a_minus_turns_the_sensor_around():
    plain = read(radius=0.5)
    turned = read(radius=0.5, imu_axis="-y")
    for one, other in zip(plain, turned, strict=True):
        np.testing.assert_allclose(one * [1.0, -1.0, -1.0], other)


def test_gravity_is_felt_in_the_plane_of_motion_where_it_loads_the_joint():
    """At rest the specific force is 1 g whatever the angle, and its tangential part is largest where the torque is."""
    around = Surroundings(gravity=3.0, gravity_angle=0.7)
    slow = SpeedProgramme(times=[0.0, 1.0], speeds=[60.0, 60.0])
    rig = Rig(ParametricModel(), slow, rate=50.0, surroundings=around)
    motion = rig.advance(4000)
    force, _ = read(motion, 0.0 * motion.times, radius=0.0, surroundings=around)
    np.testing.assert_allclose(np.linalg.norm(force, axis=1), 9.80665)
    assert not force[:, 2].any()
    torque = rig.torque(motion.times) - 10.0
    np.testing.assert_allclose(force[:, 1], -9.80665 * torque / 3.0, atol=1e-9)


def test_a_joint_that_only_the_payload_loads_lies_the_same_way():
    readings = [read(surroundings=around) for around in (Surroundings(gravity=3.0), Surroundings(payload=3.0))]
    np.testing.assert_array_equal(readings[0][0], readings[1][0])


def test_turning_by_gravity_has_the_sense_of_the_motion():
    """As the link turns by dq, gravity turns by -dq seen from it: d(force)/dq is force turned by a right angle."""
    around = Surroundings(gravity=3.0)
    motion = Rig(ParametricModel(), SpeedProgramme(times=[0.0, 1.0], speeds=[60.0, 60.0]), rate=1000.0).advance(2000)
    force, _ = read(motion, 0.0 * motion.times, radius=0.0, surroundings=around)
    slope = np.gradient(force, motion.angle, axis=0)[1:-1]
    np.testing.assert_allclose(slope[:, 0], force[1:-1, 1], atol=1e-4)
    np.testing.assert_allclose(slope[:, 1], -force[1:-1, 0], atol=1e-4)


def test_axes_leak_into_each_other():
    plain, leaky = read().force, read(cross_axis=0.02).force
    for axis in range(3):
        others = np.delete(plain, axis, axis=1).sum(axis=1)
        np.testing.assert_allclose(leaky[:, axis], plain[:, axis] + 0.02 * others, atol=1e-12)


def test_the_gain_scales_gravity_and_centripetal_force_like_the_samples():
    right, wrong = read(), read(samples=-1.1 * SAMPLES, gain=-1.1)
    np.testing.assert_allclose(wrong.force, -1.1 * right.force, rtol=1e-12)
    np.testing.assert_array_equal(wrong.turning, right.turning)


def test_a_dead_imu_feels_nothing():
    readings = read(samples=0.0 * SAMPLES, fault=FaultSettings(fault="dead", fault_after=0.2))
    assert readings.force[:200].any(axis=1).all()
    for values in readings:
        assert not values[200:].any()


def test_a_stuck_imu_repeats_all_its_axes():
    around = Surroundings(gravity=3.0)
    plain, stuck = (
        read(surroundings=around),
        read(surroundings=around, fault=FaultSettings(fault="stuck", fault_after=0.2)),
    )
    for one, other in zip(plain, stuck, strict=True):
        np.testing.assert_array_equal(one[:200], other[:200])
        np.testing.assert_array_equal(other[200:], np.tile(one[199], (300, 1)))

"""The virtual joint reports what the output does, at a rate of its own."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle import table_1

from hd_monitor.model import Torque
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.surroundings import Surroundings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.effort import EffortSettings
from hd_sim_node.sensing.joint import Joint, JointSettings

PROGRAMME = SpeedProgramme(times=[0.0, 2.0], speeds=[300.0, 900.0], cycles=1)
MODEL = table_1(torque=Torque(mean=10.0, drive_fluctuation=1.0, load_fluctuation=4.0))


def report(*, rate=1000.0, count=2000, seed=0, **values):
    efforts = {name: values.pop(name) for name in list(values) if name.startswith("effort")}
    rig = Rig(MODEL, PROGRAMME, rate=rate, start_angle=0.2, surroundings=Surroundings(gravity=2.0))
    joint = Joint(rig, JointSettings(**values), EffortSettings(**efforts), seed=seed)
    return rig, joint.report(rig.advance(count))


def test_reports_angle_and_speed_of_the_output():
    rig, batch = report(rate=1000.0)
    assert len(batch) == 200
    np.testing.assert_allclose(batch.times, np.arange(200) / 100.0)
    np.testing.assert_array_equal(batch.stamps, np.arange(200) * 10_000_000)
    np.testing.assert_allclose(batch.position, rig.angle(batch.times), rtol=1e-14)
    np.testing.assert_allclose(batch.velocity, rig.speed(batch.times), rtol=1e-14)


@settings(max_examples=25)
@given(
    st.lists(st.integers(1, 300), min_size=1, max_size=8),
    st.floats(0.7, 3000.0),
    st.sampled_from([97.0, 1000.0, 3333.3]),
)
def test_every_instant_is_reported_once_however_it_is_cut(cuts, joint_rate, rate):
    rig = Rig(MODEL, PROGRAMME, rate=rate)
    joint = Joint(rig, JointSettings(rate=joint_rate))
    times = np.concatenate([joint.report(rig.advance(count)).times for count in cuts])
    expected = np.arange(times.size) / joint_rate
    np.testing.assert_array_equal(times, expected)
    assert times.size == pytest.approx(sum(cuts) / rate * joint_rate, abs=1.0)


def test_a_reversed_joint_counts_backwards():
    _, plain = report()
    _, reverse = report(reversed=True)
    for one, other in zip(plain[2:], reverse[2:], strict=True):
        np.testing.assert_array_equal(one, -other)


def test_position_is_a_multiple_of_the_resolution():
    _, batch = report(resolution=1e-3)
    np.testing.assert_allclose(batch.position / 1e-3, np.round(batch.position / 1e-3), atol=1e-9)
    _, fine = report()
    assert np.abs(batch.position - fine.position).max() <= 0.5e-3 * (1 + 1e-9)


def test_an_encoder_behind_the_reducer_sees_the_vibration():
    rig, batch = report(side="output", rate=1000.0, count=2000)
    same = Rig(MODEL, PROGRAMME, rate=1000.0, start_angle=0.2, surroundings=Surroundings(gravity=2.0)).advance(2000)
    np.testing.assert_allclose(batch.position - rig.angle(batch.times), same.displacement[::10], atol=1e-12)
    np.testing.assert_allclose(batch.velocity - rig.speed(batch.times), same.velocity[::10], atol=1e-12)


def test_a_wrapped_position_is_the_same_angle_between_minus_pi_and_pi():
    _, plain = report(count=2000, reversed=True)
    _, wrapped = report(count=2000, reversed=True, wrapped=True)
    rig = Rig(MODEL, SpeedProgramme(times=[0.0, 2.0], speeds=[3000.0, 3000.0]), rate=1000.0)
    turning = Joint(rig, JointSettings(wrapped=True, rate=1000.0)).report(rig.advance(6000))
    truth = rig.angle(turning.times)
    assert truth[-1] > 3 * np.pi
    for true, position in ((plain.position, wrapped.position), (truth, turning.position)):
        assert np.all((position >= -np.pi) & (position < np.pi))
        np.testing.assert_allclose(np.exp(1j * position), np.exp(1j * true), atol=1e-9)


def test_a_reversed_velocity_contradicts_the_position():
    _, batch = report(velocity="reversed")
    rig, _ = report()
    np.testing.assert_array_equal(batch.velocity, -rig.speed(batch.times))


def test_a_zero_velocity_is_zero_whatever_the_noise():
    _, batch = report(velocity="zero", velocity_noise=1.0)
    assert batch.velocity.shape == batch.times.shape
    assert not batch.velocity.any()


def test_a_filtered_velocity_follows_the_low_passs_equation():
    """For a ramp from v0 with slope a, the low-pass starting at v0 gives v0 + a (t - T (1 - exp(-t/T)))."""
    rig, batch = report(velocity="filtered", velocity_time_constant=0.3, rate=1000.0)
    start, slope = rig.speed(0.0), (rig.speed(1.0) - rig.speed(0.0)) / 1.0
    t = batch.times
    np.testing.assert_allclose(batch.velocity, start + slope * (t - 0.3 * (1.0 - np.exp(-t / 0.3))), rtol=1e-10)


@settings(max_examples=25)
@given(st.lists(st.integers(1, 200), min_size=1, max_size=8), st.floats(0.7, 2000.0), st.floats(1e-4, 10.0))
def test_a_filtered_velocity_does_not_depend_on_the_cuts(cuts, joint_rate, time_constant):
    settings = JointSettings(rate=joint_rate, velocity="filtered", velocity_time_constant=time_constant)

    def velocities(pieces):
        rig = Rig(MODEL, PROGRAMME, rate=1000.0)
        joint = Joint(rig, settings)
        return np.concatenate([joint.report(rig.advance(count)).velocity for count in pieces])

    np.testing.assert_allclose(velocities(cuts), velocities([sum(cuts)]), rtol=1e-12)


def test_late_stamps_leave_the_values_alone():
    _, plain = report()
    _, late = report(delay=0.012)
    np.testing.assert_array_equal(late.stamps - plain.stamps, 12_000_000)
    np.testing.assert_array_equal(late.position, plain.position)


def test_what_is_not_reported_is_absent():
    _, batch = report(effort="none", velocity="missing")
    assert batch.effort is None
    assert batch.velocity is None


@pytest.mark.parametrize(
    ("field", "quantity", "size"),
    [("velocity_noise", "velocity", 0.01), ("effort_noise", "effort", 0.5), ("jitter", "stamps", 1e-3)],
)
def test_noise_has_its_standard_deviation(field, quantity, size):
    count = 20_000
    clean = getattr(report(rate=100.0, count=count)[1], quantity)
    noisy = getattr(report(rate=100.0, count=count, **{field: size})[1], quantity)
    error = (noisy - clean) * (1e-9 if quantity == "stamps" else 1.0)
    assert error.std() == pytest.approx(size, rel=4 / np.sqrt(2 * count))
    assert error.mean() == pytest.approx(0.0, abs=4 * size / np.sqrt(count))


def test_settings_may_change_while_it_runs():
    rig = Rig(MODEL, PROGRAMME, rate=1000.0)
    joint = Joint(rig, JointSettings())
    assert joint.report(rig.advance(500)).effort is not None
    joint.effort.settings = EffortSettings(effort="none")
    joint.settings = replace(joint.settings, velocity="zero")
    batch = joint.report(rig.advance(500))
    assert batch.effort is None
    assert batch.velocity is not None
    assert not batch.velocity.any()

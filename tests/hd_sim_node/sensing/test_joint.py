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
from hd_sim_node.sensing.joint import Joint, JointSettings

PROGRAMME = SpeedProgramme(times=[0.0, 2.0], speeds=[300.0, 900.0], cycles=1)
MODEL = table_1(torque=Torque(mean=10.0, drive_fluctuation=1.0, load_fluctuation=4.0))


def report(settings=None, *, rate=1000.0, count=2000, seed=0, **values):
    rig = Rig(MODEL, PROGRAMME, rate=rate, start_angle=0.2, surroundings=Surroundings(gravity=2.0))
    joint = Joint(rig, settings or JointSettings(**values), seed=seed)
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


def test_the_transmitted_effort_is_the_torque_without_the_drives_ripple():
    rig, batch = report(effort="transmitted")
    q = rig.angle(batch.times)
    np.testing.assert_allclose(batch.effort, 10.0 + 4.0 * np.cos(2 * q) + 2.0 * np.cos(q), rtol=1e-12)


def test_the_mean_effort_is_constant():
    _, batch = report(effort="mean")
    np.testing.assert_array_equal(batch.effort, 10.0)


def test_the_reaction_carries_the_vibration():
    rig, batch = report(effort="reaction")
    vibration = batch.effort - rig.torque(batch.times)
    same = Rig(MODEL, PROGRAMME, rate=1000.0, start_angle=0.2, surroundings=Surroundings(gravity=2.0)).advance(2000)
    np.testing.assert_allclose(vibration, -0.29 * same.acceleration[::10], atol=1e-9)


def test_what_is_not_reported_is_absent():
    _, batch = report(effort="none", velocity=False)
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
    joint.settings = replace(joint.settings, effort="none")
    assert joint.report(rig.advance(500)).effort is None

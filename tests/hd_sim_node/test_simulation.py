"""The stream of messages: every sample once, at its time, in both forms, reproducible and changeable."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor import contract
from hd_monitor.errors import ParameterError
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

BASE = {"programme": "fixed", "fixed.speed": 1600.0, "duration": 2.0, "sensor.noise": 0.0}


def simulate(**changes):
    given = BASE | {name.replace("__", "."): value for name, value in changes.items()}
    return Simulation(RigSettings.from_mapping(given))


def messages(simulation):
    return [message for stretch in simulation for message in stretch.schedule()]


def test_publishes_every_sample_in_blocks_and_one_by_one():
    stretches = list(simulate(publish="both", block_size=40))
    samples = np.concatenate([s.samples for s in stretches])
    blocks = [block for s in stretches for block in s.blocks]
    assert samples.size == 2000
    np.testing.assert_array_equal(np.concatenate([block.samples for block in blocks]), samples)
    assert [block.sequence for block in blocks] == list(range(50))
    assert [block.stamp for block in blocks] == [n * 40_000_000 for n in range(50)]
    assert {block.period for block in blocks} == {1e-3}


def test_messages_go_out_in_order_and_when_their_newest_sample_is_there():
    sent = messages(simulate(publish="both", publish_imu=True, block_size=50))
    dues = [due for due, _, _ in sent]
    assert dues == sorted(dues)
    first_block = next(due for due, topic, _ in sent if topic == contract.TORSIONAL_ACCELERATION_BLOCK)
    assert first_block == 49_000_000
    counts = {topic: sum(t == topic for _, t, _ in sent) for topic in {t for _, t, _ in sent}}
    assert counts == {
        contract.TORSIONAL_ACCELERATION_BLOCK: 40,
        contract.TORSIONAL_ACCELERATION: 2000,
        contract.IMU: 2000,
        contract.JOINT_STATES: 200,
    }


@pytest.mark.parametrize(
    ("publish", "imu", "topics"),
    [
        ("block", False, {contract.TORSIONAL_ACCELERATION_BLOCK}),
        ("samples", False, {contract.TORSIONAL_ACCELERATION}),
        ("none", True, {contract.IMU}),
        ("none", False, set()),
    ],
)
def test_publishes_the_selected_form_and_always_joint_states(publish, imu, topics):
    assert set(simulate(publish=publish, publish_imu=imu).topics) == topics | {contract.JOINT_STATES}


@pytest.mark.parametrize("block_size", [1, 7, 50, 999, 2500])
def test_the_block_size_does_not_change_the_samples(block_size):
    plain = np.concatenate([s.samples for s in simulate(sensor__noise=0.2, seed=3)])
    other = np.concatenate(
        [s.samples for s in simulate(sensor__noise=0.2, seed=3, block_size=block_size, duration=3.0)]
    )
    common = min(plain.size, other.size)
    np.testing.assert_allclose(other[:common], plain[:common], atol=1e-9)


SENSORS = st.fixed_dictionaries(
    {
        "sensor__noise": st.floats(0.0, 1.0),
        "sensor__spike_rate": st.floats(0.0, 20.0),
        "sensor__bandwidth": st.sampled_from([0.0, 20.0, 150.0, 450.0]),
        "sensor__filter_order": st.integers(1, 8),
        "sensor__gain": st.floats(-2.0, 2.0),
        "sensor__cross_axis": st.floats(-0.1, 0.1),
        "sensor__imu_axis": st.sampled_from(["x", "-y"]),
        "sensor__clock_offset": st.floats(-1.0, 1.0),
        "sensor__clock_drift": st.floats(-200.0, 200.0),
        "sensor__jitter": st.floats(0.0, 1e-3),
        "sensor__fifo": st.integers(1, 300),
        "sensor__fault": st.sampled_from(["none", "dead", "stuck", "dying"]),
        "sensor__fault_after": st.floats(0.0, 1.0),
        "sensor__fault_time": st.floats(0.1, 2.0),
        "joint_states__rate": st.floats(10.0, 1000.0),
        "joint_states__side": st.sampled_from(["motor", "output"]),
        "joint_states__reversed": st.booleans(),
        "joint_states__wrapped": st.booleans(),
        "joint_states__velocity": st.sampled_from(["reported", "zero", "reversed", "filtered"]),
        "joint_states__velocity_time_constant": st.floats(1e-3, 1.0),
        "joint_states__velocity_noise": st.floats(0.0, 0.1),
        "joint_states__jitter": st.floats(0.0, 1e-3),
        "joint_states__delay": st.floats(-0.1, 0.1),
        "joint_states__effort": st.sampled_from(["transmitted", "mean", "reaction"]),
        "joint_states__effort_rate": st.just(0.0) | st.floats(0.1, 300.0),
        "joint_states__effort_noise": st.floats(0.0, 1.0),
        "torque__gravity": st.sampled_from([0.0, 3.0]),
    }
)


@settings(max_examples=60)
@given(SENSORS, st.integers(1, 600))
def test_stretches_do_not_change_what_any_sensor_puts_out(sensors, block_size):
    def readings(size):
        stretches = list(simulate(publish_imu=True, seed=3, block_size=size, duration=1.3, **sensors))
        return (
            np.concatenate([np.column_stack([s.samples, s.stamps, *s.imu]) for s in stretches]),
            np.concatenate([np.column_stack(s.joint[1:]) for s in stretches]),
        )

    for one, other in zip(readings(50), readings(block_size), strict=True):
        common = min(len(one), len(other))
        assert common > 5
        np.testing.assert_allclose(other[:common], one[:common], rtol=1e-9, atol=1e-8)


def test_the_block_tells_the_period_that_the_sensors_clock_believes():
    blocks = [block for s in simulate(sensor__clock_drift=100.0, sensor__clock_offset=5.0) for block in s.blocks]
    assert [block.period for block in blocks] == pytest.approx([1.0001e-3] * 40, rel=1e-12)
    assert [block.stamp for block in blocks] == [5_000_000_000 + n * 50_005_000 for n in range(40)]


def test_a_fifo_bunches_samples_and_leaves_blocks_alone():
    given = {"publish": "both", "publish_imu": True, "duration": 1.0}
    plain, bunched = simulate(**given), simulate(sensor__fifo=50, **given)
    for one, other in zip(plain, bunched, strict=True):
        assert [block.stamp for block in other.blocks] == [block.stamp for block in one.blocks]
        block = contract.TORSIONAL_ACCELERATION_BLOCK
        np.testing.assert_array_equal(other.dispatch[block], one.dispatch[block])
        for topic in (contract.TORSIONAL_ACCELERATION, contract.IMU):
            due, row = other.dispatch[topic]
            assert row.tolist() == list(range(len(other.samples)))
            np.testing.assert_array_equal(due[:49], other.stamps[:49])
            assert np.all(np.diff(due) >= 0)
            assert np.all(due >= one.dispatch[topic].due)


def test_a_half_full_fifo_is_sent_with_its_stretch():
    stretches = list(simulate(publish="samples", sensor__fifo=4096, duration=1.0))
    sent = [row for s in stretches for row in s.dispatch[contract.TORSIONAL_ACCELERATION].row]
    assert len(sent) == 1000
    assert stretches[-1].stamps[0] == 4_095_000_000 + 750 * 100_000


def test_the_bandwidth_takes_from_the_samples_and_not_from_the_motion_or_the_joint():
    plain, narrow = (list(simulate(sensor__bandwidth=b, joint_states__side="output")) for b in (0.0, 5.0))
    for one, other in zip(plain, narrow, strict=True):
        np.testing.assert_allclose(other.motion.times, one.motion.times, rtol=1e-14)
        np.testing.assert_allclose(other.motion.acceleration, one.motion.acceleration, atol=1e-4)
        np.testing.assert_allclose(other.joint.position, one.joint.position, atol=1e-8)
    settled = [np.concatenate([s.samples for s in run])[1000:] for run in (plain, narrow)]
    assert settled[1].std() < 0.05 * settled[0].std()


def test_ends_with_the_programme_in_whole_blocks():
    assert sum(s.samples.size for s in simulate(duration=0.777, block_size=50)) == 750
    assert sum(s.samples.size for s in simulate(duration=0.01, block_size=50)) == 50
    simulation = simulate(duration=0.0, cycles=2, fixed__time=0.5)
    assert sum(s.samples.size for s in simulation) == 1000
    assert simulation.advance() is None


def test_a_programme_without_end_continues():
    simulation = simulate(duration=0.0)
    for _ in range(20):
        assert simulation.advance() is not None


def test_rounding_does_not_lose_the_last_block():
    """0.3 s at 1 kHz is 299.99… samples in floating point."""
    assert sum(s.samples.size for s in simulate(duration=0.3, block_size=100)) == 300


def test_loss_shows_in_what_is_sent_not_in_the_sequence_numbers():
    simulation = simulate(transport__loss=0.3, duration=20.0, seed=1)
    sequences = [
        stretch.blocks[row].sequence
        for stretch in simulation
        for _, topic, row in stretch.schedule()
        if topic == contract.TORSIONAL_ACCELERATION_BLOCK
    ]
    assert sequences == sorted(set(sequences))
    assert len(sequences) / 400 == pytest.approx(0.7, abs=4 * math.sqrt(0.21 / 400))


def test_joint_states_are_lost_by_their_own_rate():
    sent = messages(simulate(joint_states__loss=0.5, transport__loss=0.0, duration=10.0))
    assert sum(topic == contract.TORSIONAL_ACCELERATION_BLOCK for _, topic, _ in sent) == 200
    assert 400 < sum(topic == contract.JOINT_STATES for _, topic, _ in sent) < 600


def test_the_same_seed_gives_the_same_messages():
    def fingerprint(seed):
        return [
            (stretch.samples.tobytes(), stretch.stamps.tobytes(), list(stretch.schedule()))
            for stretch in simulate(
                seed=seed, sensor__noise=1.0, sensor__jitter=1e-4, transport__loss=0.1, transport__late=0.1
            )
        ]

    assert fingerprint(5) == fingerprint(5)
    assert fingerprint(5) != fingerprint(6)


def test_message_rates_are_those_of_the_topics():
    simulation = simulate(publish="both", sensor__rate=2000.0, block_size=50, joint_states__rate=125.0)
    rates = {topic: simulation.message_rate(topic) for topic in simulation.topics}
    assert rates == {
        contract.TORSIONAL_ACCELERATION_BLOCK: 40.0,
        contract.TORSIONAL_ACCELERATION: 2000.0,
        contract.JOINT_STATES: 125.0,
    }


class TestChanges:
    def test_a_defect_may_appear_while_it_runs(self):
        simulation = simulate(defect="none", duration=8.0)
        before = np.concatenate([s.samples for _, s in zip(range(16), simulation, strict=False)])
        simulation.change(RigSettings.from_mapping(BASE | {"defect": "flexspline", "duration": 8.0}))
        after = np.concatenate([s.samples for s in simulation])
        assert after.size == 8000 - before.size
        assert after[-1500:].std() > 3 * before[-1500:].std()

    def test_the_motion_carries_on(self):
        simulation = simulate(duration=1.0)
        first = simulation.advance()
        simulation.change(RigSettings.from_mapping(BASE | {"torque.mean": 20.0, "duration": 1.0}))
        second = simulation.advance()
        assert first is not None
        assert second is not None
        step = second.motion.angle[0] - first.motion.angle[-1]
        assert step == pytest.approx(first.motion.angle[1] - first.motion.angle[0], rel=1e-9)

    def test_noise_and_transport_change_too(self):
        simulation = simulate(duration=10.0, defect="custom")
        simulation.advance()
        changed = {"defect": "custom", "sensor.noise": 2.0, "transport.loss": 1.0, "joint_states.effort": "none"}
        simulation.change(RigSettings.from_mapping(BASE | changed))
        stretch = simulation.advance()
        assert stretch is not None
        assert stretch.samples.std() == pytest.approx(2.0, rel=0.3)
        assert stretch.dispatch[contract.TORSIONAL_ACCELERATION_BLOCK].row.size == 0
        assert stretch.dispatch[contract.JOINT_STATES].row.size > 0
        assert stretch.joint.effort is None

    def test_a_sensor_may_fail_and_recover_while_it_runs(self):
        simulation = simulate(publish_imu=True)
        stretches = [simulation.advance()]
        for fault in ("stuck", "none"):
            simulation.change(RigSettings.from_mapping(BASE | {"sensor.fault": fault, "publish_imu": True}))
            stretches.append(simulation.advance())
        before, stuck, after = (np.column_stack([s.samples, *s.imu]) for s in stretches)
        assert np.all(stuck == before[-1])
        assert np.unique(after[:, 0]).size == len(after)

    def test_a_refused_change_changes_nothing(self):
        simulation = simulate(fixed__speed=3300.0)
        before = simulation.settings
        wild = BASE | {"fixed.speed": 3300.0, "defect": "custom", "circular_spline.beta": [0.14]}
        with pytest.raises(ParameterError, match="unstable at 3300 rpm"):
            simulation.change(RigSettings.from_mapping(wild))
        assert simulation.settings is before


WILD = {"fixed__speed": 3300.0, "defect": "custom", "circular_spline__beta": [0.14]}


class TestStability:
    def test_an_unstable_rig_is_refused(self):
        with pytest.raises(ParameterError, match="unstable at 3300 rpm"):
            simulate(**WILD)

    def test_an_unstable_rig_can_run_with_a_warning(self):
        simulation = simulate(**WILD, unstable="warn")
        assert "3300 rpm" in simulation.warning
        assert simulation.advance() is not None

    def test_an_unstable_rig_can_run_without_a_warning(self):
        assert simulate(**WILD, unstable="ignore").warning == ""

    def test_a_stable_one_has_no_warning(self):
        assert simulate(unstable="warn").warning == ""

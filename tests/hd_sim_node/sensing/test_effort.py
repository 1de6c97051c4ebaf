"""The joint's driver reports a torque of which it knows this or that, as often and as well as it can."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle import table_1

from hd_monitor.model import Torque
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.surroundings import Surroundings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.effort import EffortGauge, EffortSettings

PROGRAMME = SpeedProgramme(times=[0.0, 2.0], speeds=[300.0, 900.0], cycles=1)
MODEL = table_1(torque=Torque(mean=10.0, drive_fluctuation=1.0, load_fluctuation=4.0))
TIMES = np.arange(200) / 100.0


def new_rig():
    return Rig(MODEL, PROGRAMME, rate=1000.0, start_angle=0.2, surroundings=Surroundings(gravity=2.0))


def report(*, sign=1.0, **values):
    rig = new_rig()
    return rig, EffortGauge(rig, EffortSettings(**values)).report(rig.advance(2000), TIMES, sign=sign)


def test_the_transmitted_effort_is_the_torque_without_the_drives_ripple():
    rig, effort = report(effort="transmitted")
    q = rig.angle(TIMES)
    np.testing.assert_allclose(effort, 10.0 + 4.0 * np.cos(2 * q) + 2.0 * np.cos(q), rtol=1e-12)


def test_the_mean_effort_is_constant():
    _, effort = report(effort="mean")
    np.testing.assert_array_equal(effort, 10.0)


def test_the_reaction_carries_the_vibration():
    rig, effort = report(effort="reaction")
    np.testing.assert_allclose(
        effort - rig.torque(TIMES), -0.29 * new_rig().advance(2000).acceleration[::10], atol=1e-9
    )


def test_no_effort_is_none():
    assert report(effort="none")[1] is None


def test_scale_and_bias_act_on_the_true_effort():
    _, true = report()
    _, wrong = report(effort_scale=0.8, effort_bias=1.5, sign=-1.0)
    np.testing.assert_allclose(wrong, -0.8 * true + 1.5, rtol=1e-12)


@pytest.mark.parametrize("kind", ["transmitted", "reaction"])
def test_a_slow_measurement_is_held_until_the_next(kind):
    _, true = report(effort=kind)
    _, held = report(effort=kind, effort_rate=20.0)
    np.testing.assert_allclose(held, np.repeat(true[::5], 5), rtol=1e-9)


def test_noise_is_held_with_the_measurement():
    _, held = report(effort="mean", effort_noise=0.5, effort_rate=20.0)
    assert np.unique(held).size == 40


@settings(max_examples=25)
@given(
    st.lists(st.integers(1, 300), min_size=1, max_size=8),
    st.floats(0.5, 300.0),
    st.sampled_from(["transmitted", "reaction"]),
)
def test_cuts_do_not_change_what_is_held(cuts, effort_rate, kind):
    chosen = EffortSettings(effort=kind, effort_rate=effort_rate, effort_noise=0.3)

    def efforts(pieces):
        rig = new_rig()
        gauge, begun, got = EffortGauge(rig, chosen, seed=2), 0, []
        for count in pieces:
            effort = gauge.report(rig.advance(count), np.arange(begun, begun + count) / 1000.0)
            assert effort is not None
            got.append(effort)
            begun += count
        return np.concatenate(got)

    np.testing.assert_allclose(efforts(cuts), efforts([sum(cuts)]), rtol=1e-9)


def test_before_the_first_measurement_the_effort_is_unknown():
    rig = new_rig()
    gauge = EffortGauge(rig, EffortSettings(effort="none"))
    gauge.report(rig.advance(100), TIMES[:10])
    gauge.settings = EffortSettings(effort_rate=5.0)
    effort = gauge.report(rig.advance(200), TIMES[10:30])
    assert effort is not None
    assert np.isnan(effort[:10]).all()
    assert np.isfinite(effort[10:]).all()

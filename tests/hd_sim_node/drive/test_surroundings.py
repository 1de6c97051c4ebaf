"""What acts from outside is what the parameters say: gravity, payload, inertia and the motor's ripple."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from tests.oracle import MODEL

from hd_monitor.errors import ParameterError
from hd_monitor.model import ParametricModel, Torque
from hd_sim_node.drive.effects import Effects
from hd_sim_node.drive.elasticity import Hysteresis
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.surroundings import ChangingInertia, Motion, MotorRipple, Surroundings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.motion.programmes import build_programme
from hd_sim_node.settings import RigSettings

INERTIA = 0.29
TIMES = np.linspace(0.0, 10.0, 4001)


def motion(times=TIMES, carried=0.0):
    """Some smooth motion: what acts depends on the angle and its derivatives as given."""
    angle = 2.0 * np.sin(0.7 * times)
    return Motion(
        times=times,
        angle=angle,
        speed=1.4 * np.cos(0.7 * times),
        acceleration=-0.98 * np.sin(0.7 * times),
        turn=80.0 * angle,
        carried=carried,
    )


def test_nothing_acts_unless_given():
    around = Surroundings()
    assert around.torque(motion(), INERTIA) == 0.0
    assert around.inertia_factor(motion()) == 1.0


def test_the_models_own_torque_comes_through():
    own = np.cos(TIMES)
    np.testing.assert_array_equal(Surroundings().torque(motion(), INERTIA, own=own), own)
    around = Surroundings(gravity=2.0, ripple=MotorRipple(ripple=(0.3, 0.2, 0.1)))
    np.testing.assert_allclose(
        around.torque(motion(), INERTIA, own=own), own + around.torque(motion(), INERTIA), atol=1e-12
    )


def test_the_payload_weighs_while_it_is_carried():
    carried = np.clip(TIMES - 4.0, 0.0, 1.0)
    around = Surroundings(gravity=3.0, gravity_angle=0.4, payload=5.0)
    m = motion(carried=carried)
    np.testing.assert_allclose(around.torque(m, INERTIA), (3.0 + 5.0 * carried) * np.cos(m.angle - 0.4), atol=1e-12)
    alone = Surroundings(payload=5.0)
    assert alone.torque(motion(), INERTIA) == pytest.approx(0.0)
    assert np.abs(alone.torque(m, INERTIA)).max() > 4.0


@given(
    st.lists(st.tuples(st.floats(0.0, 5.0), st.floats(0.1, 50.0), st.floats(-3.0, 3.0)), min_size=1, max_size=5),
    st.booleans(),
)
def test_ripple_is_a_sum_of_waves_over_the_motors_angle(waves, drive):
    amplitudes, orders, phases = map(tuple, zip(*waves, strict=True))
    ripple = MotorRipple(ripple=amplitudes, ripple_orders=orders, ripple_phase=phases)
    expected = sum(m * np.cos(order * motion().turn + phase) for m, order, phase in waves) if drive else 0.0
    torque = Surroundings(ripple=ripple).torque(motion(), INERTIA, drive=drive)
    np.testing.assert_allclose(np.broadcast_to(torque, TIMES.shape), expected + 0.0 * TIMES, atol=1e-9)
    assert ripple.highest_order == max((order for m, order, _ in waves if m), default=0.0)


def test_ripple_of_order_two_is_the_papers_drive_fluctuation():
    programme = SpeedProgramme(times=[0.0, 2.0], speeds=[600.0, 900.0], cycles=1)
    papers = ParametricModel(torque=Torque(mean=10.0, drive_fluctuation=1.5, drive_phase=0.3))
    around = Surroundings(ripple=MotorRipple(ripple=(1.5,), ripple_orders=(2.0,), ripple_phase=(0.3,)))
    one = Rig(papers, programme, rate=1000.0, start_angle=0.2)
    other = Rig(ParametricModel(), programme, rate=1000.0, start_angle=0.2, surroundings=around)
    np.testing.assert_allclose(one.torque(TIMES), other.torque(TIMES), atol=1e-9)
    np.testing.assert_allclose(other.torque(TIMES, drive=False), 10.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("given_values", "match"),
    [
        ({"torque.ripple": [1.0]}, "1 amplitudes and torque.ripple_orders 3 orders"),
        ({"torque.ripple_orders": [2.0]}, "3 amplitudes and torque.ripple_orders 1 orders"),
        ({"torque.ripple_phase": [0.1, 0.2, 0.3, 0.4]}, "4 phases for 3 amplitudes"),
    ],
)
def test_lists_that_do_not_match_are_refused(given_values, match):
    with pytest.raises(ParameterError, match=match):
        RigSettings.from_mapping(given_values)


@given(st.floats(-0.9, 0.0), st.floats(0.0, 3.0), st.floats(0.5, 20.0))
def test_the_inertia_swings_between_its_bounds_from_its_value_at_the_start(lowest, highest, period):
    inertia = ChangingInertia(lowest=lowest, highest=highest, period=period)
    assert inertia.factor(np.zeros(1), 0.0) == pytest.approx(1.0, abs=1e-9)
    times = np.linspace(0.0, period, 2001)
    factor = np.broadcast_to(inertia.factor(times, 0.0), times.shape)
    assert factor.min() == pytest.approx(1.0 + lowest, abs=1e-5)
    assert factor.max() == pytest.approx(1.0 + highest, abs=1e-5)
    np.testing.assert_allclose(np.broadcast_to(inertia.factor(times + period, 0.0), times.shape), factor, atol=1e-9)
    assert factor[1] >= factor[0] - 1e-5  # rising
    assert np.abs(np.diff(factor)).max() <= 0.5 * (highest - lowest) * math.tau / 2000 * (1.0 + 1e-6) + 1e-12


def test_the_payload_adds_its_inertia():
    carried = np.clip(TIMES - 4.0, 0.0, 1.0)
    inertia = ChangingInertia(lowest=-0.3, highest=0.5, payload=0.2)
    np.testing.assert_allclose(inertia.factor(TIMES, carried) - inertia.factor(TIMES, 0.0), 0.2 * carried, atol=1e-12)


def test_the_motion_is_held_back_by_the_inertia_of_the_moment():
    around = Surroundings(rigid_body=True, inertia=ChangingInertia(lowest=-0.3, highest=0.5))
    expected = -INERTIA * around.inertia_factor(motion()) * motion().acceleration
    np.testing.assert_allclose(around.torque(motion(), INERTIA), expected, atol=1e-12)


def test_settings_reach_the_surroundings():
    around = RigSettings.from_mapping(
        {
            "torque.gravity": 3.0,
            "torque.gravity_angle": 90.0,
            "torque.payload": 4.0,
            "torque": {"ripple": [0.5], "ripple_orders": [12.0]},
            "inertia": {"lowest": -0.3, "highest": 0.5, "period": 2.5, "payload": 0.1},
        }
    ).surroundings
    assert around == Surroundings(
        gravity=3.0,
        gravity_angle=math.pi / 2.0,
        payload=4.0,
        ripple=MotorRipple(ripple=(0.5,), ripple_orders=(12.0,)),
        inertia=ChangingInertia(lowest=-0.3, highest=0.5, period=2.5, payload=0.1),
    )


def plain_equation(t, state, around, programme, output_acceleration):
    """θ' and θ'' of a joint that picks and places, written out."""
    dynamics, inertia = MODEL.dynamics, around.inertia
    omega = math.tau * dynamics.natural_frequency
    turn, carried = float(programme.angle(t)), float(programme.course(t).carried)
    angle = 0.2 + turn / 80.0
    torque = 10.0 + (3.0 + around.payload * carried) * math.cos(angle - 0.5)
    for amplitude, order, phase in zip(around.ripple.ripple, (2, 6, 12), (0.7, 0.0, 0.0), strict=True):
        torque += amplitude * math.cos(order * (turn + 16.0) + phase)
    moment = dynamics.inertia
    if inertia.highest:
        wave = math.sin(math.tau * t / inertia.period + math.asin(-0.25))  # from -30 % to +50 %
        moment *= 1.1 + 0.4 * wave + inertia.payload * carried
    if around.rigid_body:
        torque -= moment * output_acceleration
    damping = 2.0 * dynamics.damping_ratio * omega * state[1]
    restoring = omega**2 * (1.0 + float(MODEL.stiffness_fluctuation(angle))) * state[0]
    return state[1], (torque - dynamics.inertia * (damping + restoring)) / moment


@pytest.mark.parametrize(
    "given_values",
    [
        {"payload": 8.0},
        {"ripple": MotorRipple(ripple=(0.3, 0.2, 0.1), ripple_phase=(0.7,))},
        {"inertia": ChangingInertia(lowest=-0.3, highest=0.5, period=0.9, payload=0.2)},
        {"rigid_body": True},
        {
            "payload": 8.0,
            "ripple": MotorRipple(ripple=(0.3, 0.2, 0.1), ripple_phase=(0.7,)),
            "inertia": ChangingInertia(lowest=-0.3, highest=0.5, period=0.9, payload=0.2),
            "rigid_body": True,
        },
    ],
    ids=["payload", "ripple", "inertia", "rigid body", "all"],
)
def test_agrees_with_a_generic_solver(given_values):
    """From corner to corner, so that the generic solver meets smooth functions only."""
    programme = build_programme(
        "pick_and_place", {"pick_and_place.angle": 20.0, "pick_and_place.pick_pause": 0.2137}, MODEL.reducer
    )
    around = Surroundings(gravity=3.0, gravity_angle=0.5, **given_values)
    chunk = Rig(MODEL, programme, rate=1000.0, start_angle=0.2, surroundings=around).advance(1200)
    edges = np.append(programme.times[programme.times < chunk.times[-1]], chunk.times[-1])
    state = np.array([chunk.displacement[0], 0.0])
    expected: list[float] = []
    for start, end in pairwise(edges):
        rest = (around, programme, float(programme.acceleration(0.5 * (start + end))) / 80.0)
        inside = chunk.times[(chunk.times >= start) & (chunk.times < end)]
        times = np.append(inside, end)
        y = solve_ivp(plain_equation, (start, end), state, "DOP853", times, rtol=1e-11, atol=1e-16, args=rest).y
        expected += [plain_equation(t, x, *rest)[1] for t, x in zip(inside, y[:, :-1].T, strict=True)]
        state = y[:, -1]
    np.testing.assert_allclose(chunk.acceleration[:-1], expected, atol=1e-5 * np.abs(expected).max())


@pytest.mark.parametrize("effects", [Effects(), Effects(hysteresis=Hysteresis(torque=0.5))], ids=["scan", "march"])
def test_jumps_of_the_acceleration_do_not_depend_on_how_the_motion_is_cut(effects):
    """Corners lie at sampling instants, at the ends of stretches and anywhere between."""
    programme = SpeedProgramme(times=[0.0, 0.1, 0.2005, 0.3001, 0.4], speeds=[0.0, 900.0, 900.0, 0.0, 0.0])

    def rig():
        return Rig(MODEL, programme, rate=1000.0, surroundings=Surroundings(rigid_body=True), effects=effects)

    whole, streamed = rig().advance(1000), rig()
    joined = np.concatenate([streamed.advance(count).acceleration for count in (100, 100, 1, 99, 1, 199, 500)])
    np.testing.assert_allclose(joined, whole.acceleration, atol=1e-6 * np.abs(whole.acceleration).max())

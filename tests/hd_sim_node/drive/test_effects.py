"""Each effect of a real drive against the plain equation, its order of convergence, and closed forms."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.hd_sim_node.drive import plain

from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque
from hd_monitor.reducer import ARCMIN
from hd_sim_node.drive.effects import Effects, laws
from hd_sim_node.drive.elasticity import Elasticity, Hysteresis, characteristic
from hd_sim_node.drive.equation import State, march
from hd_sim_node.drive.friction import Friction
from hd_sim_node.drive.rig import Rig, advance_together
from hd_sim_node.drive.slow_change import DefectGrowth, Drift
from hd_sim_node.drive.surroundings import ChangingInertia, Surroundings
from hd_sim_node.drive.transmission_error import ErrorSeries, TransmissionErrors
from hd_sim_node.motion.programme import SpeedProgramme

BETA1, BETA2 = ((0.06, 0.03, 0.02), (0.3, 1.7, 5.1)), ((0.03, 0.015), (0.9, 2.1))
MODEL = ParametricModel(flexspline=StiffnessSeries(*BETA1), circular_spline=StiffnessSeries(*BETA2))
TURNING = SpeedProgramme(times=[0.0, 1.0], speeds=[850.0, 850.0])
FAST = SpeedProgramme(times=[0.0, 1.0], speeds=[2400.0, 2400.0])
REVERSING = SpeedProgramme(times=[0.0, 0.1, 0.3], speeds=[150.0, 0.0, -300.0], cycles=1)
ERRORS = TransmissionErrors(
    flexspline=ErrorSeries((0.5, 0.2, 0.1), (0.4, 1.1, 2.0)),
    circular_spline=ErrorSeries((0.3, 0.1), (1.9,)),
    wave_generator=ErrorSeries((0.2, 0.1, 0.05), (0.1, 0.2, 0.3)),
)
E = {
    "e1": ((0.5, 0.2, 0.1), (0.4, 1.1, 2.0)),
    "e2": ((0.3, 0.1), (1.9, 0.0)),
    "e0": ((0.2, 0.1, 0.05), (0.1, 0.2, 0.3)),
}
STEPS = Elasticity(ratios=(0.8, 1.0, 1.25), torques=(6.0, 12.0))
LOOP = Hysteresis(torque=0.5, twist=1.0)
RUBBING = Friction(coulomb=1.0, stribeck=0.5, stribeck_velocity=0.05, viscous=0.4)
WARM = Drift(natural_frequency=-0.1, damping_ratio=0.8, friction=-0.4, time=0.15)
GROWING = DefectGrowth(flexspline=2.0, circular_spline=0.5, start=0.0, length=0.5)
SWINGING = Surroundings(inertia=ChangingInertia(lowest=-0.3, highest=0.5, period=0.8), gravity=8.0)

CASES: dict[str, tuple[Effects, dict[str, Any]]] = {
    "transmission error": (Effects(errors=ERRORS), E),
    "steps of stiffness": (Effects(elasticity=STEPS), {"ratios": STEPS.ratios, "corners": STEPS.torques}),
    "hysteresis": (Effects(hysteresis=LOOP), {"loop": (0.5, 1.0)}),
    "friction": (Effects(friction=RUBBING), {"coulomb": 1.0, "stribeck": (0.5, 0.05), "viscous": 0.4}),
    "viscous friction": (Effects(friction=Friction(viscous=0.4)), {"viscous": 0.4}),
    "drift": (Effects(drift=WARM), {"drift": (-0.1, 0.8, -0.4, 0.15)}),
    "growth": (Effects(errors=ERRORS, growth=GROWING), E | {"growth": (2.0, 0.5, 0.0, 0.5)}),
}
EVERYTHING = Effects(errors=ERRORS, elasticity=STEPS, hysteresis=LOOP, friction=RUBBING, drift=WARM, growth=GROWING)
CASES["all together"] = (EVERYTHING, {key: value for _, terms in CASES.values() for key, value in terms.items()})


def worst(rig, count, solution):
    chunk = rig.advance(count)
    return np.abs(chunk.acceleration - solution[2]).max() / np.abs(solution[2]).max()


def reference(rig, count, **terms):
    times = np.arange(count) / rig.rate
    start = {"beta1": BETA1, "beta2": BETA2} | terms
    return plain.solve(lambda t: float(rig.angle(t)), lambda t: float(rig.speed(t)), times, **start)


@pytest.mark.parametrize("programme", [TURNING, FAST, REVERSING], ids=["turning", "fast", "reversing"])
@pytest.mark.parametrize("case", CASES)
def test_agrees_with_the_plain_equation(case, programme):
    effects, terms = CASES[case]
    rig = Rig(MODEL, programme, rate=500.0, start_angle=0.2, effects=effects)
    assert worst(rig, 150, reference(rig, 150, **terms)) <= 1e-5


@pytest.mark.parametrize(
    ("effects", "order"),
    [(replace(EVERYTHING, hysteresis=Hysteresis()), 3.95), (EVERYTHING, 2.75)],
    ids=["smooth", "with hysteresis"],
)
def test_order_of_convergence(effects, order):
    """Fourth order; third with hysteresis, on average: it depends on where in a step the twist reverses."""
    rig = Rig(MODEL, TURNING, rate=1000.0, start_angle=0.2, effects=effects)

    def run(steps):
        at = rig.coefficients(np.linspace(0.0, 0.3, 2 * steps + 1))
        rows = np.stack(np.broadcast_arrays(*at), axis=1).tolist()
        states = march(laws([(MODEL, effects)]), rows, [0.3 / steps] * steps, State(3e-4, 0.0))
        return np.array([state.displacement for state in states])[:: steps // 100]

    exact = run(25_600)
    first, *_, last = (np.sqrt(np.mean((run(steps) - exact) ** 2)) for steps in (800, 1600, 3200, 6400))
    assert math.log2(first / last) / 3 >= order


@pytest.mark.parametrize("k", [1, 2, 3])
@pytest.mark.parametrize("speed_rpm", [400.0, 1600.0])
def test_transmission_error_at_constant_speed_is_the_closed_form(k, speed_rpm):
    """Without stiffness fluctuation: θ = -(K + iωC)/(K - Jω² + iωC) e, a line of one frequency."""
    dynamics, size, phase = Dynamics(), 0.8, 0.7
    errors = TransmissionErrors(flexspline=ErrorSeries((0.0,) * (k - 1) + (size,), (0.0,) * (k - 1) + (phase,)))
    programme = SpeedProgramme(times=[0.0, 1.0], speeds=[speed_rpm, speed_rpm])
    rig = Rig(ParametricModel(torque=Torque(mean=0.0)), programme, rate=2000.0, effects=Effects(errors=errors))
    rig.advance(6000)  # settles: 3 s at 1/(ζωn) = 0.13 s
    chunk = rig.advance(2000)
    omega, natural = k * 2.025 * speed_rpm / 60 * math.tau, dynamics.angular_frequency
    damping = 2j * dynamics.damping_ratio * natural * omega
    gain = -(natural**2 + damping) / (natural**2 - omega**2 + damping)
    amplitude = -(omega**2) * gain * 0.5 * size * ARCMIN * np.exp(1j * phase)
    expected = (amplitude * np.exp(1j * omega * chunk.times)).real
    np.testing.assert_allclose(chunk.acceleration, expected, atol=1e-5 * abs(amplitude))


def test_the_hysteresis_loop_is_as_wide_as_stated():
    """A slow load there and back: 2T wide in torque at zero twist, and closed by a factor e over each length."""
    length = 1.0
    loop = Hysteresis(torque=0.5, twist=length)
    twists = (
        np.concatenate([np.linspace(0, 8, 4001), np.linspace(8, -8, 8001), np.linspace(-8, 8, 8001)]) * length * ARCMIN
    )
    law = laws([(MODEL, Effects(hysteresis=loop))])
    # A drive that is dragged along: the twist is prescribed by the error, with θ = 0 held by no force at all.
    rate = np.gradient(twists)
    rows = [[0.0, 0.0, 0.0, e, r, 0.0, 0.0, 0.0] for e, r in zip(twists, rate, strict=True)]
    states = march(law, rows, [2.0] * ((len(rows) - 1) // 2), State(0.0, 0.0))
    z, visited = np.array([state.hysteresis for state in states]), twists[::2]
    down, up = (slice(2000, 6001), slice(6000, 10_001))
    crossings = [np.interp(0.0, sign * visited[part], z[part]) for part, sign in ((down, -1.0), (up, 1.0))]
    np.testing.assert_allclose(crossings, [-1.0, 1.0], atol=2 * math.exp(-7.5))
    reached = np.interp(-(8 - 1) * length * ARCMIN, -visited[down], z[down])
    assert reached == pytest.approx(-1 + 2 * math.exp(-1), abs=2e-3)


@given(st.floats(0.3, 3.0), st.floats(0.3, 3.0), st.floats(1.0, 20.0), st.floats(1.2, 5.0), st.floats(-100.0, 100.0))
def test_the_characteristic_is_odd_rises_and_is_undone(k1, k3, first, ratio, load):
    steps, stiffness = Elasticity(ratios=(k1, 1.0, k3), torques=(first, ratio * first)), 3.5e4
    law = characteristic(k1, 1.0, k3, *steps.corners(stiffness))
    twist = steps.twist(load / stiffness, stiffness)
    assert law(twist) == pytest.approx(load / stiffness, rel=1e-9, abs=1e-15)
    assert law(-twist) == pytest.approx(-law(twist), rel=1e-12, abs=1e-18)
    assert law(twist + 1e-6) > law(twist)


def test_the_characteristic_has_the_slopes_stated_and_its_corners_at_the_torques_stated():
    stiffness = 3.5e4
    law = characteristic(0.8, 1.0, 1.25, *STEPS.corners(stiffness))
    for torque, ratio in ((0.5, 0.8), (9.0, 1.0), (60.0, 1.25)):
        at, step = STEPS.twist(torque / stiffness, stiffness), 1e-7
        assert (law(at + step) - law(at - step)) / (2 * step) == pytest.approx(ratio, rel=0.02)
    for torque, twist in zip(STEPS.torques, STEPS.corners(stiffness), strict=True):
        assert law(twist) * stiffness == pytest.approx(torque, rel=0.02)


@pytest.mark.parametrize("cut", [1, 137, 499])
def test_the_result_does_not_depend_on_the_cut(cut):
    whole = Rig(MODEL, TURNING, rate=500.0, effects=EVERYTHING).advance(500)
    rig = Rig(MODEL, TURNING, rate=500.0, effects=EVERYTHING)
    parts = [rig.advance(cut), rig.advance(500 - cut)]
    np.testing.assert_array_equal(np.concatenate([part.acceleration for part in parts]), whole.acceleration)


def test_several_rigs_at_once_are_the_rigs_one_by_one():
    """Linear and other ones mixed, with different programmes, effects and models."""

    def rigs():
        return [
            Rig(MODEL, TURNING, rate=500.0, effects=EVERYTHING),
            Rig(MODEL, REVERSING, rate=500.0, effects=Effects(friction=RUBBING)),
            Rig(MODEL, FAST, rate=500.0, effects=Effects(errors=ERRORS)),
            Rig(ParametricModel(), REVERSING, rate=500.0, effects=Effects(hysteresis=LOOP, elasticity=STEPS)),
        ]

    together, alone = rigs(), rigs()
    for count in (200, 50):
        for rig, one in zip(alone, advance_together(together, count), strict=True):
            expected = rig.advance(count).acceleration
            np.testing.assert_allclose(one.acceleration, expected, atol=1e-5 * np.abs(expected).max())


def test_a_drive_transmits_what_its_inertia_leaves_of_the_torque():
    """Summed up of its parts: elastic torque, damping and hysteresis."""
    rig = Rig(MODEL, TURNING, rate=1000.0, effects=EVERYTHING, surroundings=SWINGING)
    chunk = rig.advance(300)
    state, at = chunk.vibration_at(chunk.times), rig.coefficients(chunk.times)
    inertia = 0.29 * rig.surroundings.inertia_factor(rig.motion(chunk.times))
    law = characteristic(0.8, 1.0, 1.25, *STEPS.corners(MODEL.dynamics.stiffness))
    viscous = RUBBING.viscous * (1 - 0.4 * WARM.warmth(chunk.times)) / inertia
    damping = (at.damping - viscous) * (state.velocity + at.error_rate)
    elastic = at.stiffness * law(state.displacement + at.error)
    expected = inertia * (damping + elastic) + LOOP.torque * state.hysteresis
    np.testing.assert_allclose(rig.reaction(chunk.times, state), expected, rtol=1e-9)

"""Late stamps and wrong clocks are found by the motion that the vibration fits; sound ones are never doubted."""

from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.acquisition.record import join_records
from hd_monitor.identification.checks.stamps import compare_stamps
from hd_monitor.limitation import LimitationCode
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries
from hd_monitor.reducer import Reducer

MODEL = ParametricModel(
    flexspline=StiffnessSeries((0.10, 0.03, 0.02), (0.4, 1.1, 2.0)),
    circular_spline=StiffnessSeries((0.035, 0.012, 0.01), (2.5, 0.3, 1.0)),
)
STROKES = {"motion": "strokes", "speed": 1500.0, "span": np.radians(110.0)}


def recorded(seed=4, **motion):
    return join_records(simulate(Case(model=MODEL, duration=10.0, seed=seed, **motion)))


def compared(record):
    return compare_stamps([record], Reducer(), Dynamics(), 3)


@pytest.mark.parametrize("delay", [-0.05, -0.03, 0.03, 0.05, 0.3])
def test_a_delay_is_measured(delay):
    sound = recorded(**STROKES)
    shift = round(delay / sound.period)
    late = replace(sound, acceleration=np.roll(sound.acceleration, shift))
    found = compared(late)
    assert found is not None
    assert found.code in {LimitationCode.STAMPS_APART, LimitationCode.STAMPS_APART_OR_MORE}
    assert found.values["late"] == ("vibration" if delay > 0.0 else "joint states")
    assert found.values["delay_ms"] == pytest.approx(1e3 * abs(delay), abs=12.0)


@pytest.mark.parametrize("error", [-0.01, 0.01, 0.02])
def test_a_clock_of_another_rate_is_named(error):
    sound = recorded(**STROKES)
    stamped = sound.start + (sound.times - sound.start) * (1.0 + error)
    fast = replace(sound, acceleration=np.interp(sound.times, stamped, sound.acceleration, right=0.0))
    found = compared(fast)
    assert found is not None
    assert found.code is LimitationCode.VIBRATION_CLOCK_RATE
    assert found.values["percent"] == pytest.approx(100.0 * error, abs=0.5)


@pytest.mark.parametrize(
    "motion",
    [STROKES, {"speed": 1900.0}, {"speed": 1650.0}, {"motion": "run_up", "speed": 2500.0}, {"motion": "steps"}],
    ids=["strokes", "steady", "at resonance", "run-up", "steps"],
)
@pytest.mark.parametrize("seed", range(3))
def test_sound_stamps_are_not_doubted(motion, seed):
    assert compared(recorded(seed, **motion)) is None


def test_what_holds_no_lines_says_nothing_of_stamps():
    sound = recorded(**STROKES)
    noise = replace(sound, acceleration=np.random.default_rng(5).standard_normal(len(sound)))
    assert compared(noise) is None

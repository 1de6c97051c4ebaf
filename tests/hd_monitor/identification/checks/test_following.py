"""A reducer's lines keep their phase along the angle; what another joint or a machine puts near them does not."""

from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.acquisition.record import Record, join_records
from hd_monitor.identification.checks.following import LineShares, line_shares
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries
from hd_monitor.reducer import Reducer

MODEL = ParametricModel(
    flexspline=StiffnessSeries((0.03, 0.01, 0.01), (0.4, 1.1, 2.0)),
    circular_spline=StiffnessSeries((0.035, 0.012, 0.01), (2.5, 0.3, 1.0)),
)
MOTIONS = {
    "strokes": {"motion": "strokes", "speed": 1500.0, "span": np.radians(110.0)},
    "steady": {"speed": 1900.0},
    "run-up": {"motion": "run_up", "speed": 1500.0},
    "steps": {"motion": "steps"},
}


def recorded(motion: str, seed: int = 4, snr: float = 20.0) -> Record:
    return join_records(simulate(Case(model=MODEL, duration=10.0, seed=seed, snr=snr, **MOTIONS[motion])))


def shares(record: Record) -> LineShares:
    return line_shares([record], Reducer(), Dynamics(), 3)


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("snr", [0.0, 20.0])
def test_a_reducers_lines_follow_its_angle(motion: str, snr: float) -> None:
    by_window, throughout = shares(recorded(motion, snr=snr))
    assert by_window > 0.3
    assert throughout > 0.5 * by_window


@pytest.mark.parametrize(("heard", "moving"), [("steps", "strokes"), ("run-up", "strokes")])
def test_another_joints_vibration_does_not(heard: str, moving: str) -> None:
    other, own = recorded(heard), recorded(moving)
    size = min(len(other), len(own))
    mixed = Record(
        start=own.start,
        period=own.period,
        acceleration=other.acceleration[:size],
        angle=own.angle[:size],
        speed=own.speed[:size],
        torque=own.torque[:size],
    )
    by_window, throughout = shares(mixed)
    assert by_window > 0.05
    assert throughout < 0.2 * by_window


def every_nth(record: Record, every: int) -> Record:
    part = slice(None, None, every)
    return Record(
        start=record.start,
        period=every * record.period,
        acceleration=record.acceleration[part],
        angle=record.angle[part],
        speed=record.speed[part],
        torque=record.torque[part],
    )


@pytest.mark.parametrize("every", [1, 5])
def test_noise_is_not_near_the_lines(every: int) -> None:
    own = every_nth(recorded("strokes"), every)
    noise = replace(own, acceleration=np.random.default_rng(5).standard_normal(len(own)))
    assert max(shares(noise)) < 0.02
    assert shares(replace(own, acceleration=np.zeros(len(own)))) == (0.0, 0.0)

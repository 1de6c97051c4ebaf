"""The update of the estimation's state: what it changes, and that it never touches the state it was given."""

import dataclasses
import math
from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.identification.with_sensor.context import Context
from hd_monitor.identification.with_sensor.estimator import Estimator
from hd_monitor.identification.with_sensor.state import WINDOW
from hd_monitor.limitation import LimitationCode
from hd_monitor.model import ParametricModel, StiffnessSeries

TRUTH = Case(
    model=ParametricModel(flexspline=StiffnessSeries((0.08, 0.02)), circular_spline=StiffnessSeries((0.01,))),
    duration=30.0,
)


@pytest.fixture(scope="module")
def records():
    return simulate(TRUTH)


@pytest.fixture(scope="module")
def estimator():
    return Estimator(TRUTH.settings())


@pytest.fixture(scope="module")
def state(estimator, records):
    state = estimator.initial()
    for number in range(4):
        state = estimator.update(state, records[2 * number : 2 * number + 2])
    return state


def contents(state):
    """Every number in a state, in a form that compares."""

    def plain(value):
        if dataclasses.is_dataclass(value):
            return tuple(plain(getattr(value, f.name)) for f in dataclasses.fields(value))
        if isinstance(value, tuple):
            return tuple(plain(item) for item in value)
        return value.tobytes() if isinstance(value, np.ndarray) else value

    return plain(state)


def test_the_state_before_any_data_has_no_result(estimator):
    state = estimator.initial()
    assert (state.result, state.floor, state.unusable, state.seconds) == (None, None, None, 0.0)
    assert estimator.sureness(state) == 0.0


def test_an_update_leaves_the_given_state_as_it_was(estimator, records, state):
    before = contents(state)
    after = estimator.update(state, records[8:10])
    assert contents(state) == before
    assert after.seconds == pytest.approx(state.seconds + 2.0, abs=0.1)
    assert contents(estimator.update(state, records[8:10])) == contents(after)


@pytest.mark.parametrize(
    ("spoil", "code"),
    [
        (lambda r: replace(r, acceleration=1e300 * r.acceleration), LimitationCode.SEGMENT_UNUSABLE),
        (lambda r: replace(r, speed=1e4 * r.speed, angle=1e4 * r.angle), LimitationCode.SEGMENT_UNUSABLE),
        (lambda r: replace(r, acceleration=np.ones(len(r))), LimitationCode.VIBRATION_CONSTANT),
    ],
    ids=["overflow", "too fast", "constant"],
)
def test_an_unusable_segment_changes_nothing_but_says_why(estimator, records, state, spoil, code):
    after = estimator.update(state, [spoil(record) for record in records[8:10]])
    assert after.unusable.code is code
    assert contents(replace(after, unusable=None)) == contents(state)
    assert estimator.update(after, records[8:10]).unusable is None


def test_all_motion_is_fitted_again_while_it_is_kept(estimator, records, state):
    while state.seconds <= WINDOW + 4.0:
        restarted, before = state.schedule.restarted, state.seconds
        first = round(before)
        state = estimator.update(state, records[first : first + 2])
        assert sum(segment.duration for segment in state.recent[1:]) < WINDOW
        if state.seconds > WINDOW:
            assert state.schedule.restarted == restarted
    assert restarted > 0.0


def test_evidence_fades_with_the_motion_that_passes(estimator, state):
    memory = TRUTH.settings().analysis.memory
    aged = estimator.aged(state, memory)
    left, frequency = state.information.faded(math.exp(-1.0)), Context.of(TRUTH.settings()).unknowns.frequency
    walked = left.diffused(frequency, 0.01**2 * memory / 60.0)  # 1 % of the natural frequency in a minute
    np.testing.assert_allclose(aged.information.matrix, walked.matrix)
    assert aged.information.matrix[frequency, frequency] < 0.5 * left.matrix[frequency, frequency]
    np.testing.assert_allclose(aged.floor.freedom, math.exp(-1.0) * state.floor.freedom)
    assert aged.result is state.result


def test_a_sensor_mounted_the_other_way_round_is_turned(estimator, records):
    state = estimator.initial()
    for number in range(6):
        pair = [replace(r, acceleration=-r.acceleration) for r in records[2 * number : 2 * number + 2]]
        state = estimator.update(state, pair)
    assert state.setup.mounting == -1.0
    assert state.result.index.flexspline == pytest.approx(TRUTH.index.flexspline, abs=0.005)

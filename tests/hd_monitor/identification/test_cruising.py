"""Once the indexes are known well enough, the identifier looks at a part of the motion only."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.checks.coverage import Coverage
from hd_monitor.identification.identifier import (
    CRUISE_PERIOD,
    CRUISE_SEGMENT,
    LONGEST_PERIOD,
    SHORTEST_SEGMENT,
    Identifier,
)
from hd_monitor.identification.with_sensor.state import State
from hd_monitor.settings import JointSettings

RATE = 100.0  # Hz
SPEED = 1.0  # rad/s


class Stub:
    """Fake estimator with a given certainty."""

    def __init__(self, sureness: float) -> None:
        self._sureness = sureness
        self.taken: list[float] = []
        self.passed = 0.0

    def sureness(self, state: State) -> float:
        return self._sureness

    def update(self, state: State, records: list[Record]) -> State:
        self.taken.append(sum(len(record) * record.period for record in records))
        return state

    def aged(self, state: State, duration: float) -> State:
        self.passed += duration
        return state


def second(number: int, speed: float = SPEED) -> Record:
    samples = int(RATE)
    times = number + np.arange(samples) / RATE
    return Record(
        start=float(number),
        period=1.0 / RATE,
        acceleration=np.sin(times),
        angle=speed * times,
        speed=np.full(samples, speed),
        torque=np.ones(samples),
        continues=number > 0,
    )


def run(estimator: Stub, seconds: int, speed: float = SPEED, *, sparing: bool = True) -> Identifier:
    identifier = Identifier(JointSettings.from_mapping(), sparing=sparing)
    identifier._state = replace(identifier._state, coverage=Coverage(time=100.0))
    identifier._estimator = estimator  # type: ignore[assignment]
    for number in range(seconds):
        identifier.add(second(number, speed))
    return identifier


@pytest.mark.parametrize(
    ("sureness", "period", "length"),
    [
        (1.0, CRUISE_PERIOD, CRUISE_SEGMENT),
        (1.5, 1.5 * CRUISE_PERIOD, CRUISE_SEGMENT),
        (2.0, LONGEST_PERIOD, CRUISE_SEGMENT),
        (4.0, LONGEST_PERIOD, SHORTEST_SEGMENT),
        (9.0, LONGEST_PERIOD, SHORTEST_SEGMENT),
    ],
)
def test_the_better_the_indexes_are_known_the_less_is_looked_at(sureness: float, period: float, length: float) -> None:
    estimator = Stub(sureness)
    run(estimator, 1000)
    assert set(estimator.taken) == {length}
    assert len(estimator.taken) == pytest.approx(1000.0 / period, abs=1.0)


@pytest.mark.parametrize(("sureness", "sparing"), [(0.99, True), (9.0, False)])
def test_everything_is_looked_at_otherwise(sureness: float, sparing: bool) -> None:
    estimator = Stub(sureness)
    run(estimator, 100, sparing=sparing)
    assert sum(estimator.taken) == pytest.approx(100.0)


def test_what_is_not_looked_at_makes_the_evidence_older() -> None:
    estimator = Stub(1.0)
    run(estimator, 1000)
    skipped = (len(estimator.taken) - 1) * (CRUISE_PERIOD - CRUISE_SEGMENT)  # what follows the last look is to come
    assert estimator.passed == pytest.approx(skipped)


def test_evidence_does_not_age_while_the_joint_stands() -> None:
    estimator = Stub(1.0)
    identifier = run(estimator, 2)
    for number in range(2, 500):
        identifier.add(second(number, speed=0.0))
    for number in range(500, 600):
        identifier.add(second(number))
    assert estimator.passed == pytest.approx((len(estimator.taken) - 1) * (CRUISE_PERIOD - CRUISE_SEGMENT))
    assert len(estimator.taken) == pytest.approx(1 + 100.0 / CRUISE_PERIOD, abs=1.0)

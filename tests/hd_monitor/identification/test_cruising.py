"""Once the indexes are known well enough, the identifier looks at a part of the motion only."""

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.identifier import (
    CRUISE_PERIOD,
    CRUISE_SEGMENT,
    LONGEST_PERIOD,
    SHORTEST_SEGMENT,
    Identifier,
)
from hd_monitor.settings import JointSettings

RATE = 100.0  # Hz
SPEED = 1.0  # rad/s


class Stub:
    """Stands for an estimation that is as sure as it is told to be."""

    def __init__(self, sureness: float) -> None:
        self.sureness = sureness
        self.seconds = 100.0
        self.taken: list[float] = []
        self.aged = 0.0
        self.result = None

    def take(self, records: list[Record]) -> None:
        self.taken.append(sum(len(record) * record.period for record in records))

    def age(self, duration: float) -> None:
        self.aged += duration


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


def run(estimation: Stub, seconds: int, speed: float = SPEED, *, sparing: bool = True) -> Identifier:
    identifier = Identifier(JointSettings.from_mapping(), sparing=sparing)
    identifier._estimation = estimation  # type: ignore[assignment]
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
    estimation = Stub(sureness)
    run(estimation, 1000)
    assert set(estimation.taken) == {length}
    assert len(estimation.taken) == pytest.approx(1000.0 / period, abs=1.0)


@pytest.mark.parametrize(("sureness", "sparing"), [(0.99, True), (9.0, False)])
def test_everything_is_looked_at_otherwise(sureness: float, sparing: bool) -> None:
    estimation = Stub(sureness)
    run(estimation, 100, sparing=sparing)
    assert sum(estimation.taken) == pytest.approx(100.0)


def test_what_is_not_looked_at_makes_the_evidence_older() -> None:
    estimation = Stub(1.0)
    run(estimation, 1000)
    skipped = (len(estimation.taken) - 1) * (CRUISE_PERIOD - CRUISE_SEGMENT)  # what follows the last look is to come
    assert estimation.aged == pytest.approx(skipped)


def test_a_standing_joint_makes_nothing_older() -> None:
    estimation = Stub(1.0)
    identifier = run(estimation, 2)
    for number in range(2, 500):
        identifier.add(second(number, speed=0.0))
    for number in range(500, 600):
        identifier.add(second(number))
    assert estimation.aged == pytest.approx((len(estimation.taken) - 1) * (CRUISE_PERIOD - CRUISE_SEGMENT))
    assert len(estimation.taken) == pytest.approx(1 + 100.0 / CRUISE_PERIOD, abs=1.0)

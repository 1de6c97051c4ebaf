"""The cause stands in place of its consequences; where no cause shows, a result stays as it is."""

from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.acquisition.record import JointSamples, Record, join_records
from hd_monitor.acquisition.recorder import AssembledPeriod
from hd_monitor.identification.result import Identification
from hd_monitor.limitation import LimitationCode, blocker
from hd_monitor.model import ParametricModel, StiffnessSeries
from hd_monitor.settings import JointSettings
from hd_monitor.suspicion import Suspicion

SETTINGS = JointSettings.from_mapping({})
MODEL = ParametricModel(flexspline=StiffnessSeries((0.03,)), circular_spline=StiffnessSeries((0.035,)))
NOTHING = replace(Identification.none((), relative=False), samples=12_000)
SOUND = replace(NOTHING, signal_to_noise=20.0)
TORQUE = replace(NOTHING, limitations=(blocker(LimitationCode.TORQUE_CONTRADICTED, factor=3.0),))
RNG = np.random.default_rng(3)


@pytest.fixture(scope="module")
def swing() -> Record:
    return join_records(simulate(Case(model=MODEL, motion="strokes", speed=1500.0, duration=12.0)))


def periods(record: Record, effort_noise: float = 0.0) -> list[AssembledPeriod]:
    """Cut a record into periods of a second, with joint states of 100 Hz."""
    found = []
    for first in range(0, len(record) - 999, 1000):
        part, every = slice(first, first + 1000), slice(first, first + 1000, 10)
        piece = Record(
            start=float(record.times[first]),
            period=record.period,
            acceleration=record.acceleration[part],
            angle=record.angle[part],
            speed=record.speed[part],
            torque=record.torque[part],
        )
        samples = JointSamples(
            times=record.times[every],
            angle=record.angle[every],
            speed=record.speed[every],
            effort=10.0 + effort_noise * RNG.standard_normal(100),
        )
        found.append(AssembledPeriod((piece,), samples, piece.acceleration, frozenset()))
    return found


def suspecting(some: list[AssembledPeriod]) -> Suspicion:
    suspicion = Suspicion(SETTINGS)
    for period in some:
        suspicion.add(period)
    return suspicion


def codes(found: Identification) -> list[LimitationCode]:
    return [limitation.code for limitation in found.limitations]


def with_noise(record: Record, level: float) -> Record:
    return replace(record, acceleration=level * RNG.standard_normal(len(record)))


def test_what_is_sound_is_not_suspected(swing: Record) -> None:
    suspicion = suspecting(periods(swing))
    assert suspicion.qualified(SOUND) is SOUND
    assert suspicion.qualified(TORQUE) is TORQUE
    assert Suspicion(SETTINGS).qualified(SOUND) is SOUND
    unused = replace(TORQUE, samples=0)
    assert suspecting(periods(with_noise(swing, 1.0))).qualified(unused) is unused


def test_a_sensor_that_falls_silent_is_named_until_it_is_heard_again(swing: Record) -> None:
    quiet = with_noise(swing, 0.02 * float(np.nanstd(swing.acceleration)))
    suspicion = suspecting(periods(swing)[:7])
    assert not codes(suspicion.qualified(SOUND))
    for period in periods(quiet)[7:9]:
        suspicion.add(period)
        assert codes(suspicion.qualified(SOUND)) == [LimitationCode.SENSOR_SILENT]
        assert not suspicion.qualified(SOUND).blockers
        assert suspicion.qualified(TORQUE).blockers[0].code is LimitationCode.SENSOR_SILENT
    suspicion.add(periods(swing)[9])
    assert not codes(suspicion.qualified(SOUND))


def test_a_late_stamp_takes_the_place_of_what_follows_from_it(swing: Record) -> None:
    late = replace(swing, acceleration=np.roll(swing.acceleration, 60))
    (cause,) = suspecting(periods(late)).qualified(TORQUE).limitations
    assert cause.code in {LimitationCode.STAMPS_APART, LimitationCode.STAMPS_APART_OR_MORE}
    assert cause.blocks


def test_efforts_are_suspected_where_the_torque_is_in_question(swing: Record) -> None:
    suspicion = suspecting(periods(swing, effort_noise=20.0))
    assert codes(suspicion.qualified(TORQUE)) == [LimitationCode.EFFORT_NOISY]
    other = replace(NOTHING, limitations=(blocker(LimitationCode.VALUE_ON_BOUND, names="natural frequency"),))
    assert suspicion.qualified(other) is other


def test_a_vibration_that_does_not_follow_the_angle_names_no_part(swing: Record) -> None:
    other = join_records(simulate(Case(model=MODEL, motion="run_up", speed=1500.0, duration=12.0)))
    size = min(len(swing), len(other))
    mixed = replace(
        other,
        acceleration=other.acceleration[:size],
        angle=swing.angle[:size],
        speed=swing.speed[:size],
        torque=swing.torque[:size],
    )
    suspicion = suspecting(periods(mixed))
    assert codes(suspicion.qualified(replace(SOUND, signal_to_noise=-5.0))) == [LimitationCode.VIBRATION_FOREIGN]
    assert suspicion.qualified(SOUND) is SOUND

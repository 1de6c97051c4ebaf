"""What is not the reducer's is listed with its source, by what smears as the speed changes."""

import pytest
from tests.studies.something_else import Drive, results_of

from hd_monitor.diagnosis.something_else import describe_all_else, describe_something_else
from hd_monitor.identification.checks.something_else import SomethingElse, Source

RIG = {"defect": "flexspline", "sensor.noise": 0.3, "duration": 10.0}
STEADY = RIG | {"programme": "fixed", "fixed.speed": 930.0}
SWEEP = RIG | {"programme": "sweep", "sweep.first": 300.0, "sweep.last": 1800.0, "sweep.rate": 150.0}
DWELLS = RIG | {"programme": "dwell", "dwell.first": 600.0, "dwell.last": 1000.0, "dwell.step": 200.0}
SPEED = 930.0 / 80.0 / 60.0  # output revolutions per second


def rows_of(rig, tone=(0.0, 0.0), **changes):
    drive = Drive(rig | {name.replace("__", "."): value for name, value in changes.items()}, tone)
    return results_of(drive)[-1].something_else


def ripple(order):
    return {"torque__ripple": [1.5 / order], "torque__ripple_orders": [order]}


@pytest.mark.parametrize(
    ("order", "source"),
    [(1.0, Source.WAVE_GENERATOR), (3.0, Source.WAVE_GENERATOR), (12.0, Source.MOTOR_RIPPLE), (5.0, Source.UNKNOWN)],
)
def test_a_line_that_follows_the_angle_has_an_order(order, source):
    rows = rows_of(DWELLS, **ripple(order))
    assert {(row.source, row.frequency) for row in rows} == {(source, None)}
    if order > 1.0:  # far below the resonance, the stiffness' lines beside are stronger than the line itself
        assert rows[0].order == 80.0 * order
    assert 0.001 < rows[0].share < 0.5


@pytest.mark.parametrize("rig", [SWEEP, DWELLS], ids=["sweep", "dwells"])
@pytest.mark.parametrize(("frequency", "source"), [(50.03, Source.MAINS), (37.3, Source.UNKNOWN)])
def test_a_tone_that_stays_while_the_speed_changes_has_a_frequency(rig, frequency, source):
    (row,) = rows_of(rig, (frequency, 1.5))
    assert (row.source, row.order) == (source, None)
    assert row.frequency == pytest.approx(frequency, abs=0.1)
    assert row.amplitude == pytest.approx(1.5, rel=0.1)


def test_at_one_speed_an_order_and_a_frequency_are_not_distinguished():
    (row,) = rows_of(STEADY, (50.0, 1.0))
    assert row.source is Source.MAINS
    assert (row.order, row.frequency) == pytest.approx((50.0 / SPEED, 50.0), abs=0.5)
    assert "as one speed does not tell which, at a fixed 50.0 Hz" in describe_something_else(row)
    (row,) = rows_of(STEADY, **ripple(3.0))
    assert row.source is Source.WAVE_GENERATOR
    assert (row.order, row.frequency) == pytest.approx((240.0, 240.0 * SPEED), abs=0.1)


@pytest.mark.parametrize("rig", [STEADY, SWEEP, DWELLS], ids=["steady", "sweep", "dwells"])
def test_nothing_is_listed_where_nothing_is(rig):
    assert [result.something_else for result in results_of(Drive(rig | {"seed": 3})) if result.something_else] == []


def test_the_words_name_source_place_and_size():
    mains = SomethingElse(source=Source.MAINS, order=None, frequency=50.02, amplitude=1.234, share=0.0512)
    assert describe_something_else(mains) == "mains at 50.0 Hz: 1.2 rad/s², 5.1 % of the vibration's power"
    assert describe_all_else(()) == "none"

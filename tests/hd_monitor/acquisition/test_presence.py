"""An input is missing when nothing, or nothing of use, has come for longer than it may take: by any clock."""

import pytest

from hd_monitor.acquisition.presence import Absence, Missing, Presence
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

SECOND = 1_000_000_000
VIBRATION, MOTION, TORQUE = Quantity.VIBRATION, Quantity.MOTION, Quantity.TORQUE
BOTH = (MOTION, VIBRATION)


@pytest.fixture
def presence() -> Presence:
    given = {"input.timeout": 2.0, "input.startup_warning": 3.0, "input.startup_timeout": 5.0}
    presence = Presence(JointSettings.from_mapping(given))
    presence.start(10 * SECOND)
    return presence


@pytest.fixture
def heard(presence: Presence) -> Presence:
    for quantity in BOTH:
        presence.note(quantity, 10 * SECOND, 10 * SECOND)
    return presence


def all_are(absence: Absence) -> list[Missing]:
    return [Missing(quantity, absence) for quantity in BOTH]


def test_the_first_data_is_awaited_then_overdue_then_lost(presence: Presence) -> None:
    assert presence.missing(13 * SECOND - 1) == all_are(Absence.AWAITED)
    assert presence.missing(13 * SECOND) == all_are(Absence.OVERDUE)
    assert presence.missing(15 * SECOND - 1) == all_are(Absence.OVERDUE)
    assert presence.missing(15 * SECOND) == all_are(Absence.LOST)
    assert presence.absent == BOTH


def test_what_has_come_is_lost_after_its_own_time(heard: Presence) -> None:
    assert heard.missing(12 * SECOND - 1) == []
    assert heard.missing(12 * SECOND) == all_are(Absence.LOST)
    assert heard.absent == ()


def test_an_input_is_lost_alone_and_comes_back(heard: Presence) -> None:
    heard.note(VIBRATION, 13 * SECOND, 13 * SECOND)
    assert heard.missing(14 * SECOND) == [Missing(MOTION, Absence.LOST)]
    heard.note(MOTION, 14 * SECOND, 14 * SECOND)
    assert heard.missing(14 * SECOND) == []


def test_unusable_messages_are_not_silence(heard: Presence) -> None:
    heard.note(MOTION, 13 * SECOND, 13 * SECOND)
    heard.note(VIBRATION, 11 * SECOND, 11 * SECOND)
    heard.note(VIBRATION, 13 * SECOND)
    assert heard.missing(13 * SECOND) == [Missing(VIBRATION, Absence.UNUSABLE)]
    assert heard.missing(15 * SECOND) == all_are(Absence.LOST)


def test_what_is_unusable_from_the_start_gets_its_time_too(presence: Presence) -> None:
    presence.note(MOTION, 14 * SECOND, 14 * SECOND)
    presence.note(VIBRATION, 14 * SECOND)
    assert presence.missing(14 * SECOND) == []
    presence.note(MOTION, 16 * SECOND, 16 * SECOND)
    presence.note(VIBRATION, 16 * SECOND)
    assert presence.missing(16 * SECOND) == [Missing(VIBRATION, Absence.UNUSABLE)]


def test_an_input_that_is_not_needed_is_never_missing(presence: Presence) -> None:
    presence.note(TORQUE, 10 * SECOND)
    assert TORQUE not in {quantity for quantity, _ in presence.missing(100 * SECOND)}


def test_a_clock_that_has_not_begun_or_is_set_back_restarts_the_silence(presence: Presence) -> None:
    presence.start(None)
    assert presence.missing(1000 * SECOND) == all_are(Absence.AWAITED)
    assert presence.missing(5 * SECOND) == all_are(Absence.AWAITED)
    assert presence.missing(10 * SECOND) == all_are(Absence.LOST)

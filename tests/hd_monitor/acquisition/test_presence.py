"""An input is lost when nothing, or nothing of use, has come for the timeout: by any clock."""

import pytest

from hd_monitor.acquisition.presence import Loss, Presence
from hd_monitor.sources import Quantity

SECOND = 1_000_000_000
VIBRATION, MOTION, TORQUE = Quantity.VIBRATION, Quantity.MOTION, Quantity.TORQUE


@pytest.fixture
def presence() -> Presence:
    presence = Presence([MOTION, VIBRATION], 2 * SECOND)
    presence.start(10 * SECOND)
    return presence


def test_silence_counts_from_the_start(presence: Presence) -> None:
    assert presence.losses(12 * SECOND - 1) == []
    assert presence.losses(12 * SECOND) == [Loss(MOTION, True, 2 * SECOND), Loss(VIBRATION, True, 2 * SECOND)]
    assert presence.absent == (MOTION, VIBRATION)


def test_an_input_is_lost_alone_and_comes_back(presence: Presence) -> None:
    presence.note(MOTION, 11 * SECOND, 11 * SECOND)
    presence.note(VIBRATION, 13 * SECOND, 13 * SECOND)
    assert presence.losses(14 * SECOND) == [Loss(MOTION, True, 3 * SECOND)]
    presence.note(MOTION, 14 * SECOND, 14 * SECOND)
    assert presence.losses(14 * SECOND) == []
    assert presence.absent == ()


def test_unusable_messages_are_not_silence(presence: Presence) -> None:
    presence.note(MOTION, 13 * SECOND, 13 * SECOND)
    presence.note(VIBRATION, 11 * SECOND, 11 * SECOND)
    presence.note(VIBRATION, 13 * SECOND)
    assert presence.losses(13 * SECOND) == [Loss(VIBRATION, False, 2 * SECOND)]
    assert presence.losses(15 * SECOND) == [Loss(MOTION, True, 2 * SECOND), Loss(VIBRATION, True, 2 * SECOND)]


def test_an_input_that_is_not_needed_is_never_lost(presence: Presence) -> None:
    presence.note(TORQUE, 10 * SECOND)
    assert TORQUE not in {loss.quantity for loss in presence.losses(100 * SECOND)}


def test_a_clock_that_has_not_begun_or_is_set_back_restarts_the_silence(presence: Presence) -> None:
    presence.start(None)
    assert presence.losses(1000 * SECOND) == []
    assert presence.losses(5 * SECOND) == []
    assert len(presence.losses(7 * SECOND)) == 2

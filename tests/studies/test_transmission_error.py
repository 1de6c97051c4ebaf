"""A short run of the study of drives with a transmission error, against limits."""

from tests.studies.transmission_error import GIVEN, SETS, study


def test_the_right_part_is_named_where_the_error_is_expected():
    expected = max(GIVEN)
    tallies = study(4, 700, 15.0, 2, (expected,))
    for kind in SETS:
        tally = tallies[kind, expected]
        assert tally.named["wrong"] == 0, kind
        assert tally.named["right"] >= (3 if kind != "steady" else 2), (kind, tally.named)
    held = sum(sum(tally.held.values()) for tally in tallies.values())
    asked = sum(sum(tally.asked.values()) for tally in tallies.values())
    # The readings of a drive share their noise: about as many independent ones as drives
    assert held / asked >= 0.85

"""Sound units through the whole chain are hardly ever accused."""

from collections import Counter

from tests.studies.false_alarms import alarms_in, verdicts

SEED, UNITS, SECONDS = 51_500_000, 60, 40.0


def test_at_most_one_verdict_in_a_thousand_accuses_a_sound_unit():
    counted: Counter[str] = Counter()
    for number in range(UNITS):
        counted += verdicts((SEED + number, SECONDS))
    assert counted.total() > 30 * UNITS
    assert alarms_in(counted) <= counted.total() / 1000.0

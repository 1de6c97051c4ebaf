"""The interval of the torque share on random joints."""

import numpy as np
from tests.studies.torque_share import study


def test_the_interval_holds_the_truth_and_no_reading_is_the_wrong_one() -> None:
    rows = study(60, 11)
    assert len(rows) >= 100
    assert np.mean([row.covered for row in rows]) >= 0.95
    assert not any(row.wrong for row in rows)
    readings = [row.found.reading for row in rows if row.truth in (0.0, 1.0)]
    assert readings.count("either") < 0.5 * len(readings)

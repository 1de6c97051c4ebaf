"""A stretch of motion, thinned, is the same motion seen less often."""

import numpy as np
import pytest
from tests.oracle import table_1

from hd_sim_node.drive.rig import Rig
from hd_sim_node.motion.programme import SpeedProgramme

TURNING = SpeedProgramme(times=[0.0, 1.0], speeds=[900.0, 1500.0], cycles=1)


@pytest.mark.parametrize("every", [1, 2, 7])
def test_a_thinned_stretch_is_what_a_slower_rig_gives(every):
    slow, fast = Rig(table_1(), TURNING, rate=1000.0), Rig(table_1(), TURNING, rate=1000.0 * every)
    for count in (100, 250):
        expected, whole = slow.advance(count), fast.advance(count * every)
        thinned = whole.thinned(every)
        assert (thinned.first, len(thinned)) == (expected.first, count)
        for name in ("times", "angle", "speed", "displacement", "velocity", "acceleration", "torque"):
            scale = np.abs(getattr(expected, name)).max()
            np.testing.assert_allclose(getattr(thinned, name), getattr(expected, name), atol=1e-5 * scale)
        between = expected.times[:-1] + 0.3e-3
        np.testing.assert_array_equal(thinned.vibration_at(between), whole.vibration_at(between))

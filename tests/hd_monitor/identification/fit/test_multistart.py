"""Where to look for other solutions: lags of the clocks are read from the spectrum."""

from dataclasses import replace

import numpy as np
import pytest
from tests.hd_monitor.identification.fit.test_gauss_newton import ACTIVE, RATE, UNKNOWNS, problem, segment

from hd_monitor.identification.fit.multistart import with_lags


@pytest.mark.parametrize("samples", [-20, 0, 7, 20])
def test_the_lag_of_the_clocks_is_among_the_starts(samples):
    late = segment(7)
    late = replace(late, acceleration=np.roll(late.acceleration, -samples))
    task = replace(problem(late), active=ACTIVE | UNKNOWNS.mask(UNKNOWNS.delay))
    std = np.full(UNKNOWNS.size, 0.02)
    lags = [start[UNKNOWNS.delay] for start in with_lags(task, UNKNOWNS.zero(), std)]
    fastest = 2.0 * 1000.0 / 60.0 * 81.0 / 80.0  # Hz; within a radian of its phase a fit finds the rest
    assert min(abs(lag - samples / RATE) for lag in lags) < 1.0 / (2.0 * np.pi * fastest)


def test_a_lag_that_is_known_exactly_is_not_sought():
    start = UNKNOWNS.zero()
    (same,) = with_lags(problem(segment(8)), start, np.zeros(UNKNOWNS.size))
    assert same is start

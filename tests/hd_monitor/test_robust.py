"""The robust standard deviation is that of normal noise, whatever a few outliers do."""

import numpy as np
import pytest
from scipy.special import ndtri

from hd_monitor.robust import PER_MEDIAN, clip, robust_std

NOISE = np.random.default_rng(5).normal(0.0, 3.0, 20_001)


def test_the_factor_is_that_of_the_normal_distribution() -> None:
    assert pytest.approx(1.0 / ndtri(0.75), rel=1e-5) == PER_MEDIAN


def test_a_few_outliers_hardly_change_it() -> None:
    spoilt = NOISE.copy()
    spoilt[::100] = 1e9
    assert robust_std(NOISE) == pytest.approx(3.0, rel=0.02)
    assert robust_std(spoilt) == pytest.approx(3.0, rel=0.03)


def test_clipping_limits_the_outliers_and_keeps_the_rest() -> None:
    spoilt = NOISE.copy()
    spoilt[[7, 70]] = 1e9, -1e9
    clipped = clip(spoilt, 8.0)
    assert clipped[[7, 70]] == pytest.approx([24.0, -24.0], rel=0.02)
    assert np.array_equal(np.delete(clipped, [7, 70]), np.delete(NOISE, [7, 70]))


def test_values_that_are_mostly_zero_are_not_clipped() -> None:
    values = np.array([0.0, 0.0, 0.0, 5.0])
    assert np.array_equal(clip(values, 3.0), values)

import math
from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.history.series import Series
from hd_monitor.history.trend import change_of, slope_of, step_of

DAY = 86_400.0


def series(values, std=0.01, base=3, warn=math.nan, error=math.nan):
    values = np.asarray(values, dtype=float)
    days = np.arange(values.size, dtype=float)
    return Series(
        name="flexspline index",
        unit="",
        times=DAY * days,
        revolutions=1e5 * days,
        temperatures=np.full(values.size, math.nan),
        values=values,
        stds=np.full(values.size, std),
        is_baseline=days < base,
        warn=warn,
        error=error,
    )


def noisy(count, seed, slope=0.0, step=0.0, std=0.01, scatter=1.0):
    rng = np.random.default_rng(seed)
    days = np.arange(count)
    return 1.0 + slope * days + step * (days >= count // 2) + scatter * std * rng.standard_normal(count)


def present(found):
    assert found is not None
    return found


def test_a_change_against_the_baseline_with_its_uncertainty():
    found = present(change_of(series([1.0, 1.0, 1.0, 1.3])))
    assert found.change == pytest.approx(0.3)
    assert found.std == pytest.approx(math.hypot(0.01, 0.01 / math.sqrt(3.0)))
    assert found.significant
    assert not present(change_of(series([1.0, 1.0, 1.0, 1.01]))).significant
    assert change_of(series([1.0, 1.0, 1.0])) is None


def test_a_baseline_that_scatters_makes_changes_less_significant():
    assert present(change_of(series([1.0, 1.0, 1.0, 1.04]))).significant
    assert not present(change_of(series([0.95, 1.05, 1.0, 1.04]))).significant


def test_less_evidence_is_no_change():
    values = series([1.0, 1.0, 1.0, 1.3])
    values.stds[-1] = 0.5
    assert not present(change_of(values)).significant


def test_a_slope_is_found_with_its_interval_and_the_time_to_the_limit():
    found = present(slope_of(series(noisy(30, 1, slope=0.02), warn=1.2, error=2.0)))
    assert found.per_day == pytest.approx(0.02, abs=3.0 * found.per_day_std)
    assert found.per_day_std == pytest.approx(0.01 / math.sqrt(30 * (30**2 - 1) / 12), rel=0.4)
    assert found.per_million == pytest.approx(10.0 * found.per_day)
    low, high = found.days_to_limit  # of the error, as the warning is passed
    assert low < (2.0 - 1.58) / 0.02 < high
    assert high / low < 1.2


def test_no_slope_is_said_where_the_data_bear_none():
    assert slope_of(series(noisy(30, 2))) is None
    assert slope_of(series([1.0, 1.1, 1.2])) is None
    falling = present(slope_of(series(noisy(30, 1, slope=-0.02), warn=1.2, error=2.0)))
    assert falling.days_to_limit is None


def test_a_step_is_found_where_it_happened_and_is_no_slope():
    values = series(noisy(20, 3, step=0.3))
    found = present(step_of(values))
    assert found.time == 10 * DAY
    assert found.change == pytest.approx(0.3, abs=4.0 * found.std)
    assert slope_of(values) is None


def test_a_steady_change_is_no_step():
    values = series(noisy(20, 3, slope=0.03))
    assert step_of(values) is None
    assert slope_of(values) is not None


def test_values_of_one_time_have_neither_slope_nor_step():
    at_once = replace(series([1.0, 1.0, 1.0, 1.3, 1.3, 1.3]), times=np.full(6, DAY))
    assert slope_of(at_once) is None
    assert step_of(at_once) is None


@pytest.mark.parametrize("scatter", [1.0, 3.0])
def test_noise_alone_makes_changes_slopes_and_steps_no_oftener_than_it_says(scatter):
    count = 1000
    found = [series(noisy(12, seed, scatter=scatter)) for seed in range(count)]
    slopes = sum(slope_of(one) is not None for one in found)
    steps = sum(step_of(one) is not None for one in found)
    changes = sum(present(change_of(one)).significant for one in found)
    assert slopes <= 0.02 * count
    assert steps <= 0.004 * count
    assert changes <= (0.02 if scatter == 1.0 else 0.1) * count

"""Whether a reading changes: against its baseline, steadily, or in one step; and no more than the data bear."""

import math
from typing import NamedTuple

import numpy as np
import scipy

from ..arrays import FloatArray, IntArray
from ..change import SIGNIFICANT, Change
from .series import Series

STEP_SIGNIFICANT = 0.001
"""Probability below which a step, looked for at every place, is not an accident of the noise."""

FEWEST = 4
"""Values from which a slope, or a step, is looked for."""

BANDS = 1.96
"""Standard deviations to either side of a 95 % interval."""

_DAY = 86_400.0
_BETTER = 10.0  # by which a step must lower the sum of squares, in variances: odds of e^5 over a steady change


class Slope(NamedTuple):
    """A steady change, and when the limit would be reached if it went on."""

    per_day: float
    per_day_std: float
    per_million: float
    """Per million revolutions of the wave generator; NaN where these are not known."""
    per_million_std: float
    p_value: float
    days_to_limit: tuple[float, float] | None
    """95 % interval from the newest value; None without a limit ahead."""


class Step(NamedTuple):
    """A sudden change, as an exchange that nobody entered makes it."""

    time: float
    """Of the first value after it [s]."""
    change: float
    std: float
    p_value: float


def change_of(series: Series) -> Change | None:
    """Compare the newest values, as many as the baseline has at most, with the baseline; None if there are none since.

    The repeatability counts: where the baseline's own values scatter by more than their standard deviations say, the
    uncertainty of both sides is widened by that.
    """
    base = series.is_baseline
    if not base.any() or base[-1]:
        return None
    later = np.arange(np.flatnonzero(base)[-1] + 1, base.size)
    newest = later[-min(int(base.sum()), later.size) :]
    before, before_std, widened = weighted_mean(series.values[base], series.stds[base])
    after, after_std, _ = weighted_mean(series.values[newest], series.stds[newest] * widened)
    deviation = abs(after - before) / math.hypot(before_std, after_std)
    freedom = max(int(base.sum()) + newest.size - 2, 1) if widened > 1.0 else 1000
    return Change(before, before_std, after, after_std, float(2.0 * scipy.stats.t.sf(deviation, freedom)))


def slope_of(series: Series) -> Slope | None:
    """Fit a steady change to all values; None where the data bear none, or a step accounts for it better."""
    if not _has_a_course(series):
        return None
    by_time = _line(series.times / _DAY, series.values, series.stds)
    p_value = float(2.0 * scipy.stats.t.sf(abs(by_time.slope) / by_time.slope_std, series.values.size - 2))
    if p_value >= SIGNIFICANT or step_of(series) is not None:
        return None
    turned = (math.nan, math.nan)
    if float(np.ptp(series.revolutions)) > 0.0:
        by_turns = _line(series.revolutions / 1e6, series.values, series.stds)
        turned = by_turns.slope, by_turns.slope_std
    return Slope(by_time.slope, by_time.slope_std, *turned, p_value, _time_to_limit(series))


def step_of(series: Series) -> Step | None:
    """Look for one sudden change; None where noise makes one as large somewhere, or a steady change explains it."""
    if not _has_a_course(series):
        return None
    count = series.values.size
    place = np.arange(2, count - 1)
    before, after = _sides(series, place)
    change, std = after.mean - before.mean, np.hypot(before.std, after.std)
    chances = place.size * 2.0 * scipy.stats.t.sf(np.abs(change) / std, count - 2)
    # By the misfit, since the least probabilities are all 0
    best = int(np.argmin(before.left + after.left))
    steady = _line(series.times, series.values, series.stds).left
    if chances[best] >= STEP_SIGNIFICANT or before.left[best] + after.left[best] + _BETTER >= steady:
        return None
    return Step(float(series.times[place[best]]), float(change[best]), float(std[best]), float(chances[best]))


def _has_a_course(series: Series) -> bool:
    """Whether there are enough values, not all of one time."""
    return series.values.size >= FEWEST and float(np.ptp(series.times)) > 0.0


class _Side(NamedTuple):
    """Weighted means on one side of several places, their widened standard deviations, and what they leave."""

    mean: FloatArray
    std: FloatArray
    left: FloatArray


def _sides(series: Series, place: IntArray) -> tuple[_Side, _Side]:
    weights = series.stds**-2.0
    # Less their mean, so that the squares keep their digits
    values = series.values - float(weights @ series.values / weights.sum())
    sums = np.cumsum(np.stack([weights, weights * values, weights * values**2]), axis=1)
    first, second = sums[:, place - 1], sums[:, -1:] - sums[:, place - 1]
    sides = []
    for (total, linear, square), count in ((first, place), (second, values.size - place)):
        left = np.maximum(square - linear**2 / total, 0.0)
        widened = np.sqrt(np.maximum(left / np.maximum(count - 1, 1), 1.0))
        sides.append(_Side(linear / total, widened / np.sqrt(total), left))
    return sides[0], sides[1]


def _time_to_limit(series: Series) -> tuple[float, float] | None:
    """95 % interval of the days to the next limit above (Fieller); None if there is none, or on its way down."""
    line = _line(series.times / _DAY, series.values, series.stds)
    ahead = float(series.times[-1]) / _DAY - line.centre
    now = line.mean + line.slope * ahead
    limit = next((limit for limit in (series.warn, series.error) if math.isfinite(limit) and limit > now), math.nan)
    if not math.isfinite(limit) or line.slope <= 0.0:
        return None
    # Above 0, since no slope is looked at that is not significant
    missing, square = limit - line.mean, line.slope**2 - (BANDS * line.slope_std) ** 2
    root = math.sqrt((line.slope * missing) ** 2 - square * (missing**2 - (BANDS * line.mean_std) ** 2))
    first, last = ((line.slope * missing + sign * root) / square - ahead for sign in (-1.0, 1.0))
    return max(first, 0.0), last


class Mean(NamedTuple):
    """A weighted mean, its standard deviation widened where the values scatter by more than theirs, and by how much."""

    value: float
    std: float
    widened: float


def weighted_mean(values: FloatArray, stds: FloatArray) -> Mean:
    """Average values by their precision."""
    weights = stds**-2.0
    mean = float(weights @ values / weights.sum())
    excess = float(weights @ (values - mean) ** 2) / (values.size - 1) if values.size > 1 else 1.0
    widened = math.sqrt(max(excess, 1.0))
    return Mean(mean, widened / math.sqrt(float(weights.sum())), widened)


class _Line(NamedTuple):
    """A straight line fitted by weighted least squares, its uncertainty widened where the values scatter by more."""

    centre: float
    mean: float
    mean_std: float
    slope: float
    slope_std: float
    left: float
    """Sum of squares that it leaves, in variances."""


def _line(place: FloatArray, values: FloatArray, stds: FloatArray) -> _Line:
    weights = stds**-2.0
    total = float(weights.sum())
    centre, mean = float(weights @ place) / total, float(weights @ values) / total
    spread = float(weights @ (place - centre) ** 2)
    slope = float(weights @ ((place - centre) * values)) / spread
    left = float(weights @ (values - mean - slope * (place - centre)) ** 2)
    widened = max(left / max(values.size - 2, 1), 1.0)
    return _Line(centre, mean, math.sqrt(widened / total), slope, math.sqrt(widened / spread), left)

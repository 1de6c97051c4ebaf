"""A measured quantity of a spline beside its limits, as a status publishes it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..diagnosis.uncertain import decimals, with_std

PARTS = ("flexspline", "circular_spline")
"""By the names in ``component``."""

GROWTH = "line growth"
"""Of a spline's line against its baseline, in place of a limited reading."""

TOO_LARGE = 1e12
"""Magnitude, in any unit here, from which a number is damaged data."""

_HALF_WIDTH = 1.96  # standard deviations on either side of a 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """A quantity of one spline.

    Attributes
    ----------
    part : str
        One of `PARTS`.
    quantity : str
        ``index``, ``share``, ``line growth`` or ``transmission error``, as in the status's keys.
    unit : str
        ``%`` or ``arcmin``.
    value, std : float
        In that unit; `std` is NaN where the status has none.
    warn, error : float
        Limits in that unit; NaN where there are none.
    """

    part: str
    quantity: str
    unit: str
    value: float
    std: float
    warn: float
    error: float

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval; NaN where the deviation is unknown. Only a growth extends below zero."""
        low, high = (self.value + side * _HALF_WIDTH * self.std for side in (-1.0, 1.0))
        return low if self.quantity == GROWTH else max(low, 0.0), high

    @property
    def limited(self) -> bool:
        """Whether there are limits to compare it with."""
        return self.warn > 0.0 and self.error > 0.0

    @property
    def severity(self) -> float:
        """The value over the error limit; NaN without limits."""
        return self.value / self.error if self.limited else math.nan

    @property
    def digits(self) -> int:
        """Decimals of the interval's ends: one fewer than of the value, at least 1 and at most 3."""
        return min(max(decimals(self.std) - 1, 1), 3)

    @property
    def with_std(self) -> str:
        """The value with its standard deviation, to no more than a thousandth: a row has little room."""
        if math.isnan(self.std):
            return f"{self.value:.1f} ± ?"
        return with_std(self.value, self.std) if self.std >= 0.001 else f"{self.value:.3f} ± <0.001"


def readings_of(values: Mapping[str, str]) -> tuple[Reading, ...]:
    """Find the readings among a reducer status's values: of each kind a pair."""
    found = []
    for quantity, unit in (("index", "%"), ("share", "%"), (GROWTH, "%"), ("transmission error", "arcmin")):
        limited = quantity not in ("share", GROWTH)
        warn, error = (
            number(values, f"{level} limit ({unit})") if limited else math.nan for level in ("warn", "error")
        )
        for part in PARTS:
            name = f"{part.replace('_', ' ')} {quantity}"
            value, std = number(values, f"{name} ({unit})"), number(values, f"{name} std ({unit})")
            if not math.isnan(value):
                found.append(
                    Reading(part=part, quantity=quantity, unit=unit, value=value, std=std, warn=warn, error=error)
                )
    return tuple(found)


def number(values: Mapping[str, str], key: str) -> float:
    """Read the value of a key; NaN where it is missing, no number, or damaged: not finite or beyond all measure."""
    try:
        value = float(values[key])
    except (KeyError, ValueError):
        return math.nan
    return value if abs(value) < TOO_LARGE else math.nan

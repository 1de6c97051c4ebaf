"""A value before and after, and whether noise alone makes such a difference."""

import math
from typing import Any, NamedTuple

import scipy

SIGNIFICANT = 0.01
"""Probability below which a change is not an accident of the noise."""


class Change(NamedTuple):
    """A value before and after, both and their standard deviations in the value's unit.

    `p_value` is the probability of so large a difference without a change.
    """

    before: float
    before_std: float
    after: float
    after_std: float
    p_value: float

    @classmethod
    def between(cls, before: float, before_std: float, after: float, after_std: float) -> "Change":
        """Compare two values whose errors are normal and independent."""
        chance = chance_of(after - before, math.hypot(before_std, after_std))
        return cls(before, before_std, after, after_std, chance)

    @property
    def change(self) -> float:
        """After less before."""
        return self.after - self.before

    @property
    def std(self) -> float:
        """Standard deviation of the change."""
        return math.hypot(self.before_std, self.after_std)

    @property
    def significant(self) -> bool:
        """Whether noise alone would hardly make such a difference."""
        return self.p_value < SIGNIFICANT

    def as_dict(self) -> dict[str, Any]:
        """Write it as plain data."""
        return self._asdict() | {"change": self.change, "change_std": self.std, "significant": self.significant}


class Growth(NamedTuple):
    """By how much a value has grown, as a fraction."""

    value: float
    std: float


def chance_of(change: float, std: float) -> float:
    """Return the probability of so large a normally distributed difference without a change."""
    return float(2.0 * scipy.stats.norm.sf(abs(change) / std)) if std > 0.0 else float(change == 0.0)

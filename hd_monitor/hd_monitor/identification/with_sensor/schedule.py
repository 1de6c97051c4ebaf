"""When to look for other solutions: often enough to leave a wrong one, ever more rarely where none is right."""

import math
from dataclasses import dataclass, replace

POOR = 1.5
"""Inflation of the variances, by what the fit leaves at the lines, from which other solutions are sought."""

SECOND_LOOK = 3.5
"""Motion [s] at which the multistart on the first second or so is repeated, if in doubt."""

_EARLY = 4.0  # s of poor fits up to which such a look is soon followed by another one
_SOON, _LATE = 2.0, 6.0  # factors by which the time of poor fits grows between such looks, at first and later
_LEAST_AGE = 2.0  # s of poor fits that a look counts for at least
_APART = 1.2  # factor by which all motion grows between them, if fits are poor now and then


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """When other solutions were looked for, and since when fits have been poor.

    Attributes
    ----------
    looked : float
        Motion [s] seen at the last look.
    poor_since : float
        Motion [s] seen when fits became poor; inf while they are not.
    restarted : float
        Motion [s] seen when all segments kept were last fitted as a whole.
    """

    looked: float = 0.0
    poor_since: float = math.inf
    restarted: float = 0.0

    def after(self, inflation: float, seconds: float) -> "Schedule":
        """Return the schedule after a fit that leaves an `inflation`, with `seconds` of motion seen."""
        return replace(self, poor_since=min(self.poor_since, seconds) if inflation > POOR else math.inf)

    def with_look(self, seconds: float) -> "Schedule":
        """Return the schedule after a look."""
        return replace(self, looked=seconds)

    def is_due(self, inflation: float, seconds: float) -> bool:
        """Whether to look now, after a fit that :meth:`after` was given."""
        if self.looked < SECOND_LOOK:
            return seconds >= SECOND_LOOK and inflation > 1.0
        if not inflation > POOR:
            return False
        if self.looked < self.poor_since:
            return seconds > _APART * self.looked  # what was right so far is right no more
        before, age = self.looked - self.poor_since, seconds - self.poor_since
        return age > (_SOON if before < _EARLY else _LATE) * max(before, _LEAST_AGE)

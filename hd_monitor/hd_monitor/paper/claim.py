"""A claim of the paper beside our own number."""

from dataclasses import dataclass
from enum import StrEnum


class Outcome(StrEnum):
    """What laying a claim beside our number gave."""

    PASS = "pass"
    FAIL = "FAIL"
    CONTRADICTION = "paper contradicts itself"
    """The printed numbers exclude each other; ours confirms that, and the note names the convention chosen."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One statement of the paper, checked.

    Attributes
    ----------
    id : str
        The figure, table or equation, as in ``F13c``.
    statement : str
        What is claimed.
    paper, ours : str
        The paper's printed value and our computed one, with units.
    passed : bool
        Whether ours agrees; for a contradiction, whether our numbers confirm that the printed ones exclude each other.
    note : str
        Why it differs, or which convention was chosen.
    contradiction : bool
        Whether the paper contradicts itself here.
    """

    id: str
    statement: str
    paper: str
    ours: str
    passed: bool
    note: str = ""
    contradiction: bool = False

    def __post_init__(self) -> None:
        """Take numpy's booleans too."""
        object.__setattr__(self, "passed", bool(self.passed))

    @property
    def outcome(self) -> Outcome:
        """Pass, fail, or a contradiction within the paper that our numbers confirm."""
        if not self.passed:
            return Outcome.FAIL
        return Outcome.CONTRADICTION if self.contradiction else Outcome.PASS

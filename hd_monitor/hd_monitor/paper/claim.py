"""A claim of the paper beside our own number."""

from dataclasses import dataclass
from enum import StrEnum


class Outcome(StrEnum):
    """Result of holding a claim against our number."""

    PASS = "pass"
    FAIL = "FAIL"
    CONTRADICTION = "paper contradicts itself"
    """The printed numbers exclude each other; ours confirms that, and the note names the convention chosen."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One statement of the paper, checked.

    Attributes
    ----------
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

    statement: str
    paper: str
    ours: str
    passed: bool
    note: str = ""
    contradiction: bool = False

    @property
    def outcome(self) -> Outcome:
        """Pass, fail, or a contradiction within the paper that our numbers confirm."""
        if not self.passed:
            return Outcome.FAIL
        return Outcome.CONTRADICTION if self.contradiction else Outcome.PASS

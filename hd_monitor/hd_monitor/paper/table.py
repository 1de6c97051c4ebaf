"""The claims as a table for a terminal."""

import textwrap
from collections.abc import Iterable

from .claim import Claim, Outcome
from .exhibit import Exhibit, all_claims

_TAGS = {Outcome.PASS: "pass", Outcome.FAIL: "FAIL", Outcome.CONTRADICTION: "contradiction"}
_INDENT = " " * 21


def _claim_lines(figure: str, claim: Claim, width: int) -> list[str]:
    head = f"{figure:6s}{_TAGS[claim.outcome]:15s}"
    lines = textwrap.wrap(claim.statement, width, initial_indent=head, subsequent_indent=_INDENT)
    for name, text in (("paper", claim.paper), ("ours", claim.ours), ("note", claim.note)):
        if text:
            lines += textwrap.wrap(
                f"{name + ':':7s}{text}", width, initial_indent=_INDENT, subsequent_indent=_INDENT + " " * 7
            )
    return lines


def claim_table(exhibits: Iterable[Exhibit], width: int = 100) -> str:
    """List every claim with the paper's value, ours and the note, wrapped to `width` characters; then the counts."""
    exhibits = tuple(exhibits)
    lines = [line for shown in exhibits for claim in shown.claims for line in _claim_lines(shown.id, claim, width)]
    return "\n".join([*lines, "", summary(all_claims(exhibits))]) if lines else ""


def fact_table(exhibits: Iterable[Exhibit]) -> str:
    """List the results that no claim is held against, by exhibit."""
    lines = []
    for exhibit in exhibits:
        if exhibit.facts:
            lines.append(f"{exhibit.id}  {exhibit.title}")
            lines += [f"    {name}: {value}" for name, value in exhibit.facts]
    return "\n".join(lines)


def summary(claims: Iterable[Claim]) -> str:
    """Say in a sentence how many claims have which outcome."""
    outcomes = [claim.outcome for claim in claims]
    passed, failed, contradicting = (outcomes.count(o) for o in (Outcome.PASS, Outcome.FAIL, Outcome.CONTRADICTION))
    return (
        f"{len(outcomes)} claims: {passed} pass, {contradicting} where the paper contradicts itself (convention "
        f"named), {failed} fail"
    )

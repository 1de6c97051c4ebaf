"""The claims and results as text for a terminal."""

import textwrap
from collections.abc import Iterable, Mapping

from .exhibit import Claim, Exhibit, Outcome

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


def claim_table(exhibits: Mapping[str, Exhibit], width: int = 100) -> str:
    """List every claim with the paper's value, ours and the note, wrapped to `width` characters; then the counts."""
    lines = [
        line for name, shown in exhibits.items() for claim in shown.claims for line in _claim_lines(name, claim, width)
    ]
    return "\n".join([*lines, "", summary(exhibits.values())]) if lines else ""


def fact_table(exhibits: Mapping[str, Exhibit]) -> str:
    """List the results that no claim is held against, by exhibit."""
    lines = []
    for name, exhibit in exhibits.items():
        if exhibit.facts:
            lines.append(f"{name}  {exhibit.title}")
            lines += [f"    {what}: {value}" for what, value in exhibit.facts]
    return "\n".join(lines)


def summary(exhibits: Iterable[Exhibit]) -> str:
    """Say in a sentence how many claims have which outcome."""
    outcomes = [claim.outcome for exhibit in exhibits for claim in exhibit.claims]
    passed, failed, contradicting = (outcomes.count(o) for o in (Outcome.PASS, Outcome.FAIL, Outcome.CONTRADICTION))
    return (
        f"{len(outcomes)} claims: {passed} pass, {contradicting} where the paper contradicts itself (convention "
        f"named), {failed} fail"
    )

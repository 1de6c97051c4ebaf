"""Lines of text for the screen: spans with a role instead of a colour, folded, padded and cut to a width."""

import textwrap
from collections.abc import Iterable
from typing import NamedTuple


class Span(NamedTuple):
    """A piece of a line."""

    text: str
    role: str = ""
    """What it is, for whoever chooses colours: ``ok``, ``warn``, ``error``, ``quiet``, ``strong``; empty: plain."""


type Line = tuple[Span, ...]

_PLAIN = str.maketrans({
    "█": "#", "▒": "~", "·": ".", "│": "|", "─": "-", "▁": "_", "▂": "_", "▃": "-", "▄": "-", "▅": "=", "▆": "=",
    "▇": "#", "≥": ">=", "±": "+-", "°": " deg", "′": "'", "…": "...", "–": "-", "²": "2",
    "θ": "theta", "β": "beta", "ζ": "zeta",
})  # fmt: skip


def line(*parts: str | Span) -> Line:
    """Make a line of spans and plain texts."""
    return tuple(clean(part) if isinstance(part, Span) else clean(Span(part)) for part in parts)


def clean(span: Span) -> Span:
    """Replace what a terminal would obey instead of showing: texts come from the network."""
    if span.text.isprintable():
        return span
    return span._replace(text="".join(letter if letter.isprintable() else " " for letter in span.text))


def plain(row: Line) -> Line:
    """Write a line in ASCII, for terminals that have no other signs."""
    return tuple(
        span._replace(text=span.text.translate(_PLAIN).encode("ascii", "replace").decode("ascii")) for span in row
    )


def text_of(rows: Iterable[Line]) -> str:
    """Return the bare text of lines."""
    return "\n".join("".join(span.text for span in row) for row in rows)


def cut(text: str, width: int) -> str:
    """Return a text padded or cut to a width, with an ellipsis where it is cut."""
    return text.ljust(width) if len(text) <= width else text[: max(width - 1, 0)] + "…"


def labelled(label: str, text: str, width: int, role: str = "") -> list[Line]:
    """Fold a text behind its label, with a hanging indent."""
    indent = 10
    folded = textwrap.wrap(clean(Span(text)).text, max(width - indent, 20)) or [""]
    first = line(Span(cut(label, indent), "quiet"), Span(folded[0], role))
    return [first, *(line(" " * indent, Span(more, role)) for more in folded[1:])]

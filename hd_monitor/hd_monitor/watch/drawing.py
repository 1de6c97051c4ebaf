"""Drawings out of letters: bars against limits, histories and curves."""

import math
from collections.abc import Sequence
from itertools import pairwise

from .answers import standing
from .curves import Curve
from .lines import Line, Span, cut, line
from .reading import Reading
from .trail import MARKS, Trail

_EIGHTHS = " ▁▂▃▄▅▆▇█"
_NAME, _NUMBERS, _WORDS = 21, 30, 12
_HEADS = {
    "index": "stiffness index",
    "share": "share of the pair",
    "line growth": "line growth",
    "transmission error": "transm. err.",
}
_GUTTER = 9
_MARK_ROLES = {".": "ok", "W": "warn", "E": "error"}


def bars(readings: Sequence[Reading], width: int) -> list[Line]:
    """Draw readings of one quantity, on one scale below their limits.

    Solid is what the reading surely has, shaded its 95 % interval; a stroke stands at each limit.
    """
    first, room = readings[0], max(width - _NAME - _NUMBERS, 12)
    limits = [first.warn, first.error] if first.limited else []
    ends = [end for reading in readings for end in (reading.value, reading.interval[1]) if math.isfinite(end)]
    top = max(1.25 * max(limits, default=0.0), *ends) if limits else max(100.0, *ends)
    places = [min(round(limit / top * room), room - 1) for limit in limits]
    head = cut(f"{_HEADS[first.quantity]}, {first.unit}", _NAME)
    rows = [line(Span(head, "quiet"), Span(_scale(first, places, room), "quiet"))]
    for reading in readings:
        low, high = (end if math.isfinite(end) else reading.value for end in reading.interval)
        sure, possible = (round(end / top * room) for end in (low, high))
        cells = ["█" if at < sure else "▒" if at < max(possible, sure + 1) else "·" for at in range(room)]
        for place in places:
            cells[place] = "│"
        numbers = cut(f" {reading.with_std}", _NUMBERS - _WORDS - 1) + " "
        where = standing(reading) if limits else ""
        role = _role(reading)
        name = cut(f" {reading.part.replace('_', ' ')}", _NAME)
        rows.append(line(name, Span("".join(cells), role), numbers, Span(_short(where), role)))
    return rows


def _scale(reading: Reading, places: Sequence[int], room: int) -> str:
    """Name the limits above their strokes, the lower one on the left and the higher one on the right of its stroke."""
    if not places:
        return ""
    left, right = f"warn {reading.warn:g} │", f"│ error {reading.error:g}"
    return f"{left.rjust(places[0] + 1):{places[1]}}{right}"


def _short(where: str) -> str:
    return where.replace(" limit", "").replace("reaches across the", "across").replace("the ", "")


def _role(reading: Reading) -> str:
    if not reading.limited:
        return ""
    return "error" if reading.value >= reading.error else "warn" if reading.value >= reading.warn else "ok"


def history(trail: Trail, width: int) -> list[Line]:
    """Draw how the largest reading went, over its error limit, with a letter below for the level."""
    steps = trail.columns(width)
    marks = line(*(Span(step.mark, _MARK_ROLES.get(step.mark, "quiet")) for step in steps))
    known = [step.severity for step in steps if math.isfinite(step.severity)]
    if not known:
        return [marks]
    top = max([1.25, *known])  # a limit that is reached does not yet fill the row
    parts = [step.severity / top if math.isfinite(step.severity) else None for step in steps]
    return [line("".join(" " if part is None else _EIGHTHS[max(1, round(8 * part))] for part in parts)), marks]


LEGEND = ", ".join(f"{mark} {meaning}" for mark, meaning in MARKS.items())


def chart(curve: Curve, width: int, height: int, unit: str, other: Curve | None = None) -> list[Line]:
    """Draw a curve as columns over an axis with numbers; the points of another one as rings.

    Parameters
    ----------
    curve : Curve
        At least one point.
    width, height : int
        Of the drawing, with its axis.
    unit : str
        Of the abscissa.
    other : Curve, optional
    """
    room, rows = max(width - _GUTTER, 10), max(height - 2, 2)
    points = sorted(set(curve.x + (other.x if other else ())))
    step = min((right - left for left, right in pairwise(points)), default=1.0)
    low, high = points[0] - step / 2.0, points[-1] + step / 2.0
    columns, rings = (_columns(found, low, high, step, room) for found in (curve, other or Curve((), ())))
    top = max(*columns, *rings) or 1.0
    drawn = []
    for below in range(rows - 1, -1, -1):
        cells = []
        for value, ring in zip(columns, rings, strict=True):
            ringed = ring > 0.0 and min(int(ring / top * rows), rows - 1) == below
            cells.append("o" if ringed else _EIGHTHS[min(max(round(8 * (value / top * rows - below)), 0), 8)])
        label = f"{top:.3g}" if below == rows - 1 else "0" if not below else ""
        drawn.append(line(Span(f"{label:>{_GUTTER - 1}} ", "quiet"), Span("".join(cells).rstrip(), "curve")))
    left, right = f"{points[0]:.4g}", f"{points[-1]:.4g} {unit}"
    axis = right.center(room) if len(points) == 1 else left + right.rjust(room - len(left))
    return [*drawn, line(Span(" " * _GUTTER + axis, "quiet"))]


def _columns(curve: Curve, low: float, high: float, step: float, room: int) -> list[float]:
    """Spread a curve's points, each as wide as the smallest step, over so many columns; the largest where they meet."""
    found = [0.0] * room
    for x, y in zip(curve.x, curve.y, strict=True):
        start, end = (int((edge - low) / (high - low) * room) for edge in (x - step / 2.0, x + step / 2.0))
        for at in range(min(start, room - 1), min(max(end, start + 1), room)):
            found[at] = max(found[at], y)
    return found

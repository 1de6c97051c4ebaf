"""What changed in the lines, their ratio and the RMS curve: it needs no torque, so that every mode has it."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import t as t_distribution

from ..change import SIGNIFICANT, Change, chance_of
from ..diagnosis.uncertain import with_std

SPLINES = ("circular_spline", "flexspline")

FEWEST_SPEEDS = 3
"""Speeds in common from which the curves' scatter says how sure their ratio is."""

NOTHING = 1e-100
"""Size below which a ratio to it means nothing."""

LineChanges = Mapping[tuple[int, str], Change]
"""The changes of lines in the signal's unit, by the pair's number k and the spline."""


class CurveChange(NamedTuple):
    """The RMS at the speeds that both curves have, after over before: geometric mean, and its standard deviation."""

    speeds: int
    ratio: float
    ratio_std: float
    p_value: float


def line_changes(before: Sequence[Mapping[str, Any]], after: Sequence[Mapping[str, Any]]) -> LineChanges:
    """Compare the lines that both results have with their standard deviations."""
    old, new = ({line["k"]: line for line in lines} for lines in (before, after))
    found = {
        (k, spline): change_between(old[k], new[k], spline)
        for k in sorted(old.keys() & new.keys())
        for spline in SPLINES
    }
    return {place: change for place, change in found.items() if change is not None}


def change_between(before: Mapping[str, Any], after: Mapping[str, Any], name: str) -> Change | None:
    """Compare a value that is written with its standard deviation, ``name`` and ``name_std``; None where one lacks."""
    values = [side.get(key) for side in (before, after) for key in (name, f"{name}_std")]
    known = [float(value) for value in values if value is not None]
    return Change.between(*known) if len(known) == len(values) else None


def ratio_change(lines: LineChanges) -> Change | None:
    """Compare the first pair's ratio, flexspline over circular spline, by its logarithm; None without both lines."""
    cs, fs = (lines.get((1, spline)) for spline in SPLINES)
    if cs is None or fs is None or min(cs.before, cs.after, fs.before, fs.after) <= NOTHING:
        return None
    old, new = fs.before / cs.before, fs.after / cs.after
    old_std = math.hypot(fs.before_std / fs.before, cs.before_std / cs.before)
    new_std = math.hypot(fs.after_std / fs.after, cs.after_std / cs.after)
    chance = chance_of(math.log(new / old), math.hypot(old_std, new_std))
    return Change(old, old * old_std, new, new * new_std, chance)


def curve_change(
    before: Sequence[Mapping[str, Any]], after: Sequence[Mapping[str, Any]], width: float
) -> CurveChange | None:
    """Compare two RMS curves speed by speed; None where they have too few bins of `width` [rpm] in common."""
    old, new = ({round(b["rpm"] / width): b["rms"] for b in curve if b["rms"] > NOTHING} for curve in (before, after))
    common = sorted(old.keys() & new.keys())
    if len(common) < FEWEST_SPEEDS:
        return None
    logs = np.log([new[place] / old[place] for place in common])
    mean, std = float(logs.mean()), float(logs.std(ddof=1)) / math.sqrt(len(common))
    chance = float(2.0 * t_distribution.sf(abs(mean) / std, len(common) - 1)) if std > 0.0 else float(mean == 0.0)
    return CurveChange(len(common), math.exp(mean), math.exp(mean) * std, chance)


def describe_lines(lines: LineChanges, ratio: Change | None) -> Iterator[str]:
    """Say which lines changed significantly, and how the first pair's ratio did."""
    changed = {place: change for place, change in lines.items() if change.significant}
    for (k, spline), change in changed.items():
        verb = "grew" if change.after > change.before else "fell"
        by = f" by {100.0 * abs(change.after / change.before - 1.0):.0f} %" if change.before > NOTHING else ""
        old, new = with_std(change.before, change.before_std), with_std(change.after, change.after_std)
        name = f"{spline.replace('_', ' ')}'s line k = {k}"
        yield f"The {name} {verb}{by}: {old} before, {new} after (p {_p(change.p_value)})."
    if lines and not changed:
        yield "No line changed significantly."
    if ratio is not None and ratio.significant:
        yield (
            f"The flexspline's first line went from {with_std(ratio.before, ratio.before_std)} to "
            f"{with_std(ratio.after, ratio.after_std)} times the circular spline's (p {_p(ratio.p_value)})."
        )


def describe_curve(change: CurveChange) -> str:
    """Say how the vibration changed over all speeds."""
    percent = f"{with_std(100.0 * change.ratio, 100.0 * change.ratio_std)} %"
    if change.p_value >= SIGNIFICANT:
        return f"Over {change.speeds} common speeds the vibration did not change significantly ({percent} of before)."
    return f"Over {change.speeds} common speeds the vibration is {percent} of before (p {_p(change.p_value)})."


def _p(value: float) -> str:
    return "< 0.001" if value < 0.001 else f"= {value:.2g}"

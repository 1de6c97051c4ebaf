"""What changed in the lines, their ratio and the RMS curve: it needs no torque, so that every mode has it."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import norm
from scipy.stats import t as t_distribution

SIGNIFICANT = 0.01
"""Probability below which a change is not an accident of the noise."""

SPLINES = ("circular_spline", "flexspline")

FEWEST_SPEEDS = 3
"""Speeds in common from which the curves' scatter says how sure their ratio is."""

_NOTHING = 1e-100  # below it ratios mean nothing


class LineChange(NamedTuple):
    """A line before and after, in the signal's unit."""

    k: int
    spline: str
    before: float
    before_std: float
    after: float
    after_std: float
    p_value: float


class RatioChange(NamedTuple):
    """The first pair's ratio, flexspline over circular spline, before and after."""

    before: float
    before_std: float
    after: float
    after_std: float
    p_value: float


class CurveChange(NamedTuple):
    """The RMS at the speeds that both curves have, after over before: geometric mean, and its standard deviation."""

    speeds: int
    ratio: float
    ratio_std: float
    p_value: float


def chance_of(change: float, std: float) -> float:
    """Return the probability of such a difference without a change."""
    return float(2.0 * norm.sf(abs(change) / std)) if std > 0.0 else float(change == 0.0)


def as_entry(change: LineChange | RatioChange) -> dict[str, Any]:
    """Write a change as plain data."""
    return change._asdict() | {
        "change": change.after - change.before,
        "change_std": math.hypot(change.before_std, change.after_std),
        "significant": change.p_value < SIGNIFICANT,
    }


def line_changes(before: Sequence[Mapping[str, Any]], after: Sequence[Mapping[str, Any]]) -> tuple[LineChange, ...]:
    """Compare the lines that both results have with their standard deviations."""
    old, new = ({line["k"]: line for line in lines} for lines in (before, after))
    return tuple(change for k in sorted(old.keys() & new.keys()) for change in _pair(k, old[k], new[k]))


def _pair(k: int, before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[LineChange]:
    for spline in SPLINES:
        values = [line.get(name) for line in (before, after) for name in (spline, f"{spline}_std")]
        known = [float(value) for value in values if value is not None]
        if len(known) == len(values):
            old, old_std, new, new_std = known
            yield LineChange(k, spline, old, old_std, new, new_std, chance_of(new - old, math.hypot(old_std, new_std)))


def ratio_change(lines: Sequence[LineChange]) -> RatioChange | None:
    """Compare the ratio of the first pair's lines, by its logarithm; None without all four of them."""
    pair = {change.spline: change for change in lines if change.k == 1}
    if len(pair) < 2 or not all(min(change.before, change.after) > _NOTHING for change in pair.values()):
        return None
    cs, fs = pair["circular_spline"], pair["flexspline"]
    old, new = fs.before / cs.before, fs.after / cs.after
    old_std = math.hypot(fs.before_std / fs.before, cs.before_std / cs.before)
    new_std = math.hypot(fs.after_std / fs.after, cs.after_std / cs.after)
    chance = chance_of(math.log(new / old), math.hypot(old_std, new_std))
    return RatioChange(old, old * old_std, new, new * new_std, chance)


def curve_change(
    before: Sequence[Mapping[str, Any]], after: Sequence[Mapping[str, Any]], width: float
) -> CurveChange | None:
    """Compare two RMS curves speed by speed; None where they have too few bins of `width` [rpm] in common."""
    old, new = ({round(b["rpm"] / width): b["rms"] for b in curve if b["rms"] > _NOTHING} for curve in (before, after))
    common = sorted(old.keys() & new.keys())
    if len(common) < FEWEST_SPEEDS:
        return None
    logs = np.log([new[place] / old[place] for place in common])
    mean, std = float(logs.mean()), float(logs.std(ddof=1)) / math.sqrt(len(common))
    chance = float(2.0 * t_distribution.sf(abs(mean) / std, len(common) - 1)) if std > 0.0 else float(mean == 0.0)
    return CurveChange(len(common), math.exp(mean), math.exp(mean) * std, chance)


def describe_lines(lines: Sequence[LineChange], ratio: RatioChange | None) -> Iterator[str]:
    """Say which lines changed significantly, and how the first pair's ratio did."""
    changed = [change for change in lines if change.p_value < SIGNIFICANT]
    for change in changed:
        verb = "grew" if change.after > change.before else "fell"
        by = f" by {100.0 * abs(change.after / change.before - 1.0):.0f} %" if change.before > _NOTHING else ""
        old, new = f"{change.before:.3g} ± {change.before_std:.1g}", f"{change.after:.3g} ± {change.after_std:.1g}"
        name = f"{change.spline.replace('_', ' ')}'s line k = {change.k}"
        yield f"The {name} {verb}{by}: {old} before, {new} after (p {_p(change.p_value)})."
    if lines and not changed:
        yield "No line changed significantly."
    if ratio is not None and ratio.p_value < SIGNIFICANT:
        yield (
            f"The flexspline's first line went from {ratio.before:.3g} ± {ratio.before_std:.1g} to {ratio.after:.3g} ± "
            f"{ratio.after_std:.1g} times the circular spline's (p {_p(ratio.p_value)})."
        )


def describe_curve(change: CurveChange) -> str:
    """Say how the vibration changed over all speeds."""
    percent = f"{100.0 * change.ratio:.0f} ± {100.0 * change.ratio_std:.1g} %"
    if change.p_value >= SIGNIFICANT:
        return f"Over {change.speeds} common speeds the vibration did not change significantly ({percent} of before)."
    return f"Over {change.speeds} common speeds the vibration is {percent} of before (p {_p(change.p_value)})."


def _p(value: float) -> str:
    return "< 0.001" if value < 0.001 else f"= {value:.2g}"

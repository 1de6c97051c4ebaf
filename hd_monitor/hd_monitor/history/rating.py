"""Without a torque a line's size says nothing; its growth against the baseline does."""

import math
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

import scipy

from ..change import Growth
from ..diagnosis.uncertain import with_std
from ..diagnosis.verdict import Cause, Component, FaultCode, Level, Verdict
from ..identification.result import Identification
from ..limitation import LimitationCode
from ..orders.rms_curve import SpeedBin
from ..settings.groups import DiagnosisSettings
from .entry import Entry, Kind
from .property_curves import property_curves
from .series import Motion, baseline_entries, comparable_entries, lines_of, repeated_motion, series_of
from .trend import Mean, weighted_mean

CHANCE = 1e-3
"""Probability of noise alone making a line seem so much larger, below which it has grown."""

SMALLEST = 0.5
"""Part of the larger line, in the baseline, to which the growth of a smaller one is related: next to nothing doubles
easily."""

_NAMES = {Component.FLEXSPLINE: "flexspline", Component.CIRCULAR_SPLINE: "circular spline"}
_NO_NAME = {
    LimitationCode.NO_LINE_FOUND,
    LimitationCode.LINES_TOO_SIMILAR,
    LimitationCode.DIRECTIONS_DISAGREE,
    LimitationCode.RECORDINGS_DISAGREE,
}
"""What leaves open which line is the larger one, but not whether one has grown."""


class Baseline(NamedTuple):
    """The first pair as it should be."""

    lines: Mapping[Component, Mean]
    """Amplitude of each spline's."""
    motion: Motion = ()
    """The one motion that showed it, again and again; empty where they differed."""
    rms_curve: tuple[SpeedBin, ...] = ()


def baseline_of(entries: Sequence[Entry]) -> Baseline | None:
    """Return the first pair in the baseline; None as long as it is neither set nor complete."""
    base = baseline_entries(entries)
    is_set = any(entry.kind is Kind.BASELINE for entry in entries)
    if not base or (base[-1] is comparable_entries(entries)[-1] and not is_set):
        return None
    found = {series.name: series for series in series_of(base)}
    lines = {}
    for component, name in _NAMES.items():
        if (series := found.get(f"{name} line 1")) is None:
            return None
        lines[component] = weighted_mean(series.values, series.stds)
    curve, _ = property_curves(entries)
    return Baseline(lines, repeated_motion(base), curve)


def rated(
    verdict: Verdict, found: Identification | None, baseline: Baseline | None, limits: DiagnosisSettings
) -> Verdict:
    """Return the verdict with the level that the growth of the lines against the baseline calls for.

    Absolute verdicts stay as they are, and so do those on data that say nothing of growth.
    """
    growth = growth_of(found, baseline)
    if not growth or found is None or not _may_be_rated(verdict, found):
        return verdict
    told = ", ".join(
        f"{_NAMES[part]} {with_std(100 * size, 100 * std, sign='+')} %" for part, (size, std) in growth.items()
    )
    told += f" against the baseline, warn limit {100 * limits.warn_growth:g} %"
    surely = float(scipy.stats.norm.isf(CHANCE))
    grown = {part: size for part, (size, std) in growth.items() if size > surely * std}
    beyond = {part: size for part, size in grown.items() if size >= limits.warn_growth}
    if not beyond:
        if max(std for _, std in growth.values()) * surely > limits.warn_growth:
            return verdict  # such a growth could have been missed
        said = f"{_who(grown)} grown, by less than the warn limit" if grown else "Neither spline's line has grown"
        return Verdict(
            component=Component.NONE,
            level=Level.OK,
            fault_code=FaultCode.OK,
            reason=f"{said} ({told})",
            cause=Cause.RELATIVE,
        )
    largest = max(beyond, key=lambda part: beyond[part])
    both = len(beyond) == 2 and min(beyond.values()) >= limits.both_ratio * beyond[largest]
    level = Level.ERROR if beyond[largest] >= limits.error_growth else Level.WARN
    named = tuple(beyond) if both else (largest,)
    part = Component.BOTH if both else largest
    return Verdict.naming(part, level, f"{_who(named)} grown ({told})", Cause.RELATIVE, rated=True)


def _who(parts: Collection[Component]) -> str:
    if len(parts) == 2:
        return "Both splines' lines have"
    (part,) = parts
    return f"The {_NAMES[part]}'s line has"


def _may_be_rated(verdict: Verdict, found: Identification) -> bool:
    if verdict.fault_code is FaultCode.UNRATED:
        return True
    codes = {blocker.code for blocker in found.blockers}
    unnamed = verdict.fault_code in (FaultCode.UNDETERMINED, FaultCode.WAITING)
    return unnamed and bool(codes) and codes <= _NO_NAME


def growth_of(found: Identification | None, baseline: Baseline | None) -> dict[Component, Growth]:
    """Return the growth of each spline's first line; nothing without a baseline, and where the indexes are absolute."""
    if found is None or baseline is None or not found.relative:
        return {}
    line = next((line for line in lines_of(found.lines, found.evidence, baseline.motion) if line.k == 1), None)
    if line is None:
        return {}
    growth = {}
    larger = max(base.value for base in baseline.lines.values())
    for part, base in baseline.lines.items():
        amplitude, std = (getattr(pair, part.value) for pair in (line.amplitude, line.std))
        size = max(base.value, SMALLEST * larger)
        growth[part] = Growth((amplitude - base.value) / size, math.hypot(std * base.widened, base.std) / size)
    return growth

"""The page of a ledger: every reducer a tile, which opens to its curves."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...diagnosis.verdict import Component, Level, Verdict
from ...history.series import SPLINES, Series
from ...history.trend import BANDS
from ..history import Reading, ReducerHistory
from ..plots.readings import readings_plot
from ..plots.rms_curve import rms_plot
from ..plots.style import png
from .page import write_page

_WIDTH, _HEIGHT = 288.0, 40.0
"""Size of a sparkline [px]."""

_NEWEST = 120
"""Values that a sparkline shows at most."""


def write_history(folder: Path, content: Mapping[str, Any], histories: Sequence[ReducerHistory]) -> Path:
    """Write the page of a ledger, whose JSON is `content`, as `write_page` does; the worst reducer comes first."""
    ordered = sorted(histories, key=lambda history: -_level(history))
    sections = [_section(history) for history in ordered]
    names = sorted({name for section in sections for name in section["pictures"]})
    return write_page(folder, "offline/report/history.html.j2", content, sections, names)


def _level(history: ReducerHistory) -> int:
    return int(history.verdict.level) if history.verdict else -1


def _section(history: ReducerHistory) -> dict[str, Any]:
    verdict = history.verdict
    return {
        "joint": f"{history.reducer.serial or history.joint}",
        "title": str(history.reducer),
        "place": history.joint if history.reducer.serial else "",
        "level": Level(verdict.level).name if verdict else "none",
        "component": _component(verdict),
        "reason": verdict.reason if verdict else "",
        "seen": history.seen,
        "entries": len(history.entries),
        "rows": [_row(reading) for reading in _main(history.readings)],
        "remarks": history.remarks,
        "pictures": _pictures(history.readings) | _property_curves(history),
    }


def _main(readings: Sequence[Reading]) -> list[Reading]:
    """Return what a tile shows: what has limits, or without any both first lines."""
    limited = [reading for reading in readings if math.isfinite(reading.series.error)]
    return limited or [reading for reading in readings if reading.series.name.endswith("line 1")]


def _component(verdict: Verdict | None) -> str:
    if verdict is None:
        return "no verdict yet"
    return "no part accused" if verdict.component is Component.NONE else verdict.component.value.replace("_", " ")


def _row(reading: Reading) -> dict[str, Any]:
    series = reading.series
    bar = _bar(series) if math.isfinite(series.error) else None
    return {"name": series.name, "text": reading.newest, "bar": bar, "spark": _sparkline(series)}


def _bar(series: Series) -> dict[str, Any]:
    """Lengths in per cent of a scale that ends at one and a half times the error limit."""
    scale, value = 100.0 / (1.5 * series.error), float(series.values[-1])
    return {
        "level": Level((value >= series.warn) + (value >= series.error)).name,
        "value": min(value * scale, 100.0),
        "warn": series.warn * scale,
        "error": series.error * scale,
    }


def _sparkline(series: Series) -> dict[str, Any]:
    """Points of the values and of the outline of their 95 % intervals, in px from the upper left."""
    values, stds = series.values[-_NEWEST:], series.stds[-_NEWEST:]
    low, high = values - BANDS * stds, values + BANDS * stds
    bottom, top = float(low.min()), float(high.max())
    across = np.linspace(2.0, _WIDTH - 2.0, values.size) if values.size > 1 else np.array([0.5 * _WIDTH])

    def points(x: Any, y: Any) -> str:
        down = 2.0 + (_HEIGHT - 4.0) * (top - y) / max(top - bottom, 1e-300)
        return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, down, strict=True))

    line = points(across, values)
    return {
        "line": line,
        "last": line.rpartition(" ")[2].split(","),
        "band": points(np.concatenate([across, across[::-1]]), np.concatenate([high, low[::-1]])),
        "width": _WIDTH,
        "height": _HEIGHT,
    }


def _property_curves(history: ReducerHistory) -> dict[str, bytes]:
    """Plot the RMS by speed in the baseline and since, if there is one of both."""
    if not all(history.curves):
        return {}
    return {"rms_curve": png(rms_plot(*history.curves, critical=(), title="Vibration over speed"))}


def _pictures(readings: Sequence[Reading]) -> dict[str, bytes]:
    """One plot for both splines of each kind of reading, and one for what has no spline."""
    groups: dict[str, list[Reading]] = {}
    for reading in readings:
        kind = reading.series.name
        for spline in SPLINES:
            kind = kind.removeprefix(f"{spline.replace('_', ' ')} ")
        groups.setdefault(kind, []).append(reading)
    return {
        kind.replace(" ", "_").replace(",", ""): png(readings_plot(kind, [reading.series for reading in group]))
        for kind, group in groups.items()
    }

"""The indexes over time with their error bars, the limits and the verdict's level."""

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ...arrays import FloatArray
from ...history.trend import BANDS
from .style import CIRCULAR_SPLINE, ERROR_COLOUR, FLEXSPLINE, INK, WARN_COLOUR, legend_above, limits, new_figure

_LEVELS = ("OK", "WARN", "ERROR")
_LEVEL_COLOURS = ("#56B4E9", WARN_COLOUR, ERROR_COLOUR)
_LEVEL_HATCHES = ("", "///", "xxx")


def indexes_plot(
    timeline: Sequence[Mapping[str, Any]], *, warn: float, error: float, relative: bool, title: str
) -> Figure:
    """Draw the timeline of a replay's JSON: both indexes [%] with their 95 % bands over time [s], level below.

    The limits apply to indexes that are not relative only.
    """
    stamps = np.array([entry["stamp"] for entry in timeline], dtype=np.int64)
    seconds = (stamps - stamps[0]) / 1e9
    step = float(np.median(np.diff(seconds))) if seconds.size > 1 else 1.0
    seconds += step  # the first entry speaks of the time before it
    with new_figure((8.0, 4.6)) as figure:
        axes, below = figure.subplots(2, 1, sharex=True, height_ratios=(8, 1))
        highest = 0.0 if relative else error
        for look, name in ((CIRCULAR_SPLINE, "circular_spline_index"), (FLEXSPLINE, "flexspline_index")):
            value, std = _numbers(timeline, name), _numbers(timeline, f"{name}_std")
            low, high = 100 * np.maximum(value - BANDS * std, 0.0), 100 * (value + BANDS * std)
            axes.fill_between(seconds, low, high, color=look.colour, alpha=0.2, linewidth=0)
            axes.plot(
                seconds, 100 * value, look.line, color=look.colour, label=look.label, marker=look.marker,
                markersize=4.0, markevery=max(1, seconds.size // 25),
            )  # fmt: skip
            settled = value[np.isfinite(value)]
            if settled.size:
                highest = max(highest, float(settled.max()), float((value + std)[np.isfinite(value)][-1]))
        if not relative:
            limits(axes, warn, error)
        axes.set_ylim(0.0, 115.0 * max(highest, 1e-6))
        axes.set_ylabel("relative index [%]" if relative else "stiffness index [%]")
        axes.set_title(title)
        legend_above(axes)
        _levels(below, seconds, step, [int(entry["level"]) for entry in timeline])
        below.set_xlabel("time [s]")
        return figure


def _levels(axes: Any, seconds: FloatArray, step: float, levels: Sequence[int]) -> None:
    """Draw the level as a ribbon, hatched, so that its colours are not needed."""
    changes = np.flatnonzero((np.diff(levels) != 0) | (np.diff(seconds) >= 2 * step)) + 1
    for first, end in itertools.pairwise([0, *changes.tolist(), len(levels)]):
        level = levels[first]
        axes.axvspan(
            seconds[first] - step, seconds[end - 1], facecolor=_LEVEL_COLOURS[level], alpha=0.55,
            hatch=_LEVEL_HATCHES[level], edgecolor="white", linewidth=0,
            label="_" if level in levels[:first] else _LEVELS[level],
        )  # fmt: skip
    axes.set_yticks([])
    axes.set_ylim(0, 1)
    axes.grid(visible=False)
    axes.set_xlim(seconds[0] - step, seconds[-1])
    axes.set_ylabel("level", rotation=0, ha="right", va="center", color=INK)
    axes.legend(loc="upper right", bbox_to_anchor=(1.0, -0.45), ncols=3, handlelength=1.6)


def _numbers(timeline: Sequence[Mapping[str, Any]], name: str) -> FloatArray:
    return np.array([np.nan if entry[name] is None else entry[name] for entry in timeline], dtype=np.float64)

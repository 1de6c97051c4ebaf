"""Drawing of panels with matplotlib; no other module here imports it."""

import io
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from .exhibit import Exhibit, Mark, Panel, Style, Surface

_WIDTH, _HEIGHT = 5.6, 3.8  # inches of a panel
_COLOURS = ("#1f5fa8", "#d1603d", "#3f8f5b", "#8a5aa8", "#7a6a3a", "#4f4f4f")
_LINES: dict[Style, dict[str, Any]] = {
    "line": {"linestyle": "-", "linewidth": 1.2},
    "fine": {"linestyle": "-", "linewidth": 0.4},
    "dashed": {"linestyle": "--", "linewidth": 1.2},
    "points": {"linestyle": "", "marker": "o", "markersize": 3.5},
    "dotted points": {"linestyle": ":", "linewidth": 1.0, "marker": "*", "markersize": 6},
}
_MOST_COLUMNS = 4  # of a legend


def figure_of(name: str, exhibit: Exhibit) -> Figure:
    """Draw an exhibit's panels side by side, under its name and title."""
    count = len(exhibit.panels)
    columns = min(count, 2)
    rows = -(-count // columns)
    width = _HEIGHT * 1.15 if all(panel.equal for panel in exhibit.panels) else _WIDTH * (1.25 if count == 1 else 1.0)
    figure = Figure(figsize=(width * columns, _HEIGHT * rows), layout="constrained")
    places = np.minimum(np.arange(rows * columns), count - 1).reshape(rows, columns)  # the last one fills its row
    for number, axes in figure.subplot_mosaic(places.tolist()).items():
        _draw(axes, exhibit.panels[number], figure)
    figure.suptitle(f"{name}  {exhibit.title}", fontsize=11, fontweight="bold")
    return figure


def png(name: str, exhibit: Exhibit) -> bytes:
    """Return the drawing as PNG."""
    buffer = io.BytesIO()
    figure_of(name, exhibit).savefig(buffer, format="png", dpi=110)
    return buffer.getvalue()


def _draw(axes: Axes, panel: Panel, figure: Figure) -> None:
    axes.set_title(panel.title, fontsize=10)
    axes.set_xlabel(panel.x_label, fontsize=9)
    axes.set_ylabel(panel.y_label, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.grid(visible=True, color="#e4e4e4", linewidth=0.6)
    axes.set_axisbelow(True)
    if panel.surface is not None:
        _draw_surface(axes, panel.surface, figure)
    for number, curve in enumerate(panel.curves):
        colour, label = _COLOURS[number % len(_COLOURS)], curve.label or "_"  # matplotlib's legend leaves out a "_"
        if curve.style == "stems":
            axes.vlines(curve.x, 0.0, curve.y, color=colour, label=label, linewidth=6.0, alpha=0.45)
        else:
            axes.plot(curve.x, curve.y, color=colour, label=label, **_LINES[curve.style])
    if panel.log_y:
        axes.set_yscale("log")
    if panel.x_range is not None:
        axes.set_xlim(*panel.x_range)
    elif panel.surface is None and panel.curves and not panel.equal:
        axes.margins(x=0.02)
    if panel.x_step is not None:
        axes.xaxis.set_major_locator(MultipleLocator(panel.x_step))
    if panel.y_range is not None:
        axes.set_ylim(*panel.y_range)
    elif any(mark.axis == "x" for mark in panel.marks) and panel.surface is None:
        low, high = axes.get_ylim()  # leave space for the marks' labels above the curves
        axes.set_ylim(low, high * (high / low) ** 0.25 if panel.log_y else high + 0.25 * (high - low))
    if panel.equal:
        axes.set_box_aspect(1.0)
    for mark in panel.marks:
        _draw_mark(axes, mark, on_surface=panel.surface is not None)
    if labels := sum(bool(curve.label) for curve in panel.curves):
        columns = min(labels, _MOST_COLUMNS)
        axes.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=columns)


def _draw_surface(axes: Axes, surface: Surface, figure: Figure) -> None:
    # 0 in the middle of the colours; values far below it must not all get one dark tone
    largest = max(float(surface.values.max()), -2.5 * float(surface.values.min()))
    grid = surface.x, surface.y, surface.values
    image = axes.pcolormesh(*grid, cmap="RdBu_r", vmin=-largest, vmax=largest, shading="gouraud", rasterized=True)
    bar = figure.colorbar(image, ax=axes)
    bar.set_label(surface.label, fontsize=9)
    bar.ax.tick_params(labelsize=8)
    if surface.values.min() < 0.0 < surface.values.max():
        axes.contour(*grid, levels=[0.0], colors="black", linewidths=1.4)


def _draw_mark(axes: Axes, mark: Mark, *, on_surface: bool) -> None:
    colour = "#303030" if on_surface else "#707070"
    box = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 1.0} if on_surface else None
    if mark.axis == "x":
        axes.axvline(mark.at, color=colour, linewidth=0.8, linestyle=":")
        axes.annotate(
            mark.label, (mark.at, 0.98), xycoords=("data", "axes fraction"), xytext=(-2, 0), textcoords="offset points",
            rotation=90, fontsize=7.5, color=colour, ha="right", va="top", bbox=box,
        )  # fmt: skip
    else:
        axes.axhline(mark.at, color=colour, linewidth=0.8, linestyle=":")
        along = {"left": 0.01, "center": 0.5, "right": 0.99}[mark.place]
        axes.annotate(
            mark.label, (along, mark.at), xycoords=("axes fraction", "data"), xytext=(0, -2 if mark.below else 2),
            textcoords="offset points", fontsize=7.5, color=colour, ha=mark.place, va="top" if mark.below else "bottom",
        )  # fmt: skip

"""Both indexes before and after, with their error bars and the limits."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from ...change import Change
from ...history.trend import BANDS
from .style import AFTER, BEFORE, INK, legend_above, limits, one_panel


def index_change_plot(changes: Mapping[str, Change], *, warn: float, error: float, title: str) -> Figure:
    """Draw the changes of indexes (fractions, by spline) as pairs of columns with 95 % bars."""
    with one_panel((8.0, 3.9), title=title, ylabel="stiffness index [%]") as (figure, axes):
        axes.grid(visible=False, axis="x")
        highest = 100 * error
        for place, change in enumerate(changes.values()):
            sides = (
                (-0.19, BEFORE, change.before, change.before_std, ""),
                (0.19, AFTER, change.after, change.after_std, "//"),
            )
            for shift, look, value, std, hatch in sides:
                axes.bar(
                    place + shift, 100 * value, 0.34, color=look.colour, alpha=0.85, hatch=hatch, edgecolor="white",
                    linewidth=0, label=look.label if place == 0 else "_",
                )  # fmt: skip
                axes.errorbar(place + shift, 100 * value, yerr=100 * BANDS * std, color=INK, capsize=4.0, linewidth=1.4)
                top = 100 * (value + BANDS * std)
                axes.annotate(
                    f"{100 * value:.2f} %", (place + shift, top), xytext=(0, 4), textcoords="offset points",
                    ha="center", fontsize=10, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
                )  # fmt: skip
                highest = max(highest, top)
        limits(axes, warn, error)
        axes.set_xticks(range(len(changes)), [spline.replace("_", " ") for spline in changes])
        axes.set(xlim=(-0.6, len(changes) - 0.15), ylim=(0.0, 1.18 * highest))
        legend_above(axes)
        return figure

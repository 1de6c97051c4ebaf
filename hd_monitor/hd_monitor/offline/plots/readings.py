"""Readings of a reducer over its life, with their intervals and limits."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from ...history.series import Series
from ...history.trend import BANDS
from .style import CIRCULAR_SPLINE, FLEXSPLINE, INK, Look, legend_above, limits, one_panel

_BY_ITSELF = Look(label="value", colour=INK, marker="o", line="-")


def readings_plot(title: str, several: Sequence[Series]) -> Figure:
    """Draw series of one kind over time, with 95 % bars; the values of the baseline are hollow."""
    is_index = title == "index"
    unit = "%" if is_index else several[0].unit
    label = f"{title} [{unit}]" if unit and unit != "signal's" else f"{title} [the signal's unit]" if unit else title
    with one_panel(title=title[:1].upper() + title[1:], ylabel=label) as (figure, axes):
        scale = 100.0 if is_index else 1.0
        for series in several:
            looks = (each for each in (FLEXSPLINE, CIRCULAR_SPLINE) if series.name.startswith(each.label))
            look = next(looks, _BY_ITSELF)
            times = (1e3 * series.times).astype("datetime64[ms]")
            axes.errorbar(
                times, scale * series.values, yerr=scale * BANDS * series.stds, color=look.colour, linestyle=look.line,
                linewidth=1.2, elinewidth=0.9, capsize=2.0, label=look.label,
            )  # fmt: skip
            for base, face in ((True, "white"), (False, look.colour)):
                own = series.is_baseline == base
                axes.plot(
                    times[own], scale * series.values[own], look.marker, color=look.colour, markerfacecolor=face,
                    markersize=4.5,
                )  # fmt: skip
        if is_index:
            limits(axes, several[0].warn, several[0].error)
            axes.set_ylim(bottom=0.0)
        legend_above(axes)
        return figure

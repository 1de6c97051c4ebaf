"""One look for all plots: legible, on white, distinct in shape as well as in colours that every eye can distinguish."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ...arrays import FloatArray

DOTS_PER_INCH = 150
WIDE = (8.0, 4.2)
"""Size of a plot [inches]."""
INK, SOFT, GRID = "#1d2430", "#5b6675", "#e3e7ec"


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """How one of several things is drawn."""

    label: str
    colour: str
    marker: str
    line: str


# Blue and vermillion of Okabe and Ito's palette: different in brightness too, so that a grey print tells them apart.
CIRCULAR_SPLINE = Look(label="circular spline", colour="#0072B2", marker="o", line="-")
FLEXSPLINE = Look(label="flexspline", colour="#D55E00", marker="s", line="--")
BEFORE = Look(label="before", colour="#7A5C00", marker="o", line="-")
AFTER = Look(label="after", colour="#009E73", marker="s", line="--")
WARN_COLOUR, ERROR_COLOUR = "#B08900", "#A3001E"

_SETTINGS: Any = {
    "font.size": 10.5,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.titlesize": 11.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 10.0,
    "axes.grid": True,
    "date.converter": "concise",
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


@contextmanager
def new_figure(size: tuple[float, float] = WIDE) -> Iterator[Figure]:
    """Give a figure in this look, drawn without a display; nothing global is changed afterwards."""
    with mpl.rc_context(_SETTINGS):
        figure = Figure(figsize=size, layout="constrained")
        FigureCanvasAgg(figure)
        yield figure


@contextmanager
def one_panel(size: tuple[float, float] = WIDE, **labels: str) -> Iterator[tuple[Figure, Axes]]:
    """Give a figure with one pair of axes; `labels` are their title, xlabel and ylabel."""
    with new_figure(size) as figure:
        axes = figure.add_subplot()
        axes.set(**labels)
        yield figure, axes


def png(figure: Figure) -> bytes:
    """Return a figure as PNG."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=DOTS_PER_INCH)
    return buffer.getvalue()


def draw_spectrum(axes: Axes, position: FloatArray, amplitude: FloatArray) -> None:
    """Draw an amplitude spectrum on a linear scale, the area below it shaded, over the whole width."""
    axes.fill_between(position, amplitude, color=INK, alpha=0.08, linewidth=0)
    axes.plot(position, amplitude, color=INK, linewidth=1.5)
    axes.set_xlim(position[0], position[-1])
    axes.set_ylim(bottom=0.0)


def room_above(axes: Axes, share: float) -> None:
    """Leave a share of the height free above the data, for labels."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + share * (high - low))


def legend_above(axes: Axes, **options: Any) -> None:
    """Put the legend at the top right, beside the title and out of the data's way."""
    axes.legend(**({"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 3, "borderaxespad": 0.2} | options))


def name_at_top(axes: Axes, position: float, name: str, **options: Any) -> None:
    """Write a name at the upper edge, to the right of a position on the x-axis."""
    axes.annotate(
        name, (position, 0.985), xycoords=("data", "axes fraction"), xytext=(3, 0), textcoords="offset points",
        va="top", fontsize=9, **options,
    )  # fmt: skip


def natural_frequency_label(frequency: float) -> str:
    """Name a natural frequency [Hz] in a legend."""
    return f"natural frequency {frequency:.1f} Hz"


def limits(axes: Axes, warn: float, error: float) -> None:
    """Draw the two limits on the indexes, in per cent."""
    for value, colour, name in ((warn, WARN_COLOUR, "warn"), (error, ERROR_COLOUR, "error")):
        axes.axhline(100.0 * value, color=colour, linewidth=1.2, linestyle=(0, (5, 3)))
        axes.annotate(
            f"{name} limit", (1.0, 100.0 * value), xycoords=("axes fraction", "data"), xytext=(-3, 2),
            textcoords="offset points", ha="right", va="bottom", fontsize=9, color=colour,
        )  # fmt: skip

"""The picture of a verdict: the zoom spectrum with both lines marked and labelled, the verdict as its title."""

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...orders.zoom import ZoomSpectrum
from .style import CIRCULAR_SPLINE, FLEXSPLINE, SOFT, Look, draw_spectrum, one_panel, room_above

_TITLE_WIDTH = 78
_UNIT = "rad/s²"
_PAPER = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.5}
"""Under the labels, which may cross the curve."""


def verdict_picture(zoom: ZoomSpectrum, *, title: str, subtitle: str) -> Figure:
    """Draw a zoom spectrum under its verdict in words; `subtitle` says where it comes from: the speed, say."""
    with one_panel(xlabel="frequency [Hz]", ylabel=f"amplitude [{_UNIT}]") as (figure, axes):
        draw_spectrum(axes, zoom.frequencies, zoom.amplitude)
        room_above(axes, 0.22)
        pairs = zip((CIRCULAR_SPLINE, FLEXSPLINE), zoom.lines, zoom.line_amplitudes, ("right", "left"), strict=True)
        for look, frequency, amplitude, side in pairs:
            _mark(axes, look, frequency, amplitude, side)
        note = f"line pair k = {zoom.k}" + (
            "" if zoom.resolved else "; the record is too short to separate the two lines"
        )
        axes.annotate(
            f"{subtitle}   {note}", (0.0, 1.0), xycoords="axes fraction", xytext=(0, 3), textcoords="offset points",
            fontsize=9, color=SOFT, va="bottom",
        )  # fmt: skip
        fixed = title.replace(" ± ", "\u00a0±\u00a0").replace(" %", "\u00a0%")  # a number stays with what follows it
        axes.set_title("\n".join(textwrap.wrap(fixed, _TITLE_WIDTH)), pad=20.0)
        return figure


def _mark(axes: Axes, look: Look, frequency: float, amplitude: float, side: str) -> None:
    top = axes.get_ylim()[1]
    height = np.format_float_positional(amplitude, precision=3, fractional=False, trim="-")
    axes.vlines(frequency, 0.0, amplitude, color=look.colour, linewidth=2.2, linestyle=look.line)
    axes.plot(frequency, amplitude, look.marker, color=look.colour, markersize=8, zorder=5)
    left, right = axes.get_xlim()
    beside = 0.012 * (right - left) * (-1.0 if side == "right" else 1.0)
    axes.annotate(
        f"{look.label}\n{frequency:.2f} Hz\n{height} {_UNIT}",
        (frequency, amplitude), xytext=(frequency + beside, min(amplitude + 0.02 * top, 0.84 * top)),
        ha=side, va="bottom", fontsize=10, color=look.colour, fontweight="bold", linespacing=1.25, bbox=_PAPER,
    )  # fmt: skip

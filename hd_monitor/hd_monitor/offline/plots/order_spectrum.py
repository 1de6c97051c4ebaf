"""The spectrum over cycles per output revolution around one pair: for strokes, ramps and the sensorless mode."""

from matplotlib.figure import Figure

from ...reducer import LinePair
from ..report.spectra import Spectrum
from .style import CIRCULAR_SPLINE, FLEXSPLINE, draw_spectrum, legend_above, new_figure, room_above


def order_plot(spectrum: Spectrum, pair: LinePair, *, title: str, unit: str, note: str = "") -> Figure:
    """Draw an order spectrum with the orders of a pair marked, and a note, if there is one, beside the axis."""
    with new_figure() as figure:
        axes = figure.add_subplot()
        draw_spectrum(axes, spectrum.axis, spectrum.amplitude)
        room_above(axes, 0.1)
        for look, order in zip((CIRCULAR_SPLINE, FLEXSPLINE), pair, strict=True):
            label = f"{look.label}, {order:g}"
            axes.axvline(order, color=look.colour, linestyle=look.line, linewidth=1.4, alpha=0.8, label=label, zorder=1)
        axes.set_xlabel("cycles per output revolution" + (f" ({note})" if note else ""))
        axes.set_ylabel(f"amplitude [{unit}]")
        axes.set_title(title)
        legend_above(axes)
        return figure

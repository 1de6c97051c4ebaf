"""The spectrum over cycles per output revolution around one pair: for strokes, ramps and the sensorless mode."""

from matplotlib.figure import Figure

from ...reducer import LinePair
from ..report.spectra import Spectrum
from .style import CIRCULAR_SPLINE, FLEXSPLINE, INK, legend_above, new_figure, room_above


def order_plot(spectrum: Spectrum, pair: LinePair, *, title: str, unit: str) -> Figure:
    """Draw an order spectrum with the orders of a pair marked."""
    with new_figure() as figure:
        axes = figure.add_subplot()
        axes.fill_between(spectrum.axis, spectrum.amplitude, color=INK, alpha=0.08, linewidth=0)
        axes.plot(spectrum.axis, spectrum.amplitude, color=INK, linewidth=1.4)
        axes.set_xlim(spectrum.axis[0], spectrum.axis[-1])
        axes.set_ylim(bottom=0.0)
        room_above(axes, 0.1)
        for look, order in zip((CIRCULAR_SPLINE, FLEXSPLINE), pair, strict=True):
            label = f"{look.label}, {order:g}"
            axes.axvline(order, color=look.colour, linestyle=look.line, linewidth=1.4, alpha=0.8, label=label, zorder=1)
        axes.set_xlabel("cycles per output revolution")
        axes.set_ylabel(f"amplitude [{unit}]")
        axes.set_title(title)
        legend_above(axes)
        return figure

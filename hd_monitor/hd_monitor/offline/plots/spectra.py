"""Spectra over frequency and over order, and the phase trace: Figs. 13b and 17 of Gu et al. 2021."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ...reducer import LinePair
from ..report.phase_trace import PhaseTrace
from ..report.spectra import Spectrum
from .style import (
    CIRCULAR_SPLINE,
    FLEXSPLINE,
    INK,
    SOFT,
    draw_spectrum,
    legend_above,
    name_at_top,
    natural_frequency_label,
    one_panel,
    room_above,
)


def spectrum_plot(spectrum: Spectrum, pairs: Sequence[LinePair], *, title: str, natural_frequency: float) -> Figure:
    """Draw an amplitude spectrum over frequency [Hz]; `pairs` are the frequencies of the pairs k = 1, 2, …."""
    with one_panel(title=title, xlabel="frequency [Hz]", ylabel="amplitude [rad/s²]") as (figure, axes):
        shown = spectrum.axis > 0.0
        axes.semilogy(spectrum.axis[shown], np.maximum(spectrum.amplitude[shown], 1e-12), color=INK, linewidth=0.7)
        axes.set_xlim(0.0, float(spectrum.axis[-1]))
        high = float(spectrum.amplitude[shown].max())
        low = max(float(np.percentile(spectrum.amplitude[shown], 2)), 1e-6 * high)
        axes.set_ylim(low / 2.0, high * 10.0)
        for number, pair in enumerate(pairs):
            for look, frequency in zip((CIRCULAR_SPLINE, FLEXSPLINE), pair, strict=True):
                if frequency < spectrum.axis[-1]:
                    near = np.abs(spectrum.axis - frequency) <= 1.5 * (spectrum.axis[1] - spectrum.axis[0])
                    axes.plot(
                        frequency, spectrum.amplitude[near].max(), look.marker, color=look.colour, markersize=6.5,
                        label=look.label if number == 0 else "_", zorder=5, markeredgecolor="white",
                    )  # fmt: skip
            if pair.flexspline < spectrum.axis[-1]:
                name_at_top(axes, pair.flexspline, f"k = {number + 1}", rotation=90)
        if natural_frequency < spectrum.axis[-1]:
            label = natural_frequency_label(natural_frequency)
            axes.axvline(natural_frequency, color=SOFT, linestyle=":", linewidth=1.4, label=label)
        axes.legend(loc="upper right", frameon=True, framealpha=0.9, edgecolor="none")
        return figure


def order_plot(spectrum: Spectrum, pair: LinePair, *, title: str, unit: str, note: str = "") -> Figure:
    """Draw an order spectrum with the orders of a pair marked, and a note, if there is one, beside the axis.

    It suits strokes, ramps and the sensorless mode.
    """
    xlabel = "cycles per output revolution" + (f" ({note})" if note else "")
    with one_panel(title=title, xlabel=xlabel, ylabel=f"amplitude [{unit}]") as (figure, axes):
        draw_spectrum(axes, spectrum.axis, spectrum.amplitude)
        room_above(axes, 0.1)
        for look, order in zip((CIRCULAR_SPLINE, FLEXSPLINE), pair, strict=True):
            label = f"{look.label}, {order:g}"
            axes.axvline(order, color=look.colour, linestyle=look.line, linewidth=1.4, alpha=0.8, label=label, zorder=1)
        legend_above(axes)
        return figure


def phase_plot(trace: PhaseTrace, *, title: str) -> Figure:
    """Draw a phase trace: velocity over displacement of the torsional vibration."""
    labels = {"xlabel": "displacement [µrad]", "ylabel": "velocity [mrad/s]"}
    with one_panel((6.0, 5.4), title=title, **labels) as (figure, axes):
        axes.plot(1e6 * trace.displacement, 1e3 * trace.velocity, color=CIRCULAR_SPLINE.colour, linewidth=0.7)
        return figure

"""The whole spectrum with the characteristic pairs marked (Fig. 13b of Gu et al. 2021)."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ...reducer import LinePair
from ..report.spectra import Spectrum
from .style import CIRCULAR_SPLINE, FLEXSPLINE, INK, SOFT, new_figure


def spectrum_plot(
    spectrum: Spectrum, pairs: Sequence[LinePair], *, title: str, natural_frequency: float, unit: str = "rad/s²"
) -> Figure:
    """Draw an amplitude spectrum over frequency [Hz]; `pairs` are the frequencies of the pairs k = 1, 2, …."""
    with new_figure() as figure:
        axes = figure.add_subplot()
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
                axes.annotate(
                    f"k = {number + 1}", (pair.flexspline, 0.985), xycoords=("data", "axes fraction"), xytext=(3, 0),
                    textcoords="offset points", rotation=90, ha="left", va="top", fontsize=9,
                )  # fmt: skip
        if natural_frequency < spectrum.axis[-1]:
            axes.axvline(
                natural_frequency, color=SOFT, linestyle=":", linewidth=1.4,
                label=f"natural frequency {natural_frequency:.1f} Hz",
            )  # fmt: skip
        axes.set_xlabel("frequency [Hz]")
        axes.set_ylabel(f"amplitude [{unit}]")
        axes.set_title(title)
        axes.legend(loc="upper right", frameon=True, framealpha=0.9, edgecolor="none")
        return figure

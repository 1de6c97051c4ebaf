"""Amplitudes of both splines' lines against speed, a panel for each pair."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from ..report.lines_by_speed import SpeedLines
from .style import CIRCULAR_SPLINE, FLEXSPLINE, SOFT, legend_above, new_figure


def lines_plot(lines: Sequence[SpeedLines], *, resonances: Sequence[float], title: str) -> Figure:
    """Draw line amplitudes with their standard deviations; `resonances` are the pairs' critical speeds [rpm]."""
    pairs = sorted({line.k for line in lines})
    with new_figure((8.0, 1.5 + 1.9 * len(pairs))) as figure:
        panels = figure.subplots(len(pairs), 1, sharex=True, squeeze=False)[:, 0]
        for axes, k in zip(panels, pairs, strict=True):
            mine = [line for line in lines if line.k == k]
            for number, look in enumerate((CIRCULAR_SPLINE, FLEXSPLINE)):
                axes.errorbar(
                    [line.rpm for line in mine], [line.amplitude[number] for line in mine],
                    yerr=[line.std[number] for line in mine], fmt=look.line, marker=look.marker, markersize=4.5,
                    color=look.colour, label=look.label, capsize=2.0, elinewidth=1.0,
                )  # fmt: skip
            axes.set_ylim(bottom=0.0)
            axes.set_ylabel(f"k = {k}  [rad/s²]")
            low, high = axes.get_xlim()
            if k <= len(resonances) and low <= resonances[k - 1] <= high:
                axes.axvline(resonances[k - 1], color=SOFT, linestyle=":", linewidth=1.4, label="resonance")
        panels[0].set_title(title)
        entries = {
            name: handle for axes in panels for handle, name in zip(*axes.get_legend_handles_labels(), strict=True)
        }
        legend_above(panels[0], handles=list(entries.values()), labels=list(entries))
        panels[-1].set_xlabel("wave-generator speed [rpm]")
        return figure

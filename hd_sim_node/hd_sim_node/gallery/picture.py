"""The picture: a panel for each effect, the drive without it in grey behind; nothing is computed here."""

import math
from collections.abc import Sequence

from matplotlib.figure import Figure

from hd_monitor.offline.plots.style import CIRCULAR_SPLINE, FLEXSPLINE, INK, SOFT, new_figure
from hd_monitor.orders.zoom import ZoomSpectrum

_COLUMNS = 3
_PANEL = (3.9, 2.35)  # inches
_DECADES = 4.5
_WITHOUT = "#A9B3BF"


def gallery_picture(names: Sequence[str], pairs: Sequence[tuple[ZoomSpectrum, ZoomSpectrum]]) -> Figure:
    """Draw zoom spectra (without, with) an effect, all on one scale, under the effects' names."""
    rows = math.ceil(len(names) / _COLUMNS)
    top = 10.0 ** math.ceil(math.log10(2.0 * max(zoom.amplitude.max() for pair in pairs for zoom in pair)))
    with new_figure((_COLUMNS * _PANEL[0], rows * _PANEL[1] + 0.5)) as figure:
        panels = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False)
        for number, axes in enumerate(panels.flat):
            if number >= len(names):
                axes.remove()
                continue
            without, with_it = pairs[number]
            axes.set_title(f"{number + 1}  {names[number]}", fontsize=10, pad=5.0)
            for look, frequency in zip((CIRCULAR_SPLINE, FLEXSPLINE), with_it.lines, strict=True):
                axes.axvline(
                    frequency,
                    color=look.colour,
                    linestyle=look.line,
                    linewidth=1.0,
                    alpha=0.6,
                    label=look.label,
                    zorder=0.5,
                )
            axes.fill_between(without.frequencies, without.amplitude, color=_WITHOUT, alpha=0.35, linewidth=0)
            axes.plot(without.frequencies, without.amplitude, color=_WITHOUT, linewidth=1.6, label="without")
            axes.plot(with_it.frequencies, with_it.amplitude, color=INK, linewidth=1.1, label="with it")
            axes.set_yscale("log")
            axes.set_ylim(top * 10.0**-_DECADES, top)
            axes.set_xlim(with_it.frequencies[0], with_it.frequencies[-1])
            axes.tick_params(labelsize=9)
        handles, labels = panels[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper right", ncols=4, fontsize=10)
        figure.supxlabel("frequency [Hz]", fontsize=10, color=SOFT)
        figure.supylabel("amplitude [rad/s²]", fontsize=10, color=SOFT)
        return figure

"""Spectra over time as a map."""

import itertools

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ..report.waterfall import Waterfall
from .style import new_figure

_DECADES = 3.5


def waterfall_plot(waterfall: Waterfall, *, title: str, unit: str = "rad/s²") -> Figure:
    """Draw a waterfall; times in which nothing was recorded stay empty."""
    with new_figure((8.0, 4.8)) as figure:
        axes = figure.add_subplot()
        axes.grid(visible=False)
        axes.set_facecolor("#f4f5f7")
        largest = max(float(waterfall.amplitude.max()), 1e-12)
        floor = largest * 10.0**-_DECADES
        times = waterfall.times - waterfall.times[0]
        step = float(np.median(np.diff(times)))
        starts = [0, *(np.flatnonzero(np.diff(times) > 1.5 * step) + 1).tolist(), times.size]
        width = float(waterfall.frequencies[1] - waterfall.frequencies[0])
        edges = np.append(waterfall.frequencies - width / 2.0, waterfall.frequencies[-1] + width / 2.0)
        for first, last in itertools.pairwise(starts):
            rows = np.append(times[first:last] - step / 2.0, times[last - 1] + step / 2.0)
            image = axes.pcolormesh(
                edges, rows, np.maximum(waterfall.amplitude[first:last], floor), cmap="cividis",
                norm=LogNorm(floor, largest), rasterized=True,
            )  # fmt: skip
        axes.set_xlabel("frequency [Hz]")
        axes.set_ylabel("time [s]")
        axes.set_title(title)
        figure.colorbar(image, ax=axes, label=f"amplitude [{unit}]", pad=0.02)
        return figure

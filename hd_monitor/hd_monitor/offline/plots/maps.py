"""Amplitude as colour: over order and speed, and over frequency and time.

What stays at its order turns with the drive; what runs across the orders is a resonance.
"""

import itertools
from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ...arrays import FloatArray
from ..report.spectra import OrderMap
from ..report.waterfall import Waterfall
from .style import natural_frequency_label, one_panel

_SIZE = (8.0, 4.8)


def order_map_plot(order_map: OrderMap, *, natural_frequency: float, title: str) -> Figure:
    """Draw an order map; the natural frequency [Hz] shows as a curve."""
    labels = {"xlabel": "order: cycles per wave-generator revolution", "ylabel": "wave-generator speed [rpm]"}
    with one_panel(_SIZE, title=title, **labels) as (figure, axes):
        speeds, orders = order_map.speeds, order_map.orders
        half = np.diff(speeds).min() / 2.0 if speeds.size > 1 else max(0.05 * speeds[0], 1.0)
        bands = (np.array([speed - half, speed + half]) for speed in speeds)  # speeds never visited stay white
        rows = np.ma.masked_invalid(order_map.amplitude)[:, np.newaxis]
        _draw(figure, axes, orders, zip(bands, rows, strict=True), float(rows.max()), decades=3.0)
        low, high = max(float(speeds[0] - half), 1.0), float(speeds[-1] + half)
        curve = np.linspace(low, high, 400)
        resonance = natural_frequency * 60.0 / curve
        inside = resonance <= orders[-1]
        axes.plot(resonance[inside], curve[inside], color="white", linewidth=3.0, alpha=0.6)
        axes.plot(
            resonance[inside], curve[inside], color="#A3001E", linewidth=1.4, linestyle=":",
            label=natural_frequency_label(natural_frequency),
        )  # fmt: skip
        axes.set(xlim=(orders[0], orders[-1]), ylim=(low, high))
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)
        return figure


def waterfall_plot(waterfall: Waterfall, *, title: str) -> Figure:
    """Draw a waterfall; times in which nothing was recorded stay empty."""
    with one_panel(_SIZE, title=title, xlabel="frequency [Hz]", ylabel="time [s]") as (figure, axes):
        times = waterfall.times - waterfall.times[0]
        step = float(np.median(np.diff(times)))
        starts = [0, *(np.flatnonzero(np.diff(times) > 1.5 * step) + 1).tolist(), times.size]
        stretches = [slice(*bounds) for bounds in itertools.pairwise(starts)]
        rows = ((_edges(times[part], step), waterfall.amplitude[part]) for part in stretches)
        _draw(figure, axes, waterfall.frequencies, rows, float(waterfall.amplitude.max()), decades=3.5)
        return figure


def _draw(
    figure: Figure,
    axes: Axes,
    columns: FloatArray,
    rows: Iterable[tuple[FloatArray, FloatArray]],
    largest: float,
    *,
    decades: float,
) -> None:
    """Draw stretches of rows, each with its edges, on one logarithmic scale of colours that ends `decades` lower."""
    axes.grid(visible=False)
    axes.set_facecolor("#f4f5f7")
    largest = max(largest, 1e-12)
    floor = largest * 10.0**-decades
    edges = _edges(columns, float(columns[1] - columns[0]))
    for bounds, amplitude in rows:
        image = axes.pcolormesh(
            edges, bounds, np.ma.clip(amplitude, floor, None), cmap="cividis", norm=LogNorm(floor, largest),
            rasterized=True,
        )  # fmt: skip
    figure.colorbar(image, ax=axes, label="amplitude [rad/s²]", pad=0.02)


def _edges(centres: FloatArray, step: float) -> FloatArray:
    return np.append(centres - step / 2.0, centres[-1] + step / 2.0)

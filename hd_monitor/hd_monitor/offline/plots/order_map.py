"""Amplitude over order and speed: what stays at its order turns with the drive, what runs across it is a resonance."""

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ..report.spectra import OrderMap
from .style import new_figure

_DECADES = 3.0


def order_map_plot(order_map: OrderMap, *, natural_frequency: float, title: str, unit: str = "rad/s²") -> Figure:
    """Draw an order map; the natural frequency [Hz] shows as a curve."""
    with new_figure((8.0, 4.8)) as figure:
        axes = figure.add_subplot()
        axes.grid(visible=False)
        amplitude = np.ma.masked_invalid(order_map.amplitude)
        largest = max(float(amplitude.max()), 1e-12)
        floor = largest * 10.0**-_DECADES
        speeds = order_map.speeds
        half = np.diff(speeds).min() / 2.0 if speeds.size > 1 else max(0.05 * speeds[0], 1.0)
        for speed, row in zip(speeds, amplitude, strict=True):  # row by row: speeds never visited stay white
            image = axes.pcolormesh(
                _edges(order_map.orders), [speed - half, speed + half], np.ma.clip(row, floor, None)[np.newaxis, :],
                cmap="cividis", norm=LogNorm(floor, largest), rasterized=True,
            )  # fmt: skip
        axes.set_facecolor("#f4f5f7")
        low, high = max(float(speeds[0] - half), 1.0), float(speeds[-1] + half)
        curve = np.linspace(low, high, 400)
        with np.errstate(divide="ignore"):
            orders = natural_frequency * 60.0 / curve
        inside = orders <= order_map.orders[-1]
        axes.plot(orders[inside], curve[inside], color="white", linewidth=3.0, alpha=0.6)
        axes.plot(
            orders[inside], curve[inside], color="#A3001E", linewidth=1.4, linestyle=":",
            label=f"natural frequency {natural_frequency:.1f} Hz",
        )  # fmt: skip
        axes.set_xlim(order_map.orders[0], order_map.orders[-1])
        axes.set_ylim(low, high)
        axes.set_xlabel("order: cycles per wave-generator revolution")
        axes.set_ylabel("wave-generator speed [rpm]")
        axes.set_title(title)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)
        figure.colorbar(image, ax=axes, label=f"amplitude [{unit}]", pad=0.02)
        return figure


def _edges(centres: np.ndarray[tuple[int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    step = float(centres[1] - centres[0])
    return np.append(centres - step / 2.0, centres[-1] + step / 2.0)

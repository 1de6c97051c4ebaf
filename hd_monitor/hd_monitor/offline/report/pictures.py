"""Which pictures a joint's report has; one that the recording does not carry is left out. The page captions them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ...acquisition.record import Record
from ...assessment import Assessment
from ...reducer import LinePair, Reducer
from ..plots.indexes import indexes_plot
from ..plots.line_amplitudes import lines_plot
from ..plots.maps import order_map_plot, waterfall_plot
from ..plots.rms_curve import rms_plot
from ..plots.spectra import order_plot, phase_plot, spectrum_plot
from ..plots.style import png
from ..plots.verdict_picture import verdict_picture
from .collector import Collector
from .phase_trace import phase_trace
from .spectra import amplitude_spectrum, order_spectrum

FEWEST_SPEEDS = 3
"""Speeds from which on something is drawn over speed."""
_ORDERS_SHOWN = 1201
_SEPARATING_TRAVEL = 360.0
"""Output travel [°] that separates the first pair under a Hann window."""
_UNITS = {"joint_effort": "effort, as reported", "joint_velocity": "rad/s"}


def unit_of(source: str) -> str:
    """Unit of the vibration signal of an ``input.source``."""
    return _UNITS.get(source, "rad/s²")


def pair_speeds(reducer: Reducer, natural_frequency: float, harmonics: int) -> list[tuple[float, str]]:
    """Wave-generator speeds [rpm] at which the pairs k = 1, 2, … meet the natural frequency [Hz], and their names."""
    first = 60.0 * natural_frequency / reducer.circular_spline_order
    return [(first / k, f"k = {k}") for k in range(1, harmonics + 1)]


def pictures(last: Assessment | None, timeline: Sequence[dict[str, Any]], collector: Collector) -> dict[str, bytes]:
    """Return a joint's pictures as PNG by their names, in the order of the page."""
    if last is None:
        return {}
    view = _View(last, timeline, collector)
    drawn = {name: draw(view) for name, draw in _PICTURES.items()}
    return {name: png(figure) for name, figure in drawn.items() if figure is not None}


@dataclass(frozen=True, slots=True)
class _View:
    """What the pictures are drawn from: the last assessment, the JSON's timeline and what was collected."""

    last: Assessment
    timeline: Sequence[dict[str, Any]]
    collector: Collector

    @property
    def harmonics(self) -> int:
        return self.collector.settings.analysis.harmonics

    @property
    def natural_frequency(self) -> float:
        """The one found [Hz], or else the one given."""
        found = self.last.identification.natural_frequency if self.last.identification else float("nan")
        return found if np.isfinite(found) else self.collector.settings.dynamics.natural_frequency

    @property
    def pair_speeds(self) -> list[tuple[float, str]]:
        return pair_speeds(self.last.settings.reducer, self.natural_frequency, self.harmonics)

    @property
    def steady(self) -> Record | None:
        """The stretch that shows the lines best."""
        return self.collector.best.steady if self.collector.best is not None else None

    @property
    def rpm(self) -> float:
        """Mean wave-generator speed of that stretch [rpm]; 0 without one."""
        mean = 0.0 if self.steady is None else float(self.steady.speed.mean())
        return abs(mean) * self.last.settings.reducer.reduction * 30.0 / np.pi


def _zoom(view: _View) -> Figure | None:
    zoom = view.collector.best.zoom if view.collector.best else None
    if zoom is None:
        return None
    title = view.last.verdict.reason.partition(";")[0]  # its first sentence
    return verdict_picture(zoom, title=title, subtitle=f"zoom spectrum at {view.rpm:.0f} rpm")


def _orders(view: _View) -> Figure | None:
    angle, values = view.collector.tail()
    if angle.size < 100:
        return None
    k = view.last.strongest_pair
    pair = LinePair(*(k * order for order in view.last.settings.reducer.output_orders))
    margin = 4.0 * (pair.flexspline - pair.circular_spline)
    axis = np.linspace(pair.circular_spline - margin, pair.flexspline + margin, _ORDERS_SHOWN)
    spectrum = order_spectrum(angle, values, axis)
    unit = unit_of(view.collector.settings.input.source)
    travel = float(np.degrees(np.ptp(angle)))
    # A Hann window separates lines that are two of its cycles apart; the pair is 2k cycles apart in a revolution.
    note = "" if travel * k >= _SEPARATING_TRAVEL else f"{travel:.0f}° of travel do not separate the lines"
    return order_plot(spectrum, pair, title=f"Order spectrum, line pair k = {k}", unit=unit, note=note)


def _spectrum(view: _View) -> Figure | None:
    if view.steady is None:
        return None
    pairs = [view.last.settings.reducer.line_frequencies(view.rpm, k) for k in range(1, view.harmonics + 1)]
    title = f"Spectrum at {view.rpm:.0f} rpm"
    return spectrum_plot(amplitude_spectrum(view.steady), pairs, title=title, natural_frequency=view.natural_frequency)


def _map(view: _View) -> Figure | None:
    order_map = view.collector.order_map.result()
    if order_map is None or order_map.speeds.size < FEWEST_SPEEDS:
        return None
    return order_map_plot(order_map, natural_frequency=view.natural_frequency, title="Vibration over order and speed")


def _waterfall(view: _View) -> Figure | None:
    waterfall = view.collector.waterfall.result()
    return waterfall_plot(waterfall, title="Vibration over frequency and time") if waterfall is not None else None


def _rms(view: _View) -> Figure | None:
    bins, speeds = view.last.rms_curve, view.pair_speeds
    if len(bins) < FEWEST_SPEEDS:
        return None
    critical = [*speeds, (2.0 * speeds[0][0], "principal instability")]
    return rms_plot(bins, critical=critical, title="Vibration over speed")


def _lines(view: _View) -> Figure | None:
    lines = view.collector.lines.result()
    if len({line.rpm for line in lines}) < FEWEST_SPEEDS:
        return None
    resonances = [speed for speed, _ in view.pair_speeds]
    return lines_plot(lines, resonances=resonances, title="Line amplitudes over speed")


def _indexes(view: _View) -> Figure | None:
    if all(entry["flexspline_index"] is None for entry in view.timeline):
        return None
    last, limits = view.last, view.last.settings.diagnosis
    relative = bool(last.identification and last.identification.relative)
    title = "Relative indexes over time" if relative else "Stiffness indexes over time"
    return indexes_plot(view.timeline, warn=limits.warn_index, error=limits.error_index, relative=relative, title=title)


def _phase(view: _View) -> Figure | None:
    trace = phase_trace(view.steady, view.last.settings.reducer) if view.steady is not None else None
    if trace is None:
        return None
    return phase_plot(trace, title=f"Phase trace at {trace.rpm:.0f} rpm, {trace.band[0]:.0f}–{trace.band[1]:.0f} Hz")


_PICTURES: dict[str, Callable[[_View], Figure | None]] = {
    "zoom_spectrum": _zoom,
    "indexes": _indexes,
    "order_spectrum": _orders,
    "spectrum": _spectrum,
    "order_map": _map,
    "waterfall": _waterfall,
    "rms_curve": _rms,
    "line_amplitudes": _lines,
    "phase_trace": _phase,
}
"""The verdict's first."""

PICTURE_NAMES = tuple(_PICTURES)

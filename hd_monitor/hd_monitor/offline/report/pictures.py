"""Which pictures a joint's report has; one that the recording does not carry is left out. The page captions them."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

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

PICTURE_NAMES = (
    "zoom_spectrum",
    "indexes",
    "order_spectrum",
    "spectrum",
    "order_map",
    "waterfall",
    "rms_curve",
    "line_amplitudes",
    "phase_trace",
)
"""The verdict's first."""
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
    natural_frequency = last.identification.natural_frequency if last.identification else float("nan")
    if not np.isfinite(natural_frequency):
        natural_frequency = collector.settings.dynamics.natural_frequency
    drawn = {
        **dict(_over_time(last, timeline, collector)),
        **dict(_over_speed(last, collector, natural_frequency)),
        **dict(_best_stretch(last, collector, natural_frequency)),
    }
    return {name: png(drawn[name]) for name in PICTURE_NAMES if name in drawn}


def _over_time(
    last: Assessment, timeline: Sequence[dict[str, Any]], collector: Collector
) -> Iterator[tuple[str, Figure]]:
    """Draw what the recording shows from its start to its end, and the orders of its last minutes."""
    if any(entry["flexspline_index"] is not None for entry in timeline):
        limits = last.settings.diagnosis
        relative = bool(last.identification and last.identification.relative)
        title = "Relative indexes over time" if relative else "Stiffness indexes over time"
        yield (
            "indexes",
            indexes_plot(timeline, warn=limits.warn_index, error=limits.error_index, relative=relative, title=title),
        )
    if (waterfall := collector.waterfall.result()) is not None:
        yield "waterfall", waterfall_plot(waterfall, title="Vibration over frequency and time")
    angle, values = collector.tail()
    if angle.size >= 100:
        k = last.strongest_pair
        pair = LinePair(*(k * order for order in last.settings.reducer.output_orders))
        margin = 4.0 * (pair.flexspline - pair.circular_spline)
        axis = np.linspace(pair.circular_spline - margin, pair.flexspline + margin, _ORDERS_SHOWN)
        spectrum = order_spectrum(angle, values, axis)
        unit = unit_of(collector.settings.input.source)
        travel = float(np.degrees(np.ptp(angle)))
        # A Hann window separates lines two of its cycles apart; the pair is 2k cycles apart in a revolution.
        note = "" if travel * k >= _SEPARATING_TRAVEL else f"{travel:.0f}° of travel do not separate the lines"
        title = f"Order spectrum, line pair k = {k}"
        yield "order_spectrum", order_plot(spectrum, pair, title=title, unit=unit, note=note)


def _over_speed(last: Assessment, collector: Collector, natural_frequency: float) -> Iterator[tuple[str, Figure]]:
    speeds = pair_speeds(last.settings.reducer, natural_frequency, collector.settings.analysis.harmonics)
    order_map = collector.order_map.result()
    if order_map is not None and order_map.speeds.size >= FEWEST_SPEEDS:
        title = "Vibration over order and speed"
        yield "order_map", order_map_plot(order_map, natural_frequency=natural_frequency, title=title)
    if len(last.rms_curve) >= FEWEST_SPEEDS:
        critical = [*speeds, (2.0 * speeds[0][0], "principal instability")]
        yield "rms_curve", rms_plot(last.rms_curve, critical=critical, title="Vibration over speed")
    lines = collector.lines.result()
    if len({line.rpm for line in lines}) >= FEWEST_SPEEDS:
        resonances = [speed for speed, _ in speeds]
        yield "line_amplitudes", lines_plot(lines, resonances=resonances, title="Line amplitudes over speed")


def _best_stretch(last: Assessment, collector: Collector, natural_frequency: float) -> Iterator[tuple[str, Figure]]:
    """Draw the stretch that shows the lines best."""
    best, reducer = collector.best, last.settings.reducer
    if best is None:
        return
    steady = best.steady
    rpm = 0.0 if steady is None else abs(float(steady.speed.mean())) * reducer.reduction * 30.0 / np.pi
    if best.zoom is not None:
        title = last.verdict.reason.partition(";")[0]  # its first sentence
        yield "zoom_spectrum", verdict_picture(best.zoom, title=title, subtitle=f"zoom spectrum at {rpm:.0f} rpm")
    if steady is None:
        return
    pairs = [reducer.line_frequencies(rpm, k) for k in range(1, collector.settings.analysis.harmonics + 1)]
    title = f"Spectrum at {rpm:.0f} rpm"
    spectrum = amplitude_spectrum(steady)
    yield "spectrum", spectrum_plot(spectrum, pairs, title=title, natural_frequency=natural_frequency)
    if (trace := phase_trace(steady, reducer)) is not None:
        title = f"Phase trace at {trace.rpm:.0f} rpm, {trace.band[0]:.0f}–{trace.band[1]:.0f} Hz"
        yield "phase_trace", phase_plot(trace, title=title)

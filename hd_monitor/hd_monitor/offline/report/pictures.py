"""Which pictures a joint's report has, each with its caption; one that the recording does not carry is left out."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ...assessment import Assessment
from ...reducer import LinePair
from ..plots.indexes import indexes_plot
from ..plots.line_amplitudes import lines_plot
from ..plots.order_map import order_map_plot
from ..plots.order_spectrum import order_plot
from ..plots.phase_trace import phase_plot
from ..plots.rms_curve import rms_plot
from ..plots.spectrum import spectrum_plot
from ..plots.style import png
from ..plots.verdict_picture import verdict_picture
from ..plots.waterfall import waterfall_plot
from ..result import JointResult
from .collector import Collector
from .phase_trace import phase_trace
from .spectra import amplitude_spectrum, order_spectrum

_ORDERS_SHOWN = 1201
_PARTING_TRAVEL = 360.0
"""Output travel [°] that parts the first pair under a Hann window."""
_FEWEST_SPEEDS = 3
"""Speeds from which on something is drawn over speed."""
_UNITS = {"joint_effort": "effort, as reported", "joint_velocity": "rad/s"}


class Picture(NamedTuple):
    """A picture of a report."""

    name: str
    title: str
    caption: str
    png: bytes


def verdict_title(assessment: Assessment) -> str:
    """Write the verdict as a title: the first sentence of its reason."""
    return assessment.verdict.reason.partition(";")[0]


def pictures(result: JointResult, collector: Collector) -> Iterator[Picture]:
    """Yield a joint's pictures, the verdict's first."""
    if result.last is None:
        return
    for name, title, caption, draw in _PICTURES:
        figure = draw(result.last, result.timeline, collector)
        if figure is not None:
            yield Picture(name, title, caption, png(figure))


def unit_of(source: str) -> str:
    """Unit of the vibration signal of an ``input.source``."""
    return _UNITS.get(source, "rad/s²")


def speed_of(assessment: Assessment) -> float:
    """Mean wave-generator speed [rpm] of an assessment's steady stretch; 0 if it has none."""
    steady = assessment.steady
    return 0.0 if steady is None else _rpm(assessment, float(steady.speed.mean()))


def critical_speeds(assessment: Assessment, natural_frequency: float, harmonics: int) -> list[float]:
    """Wave-generator speeds [rpm] at which the pairs k = 1, 2, … meet the natural frequency."""
    order = assessment.reducer.circular_spline_order
    return [60.0 * natural_frequency / (order * k) for k in range(1, harmonics + 1)]


def _rpm(assessment: Assessment, output_speed: float) -> float:
    return abs(output_speed) * assessment.reducer.reduction * 30.0 / np.pi


def _natural_frequency(last: Assessment, collector: Collector) -> float:
    found = last.identification.natural_frequency if last.identification else float("nan")
    return found if np.isfinite(found) else collector.settings.dynamics.natural_frequency


def _zoom(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    if collector.zoom is None or collector.best is None:
        return None
    subtitle = f"zoom spectrum at {speed_of(collector.best):.0f} rpm"
    return verdict_picture(collector.zoom, title=verdict_title(last), subtitle=subtitle)


def _orders(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    angle, values = collector.tail()
    if angle.size < 100:
        return None
    k = last.strongest_pair
    orders = last.reducer.output_orders
    pair = LinePair(k * orders.circular_spline, k * orders.flexspline)
    margin = 4.0 * (pair.flexspline - pair.circular_spline)
    axis = np.linspace(pair.circular_spline - margin, pair.flexspline + margin, _ORDERS_SHOWN)
    spectrum = order_spectrum(angle, values, axis)
    unit = unit_of(collector.settings.input.source)
    travel = float(np.degrees(np.ptp(angle)))
    # A Hann window parts lines that are two of its cycles apart; the pair is 2k cycles apart in a revolution.
    note = "" if travel * k >= _PARTING_TRAVEL else f"{travel:.0f}° of travel do not part the lines"
    return order_plot(spectrum, pair, title=f"Order spectrum, line pair k = {k}", unit=unit, note=note)


def _spectrum(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    best = collector.best
    steady = best.steady if best is not None else None
    if best is None or steady is None:
        return None
    rpm = speed_of(best)
    pairs = [last.reducer.line_frequencies(rpm, k) for k in range(1, collector.settings.analysis.harmonics + 1)]
    return spectrum_plot(
        amplitude_spectrum(steady),
        pairs,
        title=f"Spectrum at {rpm:.0f} rpm",
        natural_frequency=_natural_frequency(last, collector),
    )


def _map(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    order_map = collector.order_map.result()
    if order_map is None or order_map.speeds.size < _FEWEST_SPEEDS:
        return None
    return order_map_plot(
        order_map, natural_frequency=_natural_frequency(last, collector), title="Vibration over order and speed"
    )


def _waterfall(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    waterfall = collector.waterfall.result()
    return waterfall_plot(waterfall, title="Vibration over frequency and time") if waterfall is not None else None


def _rms(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    if len(last.rms_curve.bins) < _FEWEST_SPEEDS:
        return None
    return rms_plot(last.rms_curve.bins, critical=_critical(last, collector), title="Vibration over speed")


def _critical(last: Assessment, collector: Collector) -> list[tuple[float, str]]:
    speeds = critical_speeds(last, _natural_frequency(last, collector), collector.settings.analysis.harmonics)
    named = [(speed, f"k = {k}") for k, speed in enumerate(speeds, start=1)]
    return [*named, (2.0 * speeds[0], "principal instability")]


def _lines(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    lines = collector.lines.result()
    if len({line.rpm for line in lines}) < _FEWEST_SPEEDS:
        return None
    harmonics = collector.settings.analysis.harmonics
    resonances = critical_speeds(last, _natural_frequency(last, collector), harmonics)
    return lines_plot(lines, resonances=resonances, title="Line amplitudes over speed")


def _indexes(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    if all(entry["flexspline_index"] is None for entry in timeline):
        return None
    relative = bool(last.identification and last.identification.relative)
    title = "Relative indexes over time" if relative else "Stiffness indexes over time"
    return indexes_plot(timeline, warn=last.warn_limit, error=last.error_limit, relative=relative, title=title)


def _phase(last: Assessment, timeline: list[dict[str, Any]], collector: Collector) -> Figure | None:
    best = collector.best
    steady = best.steady if best is not None else None
    trace = phase_trace(steady, last.reducer) if steady is not None else None
    if trace is None:
        return None
    return phase_plot(trace, title=f"Phase trace at {trace.rpm:.0f} rpm, {trace.band[0]:.0f}–{trace.band[1]:.0f} Hz")


_Draw = Callable[[Assessment, list[dict[str, Any]], Collector], Figure | None]

_PICTURES: tuple[tuple[str, str, str, _Draw], ...] = (
    (
        "zoom_spectrum",
        "Zoom spectrum",
        "The two characteristic lines of the strongest pair at a steady speed. The left one belongs to the circular "
        "spline, the right one to the flexspline. Near a resonance their heights alone do not tell which spline is "
        "worse: the verdict rests on the indexes.",
        _zoom,
    ),
    (
        "indexes",
        "Indexes over time",
        "Stiffness fluctuation that each spline causes, with its 95 % band, as the evidence grew.",
        _indexes,
    ),
    (
        "order_spectrum",
        "Spectrum over the joint's angle",
        "The last minutes of the recording over cycles per output revolution: at changing speed and in strokes the "
        "lines stay at their orders.",
        _orders,
    ),
    (
        "spectrum",
        "Spectrum",
        "The whole spectrum at the same steady speed, with the characteristic pairs k = 1, 2, ….",
        _spectrum,
    ),
    (
        "order_map",
        "Order map",
        "What stays at its order turns with the drive; what follows the dotted curve is the natural frequency.",
        _map,
    ),
    (
        "waterfall",
        "Waterfall",
        "Spectra one after the other: what moves sideways follows the speed, what stands still is a resonance or "
        "comes from elsewhere.",
        _waterfall,
    ),
    (
        "rms_curve",
        "RMS over speed",
        "The property curve: RMS of the tangential vibration at the sensor. At the dotted speeds a line pair meets the "
        "natural frequency, or the reducer is nearest to parametric instability.",
        _rms,
    ),
    (
        "line_amplitudes",
        "Line amplitudes over speed",
        "Both lines of each pair by regression on the joint's angle, with standard deviations.",
        _lines,
    ),
    (
        "phase_trace",
        "Phase trace",
        "Velocity over displacement of the torsional vibration, integrated in the band named: rings that wander are "
        "quasi-periodic, as two close lines make them.",
        _phase,
    ),
)

PICTURE_NAMES = tuple(name for name, *_ in _PICTURES)

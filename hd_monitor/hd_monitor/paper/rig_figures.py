"""Figures 13, 15 and 17: the test rig's vibration at one speed."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.signal import hilbert

from ..arrays import FloatArray
from ..diagnosis.verdict import Component
from ..model import line_pairs
from ..model.simulation import TimeResponse
from . import printed
from .cases import Case, Cases
from .diagnosis import verdict_claim
from .exhibit import Claim, Curve, Exhibit, Panel, Style
from .line_figures import spectrum_panel, zoom_panel
from .records import REVOLUTIONS, line_heights, output_frequency, spectrum, steady_record

_PAIRS = 4
_SHOWN = 4.0  # s of the time history


def strongest_pair(case: Case, speed: float) -> int:
    """Return the number k of the pair that vibrates most at a speed [rpm], by harmonic balance."""
    strength = [np.hypot(*pair) for pair in line_pairs(case.model, speed, _PAIRS)]
    return int(np.argmax(strength)) + 1


class Beat(NamedTuple):
    """Envelope of a vibration: its frequency of rise and fall [Hz] and its depth (largest - smallest)/(sum)."""

    envelope: FloatArray
    frequency: float
    depth: float


def beat(values: FloatArray, rate: float) -> Beat:
    """Measure the beat of a vibration record, shape (samples,), that holds a whole number of beats."""
    envelope = np.abs(hilbert(values))
    frequencies, amplitudes = spectrum(envelope, rate)
    inner = envelope[envelope.size // 20 : -(envelope.size // 20) or None]
    return Beat(
        envelope=envelope,
        frequency=float(frequencies[1:][amplitudes[1:].argmax()]),
        depth=float((inner.max() - inner.min()) / (inner.max() + inner.min())),
    )


def time_history(case: Case) -> Exhibit:
    """Time history at the case's speed, with its envelope."""
    record = steady_record(case.model, case.speed)
    values = case.in_g(record.acceleration)
    measured = beat(values, record.rate)
    part = record.times <= _SHOWN
    times, label = record.times[part], f"envelope, beat {measured.frequency:.3f} Hz"
    panel = Panel(
        title="Time history",
        x_label="time (s)",
        y_label="tangential acceleration (g)",
        curves=(Curve(x=times, y=values[part]), Curve(x=times, y=measured.envelope[part], label=label, style="dashed")),
    )
    return Exhibit(
        title=f"Time history of torsional vibration at {case.speed:g} rpm",
        caption=f"Tangential acceleration at {case.sensor_radius:g} m.",
        panels=(panel,),
    )


def figure_13a(cases: Cases) -> Exhibit:
    """Time history on the rig at 850 rpm: the beat."""
    case = cases["rig"]
    record = steady_record(case.model, case.speed)
    k = strongest_pair(case, case.speed)
    separation = case.model.reducer.line_separation(case.speed, k)
    measured = beat(record.acceleration, record.rate)
    return replace(
        time_history(case),
        claims=(
            Claim(
                statement="A beat appears, caused by the small frequency difference of the bi-spectra",
                paper="obvious beat (no number)",
                ours=f"envelope at {measured.frequency:.4f} Hz (Δf of pair {k}: {separation:.4f} Hz), depth "
                f"{measured.depth:.0%}",
                passed=abs(measured.frequency - separation) < output_frequency(record) / REVOLUTIONS
                and measured.depth > 0.1,
            ),
        ),
    )


def _spectrum(case: Case, title: str, label: printed.Printed, multiple: int, pairs: int, *claims: Claim) -> Exhibit:
    """Show the spectrum up to some pair and the dominant pair's k; the paper's label counts `multiple` shaft cycles."""
    record = steady_record(case.model, case.speed)
    frequencies, amplitudes = spectrum(record.acceleration, record.rate)
    dominant = float(frequencies[amplitudes.argmax()])
    k = strongest_pair(case, case.speed)
    pair = case.model.reducer.line_frequencies(case.speed, k)
    fn = case.model.dynamics.natural_frequency
    of_shaft = multiple * case.speed / 60.0
    resonance = Claim(
        statement=f"Dominant component at {case.speed:g} rpm, close to the resonance",
        paper=str(label),
        ours=f"k = {k}: {pair.circular_spline:.2f} and {pair.flexspline:.2f} Hz, the larger at {dominant:.2f} Hz",
        passed=min(abs(dominant - line) for line in pair) < output_frequency(record)
        and abs(pair.circular_spline - of_shaft) < 1e-6
        and abs(pair.circular_spline - fn) < 0.1 * fn,
        contradiction=True,
        note=f"With ωo2 = 2n/60 the printed {multiple}× would be {2.0 * of_shaft:.0f} Hz; {multiple} cycles a shaft "
        f"revolution are {of_shaft:.2f} Hz, this pair. Numbered here by k.",
    )
    top = 1.2 * case.model.reducer.line_frequencies(case.speed, pairs).flexspline
    return Exhibit(
        title=f"{title} at {case.speed:g} rpm",
        caption=f"Tangential acceleration at {case.sensor_radius:g} m, {REVOLUTIONS} output revolutions, Hann window.",
        panels=(spectrum_panel(case.in_g(record.acceleration), record.rate, unit="g", top=top),),
        claims=(*claims, resonance),
    )


def figure_13b(cases: Cases) -> Exhibit:
    """Spectrum on the rig at 850 rpm."""
    case = cases["rig"]
    pairs = line_pairs(case.model, case.speed, _PAIRS)
    floor = 1e-3 * max(max(pair) for pair in pairs)
    visible = [k for k, pair in enumerate(pairs, start=1) if min(pair) > floor]
    several = Claim(
        statement="Several bi-spectra distribute in the vibration spectrum",
        paper="several",
        ours="pairs k = " + ", ".join(str(k) for k in visible) + " above 1e-3 of the largest line",
        passed=len(visible) >= 2,
    )
    return _spectrum(case, "Spectrum of torsional vibration", printed.RIG_DOMINANT, 4, _PAIRS, several)


def figure_13c(cases: Cases) -> Exhibit:
    """Zoom spectrum on the rig at 850 rpm: which peak is higher."""
    case = cases["rig"]
    model = case.model
    record = steady_record(model, case.speed)
    values = case.in_g(record.acceleration)
    k = strongest_pair(case, case.speed)
    heights = line_heights(model, values, k)
    left, right = (abs(model.dynamics.receptance(f)) * f**2 for f in model.reducer.line_frequencies(case.speed, k))
    return Exhibit(
        title=f"Zoom spectrum at {case.speed:g} rpm",
        caption=f"Around pair k = {k} and, beside it, k = 1; tangential acceleration, Hann window.",
        panels=tuple(zoom_panel(case, record, values, k=number, unit="g") for number in sorted({k, 1}, reverse=True)),
        claims=(
            Claim(
                statement="The right peak is higher than the left one: the flexspline is the dominant source",
                paper="right higher",
                ours=f"right {heights.flexspline:.3g} g, left {heights.circular_spline:.3g} g (k = {k})",
                passed=heights.flexspline > heights.circular_spline
                and model.flexspline.index > model.circular_spline.index,
                note=f"Near the resonance the slope matters too: equal defects would show right/left = "
                f"{right / left:.2f} here.",
            ),
            verdict_claim(
                case,
                "The monitor's verdict on this vibration",
                "flexspline",
                Component.FLEXSPLINE,
                note=f"True indexes: flexspline {model.flexspline.index:.1%}, circular spline "
                f"{model.circular_spline.index:.1%}.",
            ),
        ),
    )


def figure_15(cases: Cases) -> Exhibit:
    """Spectrum on the rig at 1700 rpm: resonance of the first pair."""
    case = replace(cases["rig"], speed=printed.RIG_FAST_SPEED.value)
    return _spectrum(case, "Spectrum of combination harmonic resonance", printed.RIG_FAST_DOMINANT, 2, 3)


class Quasiperiodicity(NamedTuple):
    """How a steady vibration repeats."""

    stroboscopic_spread: float
    """Standard deviation of the states (θ, θ'/ωn) caught once per circular-spline period, over that of all states: 0
    for a motion of that one period."""
    closing_error: float
    """Largest distance of the state after the lines' common period over the size of the motion: 0 if it comes back."""
    lattice_power: float
    """Part of the acceleration's power in lines p·ωo1 + q·ωo2."""


def _strobe(case: Case, record: TimeResponse, rows: FloatArray) -> FloatArray:
    """Catch the rows once per circular-spline period, over one output revolution."""
    cs = case.model.reducer.output_orders.circular_spline
    times = np.arange(0.0, cs) / (cs * output_frequency(record))
    return np.stack([np.interp(times, record.times, row) for row in rows])


def quasiperiodicity(case: Case, record: TimeResponse) -> Quasiperiodicity:
    """Measure a record over at least two output revolutions."""
    states = np.stack([record.displacement, record.velocity / case.model.dynamics.angular_frequency])
    size = float(np.sqrt(states.var(axis=1).sum()))
    caught = _strobe(case, record, states)
    cs, fs = case.model.reducer.output_orders
    common = round(fs - cs)  # times per output revolution
    period = record.displacement.size // (REVOLUTIONS * common)
    back = states[:, period : 2 * period] - states[:, :period]
    power = np.abs(np.fft.rfft(record.acceleration)) ** 2
    return Quasiperiodicity(
        stroboscopic_spread=float(np.sqrt(caught.var(axis=1).sum())) / size,
        closing_error=float(np.abs(back).max()) / size,
        lattice_power=float(power[:: common * REVOLUTIONS].sum() / power.sum()),
    )


def phase_trace(case: Case) -> Exhibit:
    """Phase trace at the case's speed, and the states caught once per circular-spline period.

    The trace covers half an output revolution, the common period of both lines. The states caught make a closed curve
    if the motion is quasi-periodic, else one point.
    """
    record = steady_record(case.model, case.speed)
    states = np.stack([record.displacement, record.velocity])
    half = record.displacement.size // REVOLUTIONS // 2
    parts: tuple[tuple[str, FloatArray, Style], ...] = (
        ("Phase trace, half an output revolution", states[:, :half], "fine"),
        ("Caught once per circular-spline period", _strobe(case, record, states), "points"),
    )
    panels = tuple(
        Panel(
            title=title,
            x_label="displacement θ (mrad)",
            y_label="velocity θ' (rad/s)",
            curves=(Curve(x=displacement * 1e3, y=velocity, style=style),),
            equal=True,
        )
        for title, (displacement, velocity), style in parts
    )
    return Exhibit(
        title=f"Phase trace at {case.speed:g} rpm",
        caption="Simulated displacement and velocity in the steady state.",
        panels=panels,
    )


def figure_17(cases: Cases) -> Exhibit:
    """Phase trace at 850 rpm."""
    case = cases["rig"]
    record = steady_record(case.model, case.speed)
    measured = quasiperiodicity(case, record)
    return replace(
        phase_trace(case),
        claims=(
            Claim(
                statement="The trace is quasi-periodic",
                paper="of quasi periodicity",
                ours="not of one period (states caught once per period spread over "
                f"{measured.stroboscopic_spread:.2f} of the motion), but all power is in lines p·ωo1 + q·ωo2 "
                f"except {abs(1.0 - measured.lattice_power):.0e} of it",
                passed=measured.stroboscopic_spread > 0.05 and measured.lattice_power > 0.999,
                note="With whole teeth the two frequencies have a common period, 40 wave-generator revolutions "
                f"for 160/162: after it the trace closes to {measured.closing_error:.0e} of its size.",
            ),
        ),
    )

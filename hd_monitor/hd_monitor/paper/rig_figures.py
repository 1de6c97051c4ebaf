"""Figures 13 and 15: what the test rig's sensor shows at one speed."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import hilbert

from ..arrays import FloatArray
from ..model import line_pairs
from ..reducer import LinePair
from . import printed
from .cases import Case, Cases
from .claim import Claim
from .diagnosis import diagnose, verdict_words
from .exhibit import Curve, Exhibit, Mark, Panel
from .line_figures import REVOLUTIONS, spectrum_panel, zoom_panel
from .records import SteadyRecord, spectrum, steady_record

_PAIRS = 4


def strongest_pair(case: Case, speed: float) -> int:
    """Return the number k of the pair that vibrates most at a speed [rpm], by harmonic balance."""
    strength = [np.hypot(*pair) for pair in line_pairs(case.model, speed, _PAIRS)]
    return int(np.argmax(strength)) + 1


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Beat:
    """Envelope of a vibration: its frequency of rise and fall [Hz] and its depth (largest - smallest)/(sum)."""

    envelope: FloatArray
    frequency: float
    depth: float


def beat(values: FloatArray, rate: float) -> Beat:
    """Measure the beat of a vibration record, shape (samples,), that holds a whole number of beats."""
    envelope = np.abs(hilbert(values))
    whole = spectrum(envelope, rate)
    strongest = int(np.argmax(whole.amplitude[1:])) + 1
    inner = envelope[envelope.size // 20 : -(envelope.size // 20) or None]
    return Beat(
        envelope=envelope,
        frequency=float(whole.frequencies[strongest]),
        depth=float((inner.max() - inner.min()) / (inner.max() + inner.min())),
    )


def beat_panel(case: Case, record: SteadyRecord, shown: float = 4.0) -> Panel:
    """Draw the time history as figure 13a does."""
    values = case.in_g(record.response.acceleration)
    measured = beat(values, record.response.rate)
    part = record.response.times <= shown
    times = record.response.times[part]
    return Panel(
        title="Time history",
        x_label="time (s)",
        y_label="tangential acceleration (g)",
        curves=(
            Curve(x=times, y=values[part]),
            Curve(
                x=times, y=measured.envelope[part], label=f"envelope, beat {measured.frequency:.3f} Hz", style="dashed"
            ),
        ),
    )


def figure_13a(cases: Cases) -> Exhibit:
    """Time history on the rig at 850 rpm: the beat."""
    case = cases["rig"]
    record = steady_record(case.model, case.speed, REVOLUTIONS)
    k = strongest_pair(case, case.speed)
    separation = case.model.reducer.line_separation(case.speed, k)
    measured = beat(record.response.acceleration, record.response.rate)
    return Exhibit(
        id="F13a",
        title=f"Time history of torsional vibration at {case.speed:g} rpm",
        caption=f"Tangential acceleration at {case.sensor_radius:g} m.",
        panels=(beat_panel(case, record),),
        claims=(
            Claim(
                id="F13a",
                statement="A beat appears, caused by the small frequency difference of the bi-spectra",
                paper="obvious beat (no number)",
                ours=f"envelope at {measured.frequency:.4f} Hz (Δf of pair {k}: {separation:.4f} Hz), depth "
                f"{measured.depth:.0%}",
                passed=abs(measured.frequency - separation) < record.output_frequency / REVOLUTIONS
                and measured.depth > 0.1,
            ),
        ),
    )


def resonance_claim(figure: str, case: Case, speed: float, label: printed.Printed, multiple: int) -> Claim:
    """The paper's label of the dominant component counts shaft cycles; ours is a pair's k."""
    record = steady_record(case.model, speed, REVOLUTIONS)
    whole = spectrum(record.response.acceleration, record.response.rate)
    dominant = float(whole.frequencies[whole.amplitude.argmax()])
    k = strongest_pair(case, speed)
    pair = case.model.reducer.line_frequencies(speed, k)
    of_shaft = multiple * speed / 60.0
    as_defined = multiple * 2.0 * speed / 60.0
    return Claim(
        id=figure,
        statement=f"Dominant component at {speed:g} rpm, close to the resonance",
        paper=str(label),
        ours=f"k = {k}: {pair.circular_spline:.2f} and {pair.flexspline:.2f} Hz, the larger at {dominant:.2f} Hz",
        passed=min(abs(dominant - line) for line in pair) < record.output_frequency
        and abs(pair.circular_spline - of_shaft) < 1e-6
        and abs(pair.circular_spline - case.model.dynamics.natural_frequency)
        < 0.1 * case.model.dynamics.natural_frequency,
        contradiction=True,
        note=f"With ωo2 = 2n/60 the printed {multiple}× would be {as_defined:.0f} Hz; {multiple} cycles a shaft "
        f"revolution are {of_shaft:.2f} Hz, this pair. Numbered here by k.",
    )


def rig_spectrum_panel(case: Case, record: SteadyRecord, top: float) -> Panel:
    """Draw the spectrum of what the sensor shows."""
    return spectrum_panel(case.in_g(record.response.acceleration), record.response.rate, unit="g", top=top)


def figure_13b(cases: Cases) -> Exhibit:
    """Spectrum on the rig at 850 rpm."""
    case = cases["rig"]
    record = steady_record(case.model, case.speed, REVOLUTIONS)
    top = 1.2 * case.model.reducer.line_frequencies(case.speed, _PAIRS).flexspline
    pairs = line_pairs(case.model, case.speed, _PAIRS)
    floor = 1e-3 * max(max(pair) for pair in pairs)
    visible = [k for k, pair in enumerate(pairs, start=1) if min(pair) > floor]
    return Exhibit(
        id="F13b",
        title=f"Spectrum of torsional vibration at {case.speed:g} rpm",
        caption=f"Tangential acceleration at {case.sensor_radius:g} m, {REVOLUTIONS} output revolutions, Hann window.",
        panels=(rig_spectrum_panel(case, record, top),),
        claims=(
            Claim(
                id="F13b",
                statement="Several bi-spectra distribute in the vibration spectrum",
                paper="several",
                ours="pairs k = " + ", ".join(str(k) for k in visible) + " above 1e-3 of the largest line",
                passed=len(visible) >= 2,
            ),
            resonance_claim("F13b", case, case.speed, printed.RIG_DOMINANT, 4),
        ),
    )


def figure_13c(cases: Cases) -> Exhibit:
    """Zoom spectrum on the rig at 850 rpm: which peak is higher."""
    case = cases["rig"]
    model = case.model
    record = steady_record(model, case.speed, REVOLUTIONS)
    values = case.in_g(record.response.acceleration)
    k = strongest_pair(case, case.speed)
    orders = model.reducer.output_orders
    heights = LinePair(
        record.amplitude(values, k * orders.circular_spline), record.amplitude(values, k * orders.flexspline)
    )
    lines = model.reducer.line_frequencies(case.speed, k)
    gain = [abs(model.dynamics.receptance(f)) * f**2 for f in lines]
    diagnosis = diagnose(case, case.speed)
    return Exhibit(
        id="F13c",
        title=f"Zoom spectrum at {case.speed:g} rpm",
        caption=f"Around pair k = {k} and, beside it, k = 1; tangential acceleration, Hann window.",
        panels=tuple(
            zoom_panel(model, record, values, speed_rpm=case.speed, k=number, unit="g")
            for number in sorted({k, 1}, reverse=True)
        ),
        claims=(
            Claim(
                id="F13c",
                statement="The right peak is higher than the left one: the flexspline is the dominant source",
                paper="right higher",
                ours=f"right {heights.flexspline:.3g} g, left {heights.circular_spline:.3g} g (k = {k})",
                passed=heights.flexspline > heights.circular_spline
                and model.flexspline.index > model.circular_spline.index,
                note=f"Near the resonance the slope matters too: equal defects would show right/left = "
                f"{gain[1] / gain[0]:.2f} here.",
            ),
            Claim(
                id="F13c",
                statement="The monitor's verdict on this vibration",
                paper="flexspline",
                ours=verdict_words(diagnosis),
                passed=diagnosis.verdict.component.value == "flexspline",
                note=f"True indexes: flexspline {model.flexspline.index:.1%}, circular spline "
                f"{model.circular_spline.index:.1%}.",
            ),
        ),
    )


def figure_15(cases: Cases) -> Exhibit:
    """Spectrum on the rig at 1700 rpm: resonance of the first pair."""
    case = cases["rig"]
    speed = printed.RIG_FAST_SPEED.value
    record = steady_record(case.model, speed, REVOLUTIONS)
    top = 1.2 * case.model.reducer.line_frequencies(speed, 3).flexspline
    return Exhibit(
        id="F15",
        title=f"Spectrum of combination harmonic resonance at {speed:g} rpm",
        caption=f"Tangential acceleration at {case.sensor_radius:g} m, {REVOLUTIONS} output revolutions, Hann window.",
        panels=(rig_spectrum_panel(case, record, top),),
        claims=(resonance_claim("F15", case, speed, printed.RIG_FAST_DOMINANT, 2),),
    )


def resonance_marks(case: Case) -> tuple[Mark, ...]:
    """Mark the speeds at which ωo2 meets fn/k, and 2fn."""
    fn, order = case.model.dynamics.natural_frequency, case.model.reducer.circular_spline_order
    return tuple(
        Mark(at=60.0 * fn * times / order, label=label)
        for times, label in ((1 / 3, "fn/3"), (0.5, "fn/2"), (1.0, "fn"), (2.0, "2 fn"))
    )

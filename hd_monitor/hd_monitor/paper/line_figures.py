"""Figure 8, equation 5 and Table 1: the bi-spectra, their places and the defects recovered from them."""

from dataclasses import replace

import numpy as np
from scipy.signal import find_peaks

from ..arrays import FloatArray
from ..model import StiffnessSeries, line_pairs, steady_state
from ..model.simulation import TimeResponse
from ..orders.zoom import Zoom, zoom_spectrum
from . import printed
from .cases import Case, Cases
from .diagnosis import SENSOR_NOISE, diagnose
from .exhibit import Claim, Curve, Exhibit, Mark, Panel
from .records import REVOLUTIONS, amplitude, line_heights, output_frequency, spectrum, steady_record

UNEVEN = 3.7
"""Output revolutions of a stretch in which no line completes a whole number of cycles together with the others."""

MICRO = 1e6


def zoom_panel(case: Case, record: TimeResponse, values: FloatArray, *, k: int, unit: str) -> Panel:
    """Draw the zoom spectrum around the k-th pair, its lines marked by the paper's names."""
    pair = case.model.reducer.line_frequencies(case.speed, k)
    zoom = zoom_spectrum(values, 1.0 / record.rate, around=pair, k=k, bins=400)
    times = "" if k == 1 else f"{k}"
    return Panel(
        title=f"Zoom, k = {k}",
        x_label="frequency (Hz)",
        y_label=f"amplitude ({unit})",
        curves=(Curve(x=zoom.frequencies, y=zoom.amplitude),),
        marks=(
            Mark(at=pair.circular_spline, label=f"{times}ωo2 (circular spline)"),
            Mark(at=pair.flexspline, label=f"{times}ωo1 (flexspline)"),
        ),
        y_range=(0.0, 1.7 * float(zoom.amplitude.max())),
    )


def spectrum_panel(
    values: FloatArray, rate: float, *, unit: str, top: float, bottom: float = 0.0, title: str = "Spectrum"
) -> Panel:
    """Draw the amplitude spectrum from `bottom` to `top` [Hz]."""
    frequencies, amplitudes = spectrum(values, rate)
    shown = (frequencies >= bottom) & (frequencies <= top)
    return Panel(
        title=title,
        x_label="frequency (Hz)",
        y_label=f"amplitude ({unit})",
        curves=(Curve(x=frequencies[shown], y=amplitudes[shown]),),
        x_range=(bottom, top),
        y_range=(0.0, 1.1 * float(amplitudes[shown].max())),
    )


def peak_near(record: TimeResponse, values: FloatArray, frequency: float, threshold: float) -> float:
    """Frequency [Hz] of the spectrum's local maximum nearest to `frequency`; NaN if none is above `threshold`."""
    frequencies, amplitudes = spectrum(values, record.rate)
    found = frequencies[find_peaks(amplitudes, threshold)[0]]
    return float(found[np.abs(found - frequency).argmin()]) if found.size else float("nan")


def bispectra(case: Case) -> Exhibit:
    """Spectrum of the simulated displacement, and its pairs."""
    model, harmonics = case.model, case.model.harmonics
    record = steady_record(model, case.speed)
    values = record.displacement * MICRO
    top = 1.25 * model.reducer.line_frequencies(case.speed, harmonics).flexspline
    return Exhibit(
        title="The bi-spectra in the spectrum of forced parametric vibration",
        caption=f"fn = {model.dynamics.natural_frequency:g} Hz, ζ = {model.dynamics.damping_ratio:g}, "
        f"M0 = {model.torque.mean:g} N·m, {case.speed:g} rpm; displacement, {REVOLUTIONS} output revolutions, "
        "Hann window.",
        panels=(
            spectrum_panel(values, record.rate, unit="µrad", top=top, title="Spectrum of θ"),
            *(zoom_panel(case, record, values, k=k, unit="µrad") for k in range(1, harmonics + 1)),
        ),
        facts=tuple(
            (f"θ'' of pair k = {k}", f"circular spline {p.circular_spline:.4g}, flexspline {p.flexspline:.4g} rad/s²")
            for k, p in enumerate(line_pairs(model, case.speed), start=1)
        ),
    )


def figure_8(cases: Cases) -> Exhibit:
    """The bi-spectra of Table 1 in the forced parametric vibration."""
    case = cases["table_1"]
    model, reducer = case.model, case.model.reducer
    record = steady_record(model, case.speed)
    values = record.displacement
    bin_width = output_frequency(record) / REVOLUTIONS
    harmonics = range(1, model.harmonics + 1)
    pairs = [reducer.line_frequencies(case.speed, k) for k in harmonics]
    threshold = 1e-3 * max(line_heights(model, values))
    found = [[peak_near(record, values, line, threshold) for line in pair] for pair in pairs]
    at_home = bool((np.abs(np.subtract(found, pairs)) < bin_width).all())
    state = steady_state(model, case.speed)
    balance = [
        (abs(state.acceleration_phasor(k * order)), amplitude(record.acceleration, k * order))
        for k in harmonics
        for order in reducer.output_orders
    ]
    error = max(abs(a - b) for a, b in balance) / max(b for _, b in balance)
    first = pairs[0]
    alone = replace(model, flexspline=StiffnessSeries()), replace(model, circular_spline=StiffnessSeries())
    left, right = (line_heights(one, steady_record(one, case.speed).displacement) for one in alone)
    left_only, right_only = left.circular_spline / left.flexspline, right.flexspline / right.circular_spline
    exhibit = bispectra(case)
    difference = "largest difference of harmonic balance and time integration", f"{error:.1e} of the largest line"
    return replace(
        exhibit,
        caption=f"Table 1, {exhibit.caption}",
        claims=(
            Claim(
                statement="Characteristic frequencies ωo2/2π and ωo1/2π",
                paper=f"{printed.CIRCULAR_SPLINE_LINE.value:g} and {printed.FLEXSPLINE_LINE}",
                ours=f"{first.circular_spline:.4f} and {first.flexspline:.4f} Hz",
                passed=np.allclose(
                    first, (printed.CIRCULAR_SPLINE_LINE.value, printed.FLEXSPLINE_LINE.value), rtol=0.0, atol=1e-9
                ),
            ),
            Claim(
                statement="Several bi-spectra, at k·ωo2 and k·ωo1",
                paper="several pairs",
                ours="peaks at " + ", ".join(f"{a:.3f}/{b:.3f}" for a, b in found) + " Hz",
                passed=at_home and len(found) > 1,
                note="Shown as displacement; in acceleration the heights scale with the square of the frequency.",
            ),
            Claim(
                statement="The left peak is the circular spline's, the right one the flexspline's: with one of "
                "them perfect",
                paper="left: fixed rigid gear; right: flexspline",
                ours=f"left/right = {left_only:.0e} with the circular spline's defect alone, "
                f"right/left = {right_only:.0e} with the flexspline's alone",
                passed=min(left_only, right_only) > 100.0,
            ),
        ),
        facts=(*exhibit.facts, difference),
    )


def line_distance(record: TimeResponse, left_order: float, right_order: float) -> float:
    """Distance [Hz] of the tops of two lines in a zoom spectrum, of a stretch that fits no line on purpose."""
    count = round(UNEVEN / REVOLUTIONS * record.acceleration.size)
    tops = []
    for order in (left_order, right_order):
        low, high = ((order + shift) * output_frequency(record) for shift in (-0.9, 0.9))
        zoom = Zoom(count, 1.0 / record.rate, low, high, 361)
        tops.append(float(zoom.frequencies[zoom(record.acceleration[:count]).argmax()]))
    return tops[1] - tops[0]


def equation_5(cases: Cases) -> Exhibit:
    """The distance of the two lines against eq. 5, at several speeds."""
    case = cases["table_1"]
    cs, fs = case.model.reducer.output_orders
    z2_to_z1 = printed.CIRCULAR_SPLINE_TEETH.value / printed.FLEXSPLINE_TEETH.value
    speeds = np.unique([0.5 * case.speed, case.speed, cases["rig"].speed, 2.0 * cases["rig"].speed])
    harmonics = range(1, case.model.harmonics + 1)
    records = [steady_record(case.model, speed) for speed in speeds]
    measured = np.array([[line_distance(record, cs * k, fs * k) for record in records] for k in harmonics])
    expected = np.multiply.outer(harmonics, speeds) / 30.0 * (z2_to_z1 - 1.0)
    worst = float(np.abs(measured / expected - 1.0).max())
    curves = [Curve(x=speeds, y=line, label=f"eq. 5, k = {k}") for k, line in zip(harmonics, expected, strict=True)]
    found = Curve(x=np.tile(speeds, len(harmonics)), y=measured.ravel(), label="measured", style="points")
    return Exhibit(
        title="Distance of the two lines of a bi-spectrum",
        caption="Peaks found in spectra of simulated vibration against Δf = k·n/30·(z2/z1 − 1).",
        panels=(
            Panel(title="Equation 5", x_label="wave-generator speed (rpm)", y_label="Δf (Hz)", curves=(*curves, found)),
        ),
        claims=(
            Claim(
                statement="Δf = k·n/30·(z2/z1 − 1), k = 1…3, four speeds",
                paper="Δf by eq. 5",
                ours=f"largest deviation {worst:.2%}",
                passed=worst < 0.01,
                note=f"Tops of zoom spectra of {UNEVEN:g} output revolutions, which put no line on a Fourier bin.",
            ),
        ),
        facts=tuple(
            (
                f"Δf measured, k = {k}",
                ", ".join(f"{d:.4f} Hz at {n:g} rpm" for d, n in zip(distances, speeds, strict=True)),
            )
            for k, distances in zip(harmonics, measured, strict=True)
        ),
    )


def table_1(cases: Cases) -> Exhibit:
    """Let the monitor identify Table 1's indexes from acceleration and angle."""
    case = cases["table_1"]
    found = diagnose(case).identification
    claims, curves, identified = [], [], [np.empty((2, 0))]
    for row, (name, values) in enumerate(printed.TABLE_1.items(), start=1):
        measured = np.abs(() if found is None else getattr(found, name))[: len(values)]
        complete = measured.size == len(values)
        part = name.replace("_", " ")
        claims.append(
            Claim(
                statement=", ".join(f"β{row}{k}" for k in range(1, len(values) + 1))
                + f" ({part}), identified from the vibration",
                paper=", ".join(f"{v:g}" for v in values),
                ours=", ".join(f"{v:.4f}" for v in measured) or "nothing identified",
                passed=complete and float(np.abs(measured - values).max()) < 0.001,
                note=f"The monitor knows teeth, fn, ζ, J and M0 and nothing of the indexes; sensor noise "
                f"{SENSOR_NOISE:g} rad/s².",
            )
        )
        places = np.arange(1.0, len(values) + 1.0) + 0.06 * (2 * row - 3)
        curves.append(Curve(x=places, y=np.asarray(values), label=f"{part}, printed", style="stems"))
        if complete:
            identified.append(np.stack([places, measured]))
    x, y = np.concatenate(identified, axis=1)
    return Exhibit(
        title="Index values of the stiffness fluctuation",
        caption=f"Simulated at {case.speed:g} rpm, identified by the monitor from acceleration and joint angle.",
        panels=(
            Panel(
                title="Table 1",
                x_label="harmonic",
                y_label="index β",
                curves=(*curves, Curve(x=x, y=y, label="identified", style="points")),
                x_step=1.0,
                x_range=(0.5, 3.5),
                y_range=(0.0, 0.075),
            ),
        ),
        claims=tuple(claims),
    )

"""Table 1, figure 8 and equation 5: the bi-spectra, their places and what they say of the defects."""

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..model import ParametricModel, StiffnessSeries, steady_state
from ..orders.zoom import Zoom, zoom_spectrum
from . import printed
from .cases import Case, Cases
from .claim import Claim
from .exhibit import Curve, Exhibit, Mark, Panel
from .records import SteadyRecord, peaks, spectrum, steady_record

REVOLUTIONS = 4
"""Of the output, in every spectrum: the pair k = 1 is then 8 bins apart."""

UNEVEN = 3.7
"""Output revolutions of a stretch in which no line completes a whole number of cycles together with the others."""

MICRO = 1e6


def line_marks(model: ParametricModel, speed_rpm: float, k: int) -> tuple[Mark, ...]:
    """Mark a pair's two lines by the paper's names."""
    pair = model.reducer.line_frequencies(speed_rpm, k)
    times = "" if k == 1 else f"{k}"
    return (
        Mark(at=pair.circular_spline, label=f"{times}ωo2 (circular spline)"),
        Mark(at=pair.flexspline, label=f"{times}ωo1 (flexspline)"),
    )


def zoom_panel(
    model: ParametricModel, record: SteadyRecord, values: FloatArray, *, speed_rpm: float, k: int, unit: str
) -> Panel:
    """Draw the zoom spectrum around the k-th pair."""
    zoom = zoom_spectrum(
        values, 1.0 / record.response.rate, around=model.reducer.line_frequencies(speed_rpm, k), k=k, bins=400
    )
    return Panel(
        title=f"Zoom, k = {k}",
        x_label="frequency (Hz)",
        y_label=f"amplitude ({unit})",
        curves=(Curve(x=zoom.frequencies, y=zoom.amplitude),),
        marks=line_marks(model, speed_rpm, k),
        y_range=(0.0, 1.7 * float(zoom.amplitude.max())),
    )


def spectrum_panel(
    values: FloatArray, rate: float, *, unit: str, top: float, bottom: float = 0.0, title: str = "Spectrum"
) -> Panel:
    """Draw the amplitude spectrum from `bottom` to `top` [Hz]."""
    whole = spectrum(values, rate)
    shown = (whole.frequencies >= bottom) & (whole.frequencies <= top)
    return Panel(
        title=title,
        x_label="frequency (Hz)",
        y_label=f"amplitude ({unit})",
        curves=(Curve(x=whole.frequencies[shown], y=whole.amplitude[shown]),),
        x_range=(bottom, top),
        y_range=(0.0, 1.1 * float(whole.amplitude[shown].max())),
    )


def peak_near(record: SteadyRecord, values: FloatArray, frequency: float, threshold: float) -> float:
    """Frequency [Hz] of the spectrum's local maximum nearest to `frequency`; NaN if none is above `threshold`."""
    found = peaks(spectrum(values, record.response.rate), threshold)
    return float(found[np.abs(found - frequency).argmin()]) if found.size else float("nan")


def harmonics_of(model: ParametricModel) -> range:
    """Numbers k of the pairs that the model's defects drive directly."""
    return range(1, max(len(model.flexspline.beta), len(model.circular_spline.beta), 1) + 1)


def bispectra_panels(case: Case, record: SteadyRecord) -> tuple[Panel, ...]:
    """Draw figure 8: the spectrum of the simulated displacement, and its pairs."""
    values = record.response.displacement * MICRO
    ks = harmonics_of(case.model)
    top = 1.25 * case.model.reducer.line_frequencies(case.speed, ks[-1]).flexspline
    return (
        spectrum_panel(values, record.response.rate, unit="µrad", top=top, title="Spectrum of θ"),
        *(zoom_panel(case.model, record, values, speed_rpm=case.speed, k=k, unit="µrad") for k in ks),
    )


def figure_8(cases: Cases) -> Exhibit:
    """The bi-spectra of Table 1 in the forced parametric vibration."""
    case = cases["table_1"]
    model, reducer = case.model, case.model.reducer
    record = steady_record(model, case.speed, REVOLUTIONS)
    values = record.response.displacement
    bin_width = record.output_frequency / REVOLUTIONS
    pairs = [reducer.line_frequencies(case.speed, k) for k in harmonics_of(model)]
    threshold = 1e-3 * max(record.amplitude(values, order) for order in reducer.output_orders)
    found = [[peak_near(record, values, line, threshold) for line in pair] for pair in pairs]
    at_home = all(
        abs(f - line) < bin_width
        for fs, pair in zip(found, pairs, strict=True)
        for f, line in zip(fs, pair, strict=True)
    )

    state = steady_state(model, case.speed)
    balance = [
        (abs(state.acceleration_phasor(k * order)), record.amplitude(record.response.acceleration, k * order))
        for k in harmonics_of(model)
        for order in reducer.output_orders
    ]
    error = max(abs(a - b) for a, b in balance) / max(b for _, b in balance)
    first = reducer.line_frequencies(case.speed)
    alone = {
        "circular spline": replace(model, flexspline=StiffnessSeries()),
        "flexspline": replace(model, circular_spline=StiffnessSeries()),
    }
    ratios = {}
    for name, one in alone.items():
        single = steady_record(one, case.speed, REVOLUTIONS)
        left, right = (single.amplitude(single.response.displacement, order) for order in reducer.output_orders)
        ratios[name] = left / right if name == "circular spline" else right / left
    return Exhibit(
        id="F8",
        title="The bi-spectra in the spectrum of forced parametric vibration",
        caption=f"Table 1, fn = {model.dynamics.natural_frequency:g} Hz, ζ = {model.dynamics.damping_ratio:g}, "
        f"M0 = {model.torque.mean:g} N·m, {case.speed:g} rpm; displacement, {REVOLUTIONS} output revolutions, "
        "Hann window.",
        panels=bispectra_panels(case, record),
        claims=(
            Claim(
                id="F8",
                statement="Characteristic frequencies ωo2/2π and ωo1/2π",
                paper=f"{printed.CIRCULAR_SPLINE_LINE.value:g} and {printed.FLEXSPLINE_LINE}",
                ours=f"{first.circular_spline:.4f} and {first.flexspline:.4f} Hz",
                passed=abs(first.circular_spline - printed.CIRCULAR_SPLINE_LINE.value) < 1e-9
                and abs(first.flexspline - printed.FLEXSPLINE_LINE.value) < 1e-9,
            ),
            Claim(
                id="F8",
                statement="Several bi-spectra, at k·ωo2 and k·ωo1",
                paper="several pairs",
                ours="peaks at " + ", ".join(f"{a:.3f}/{b:.3f}" for a, b in found) + " Hz",
                passed=at_home and len(found) > 1,
                note="Shown as displacement; in acceleration the heights scale with the square of the frequency.",
            ),
            Claim(
                id="F8",
                statement="The left peak is the circular spline's, the right one the flexspline's: with one of "
                "them perfect",
                paper="left: fixed rigid gear; right: flexspline",
                ours=f"left/right = {ratios['circular spline']:.0e} with the circular spline's defect alone, "
                f"right/left = {ratios['flexspline']:.0e} with the flexspline's alone",
                passed=min(ratios.values()) > 100.0,
            ),
        ),
        facts=(("largest difference of harmonic balance and time integration", f"{error:.1e} of the largest line"),),
    )


def line_distance(record: SteadyRecord, left_order: float, right_order: float) -> float:
    """Distance [Hz] of the tops of two lines in a zoom spectrum, of a stretch that fits no line on purpose."""
    response = record.response
    count = round(UNEVEN / record.revolutions * response.times.size)
    tops = []
    for order in (left_order, right_order):
        low, high = ((order + shift) * record.output_frequency for shift in (-0.9, 0.9))
        zoom = Zoom(count, 1.0 / response.rate, low, high, 361)
        tops.append(float(zoom.frequencies[zoom(response.acceleration[:count]).argmax()]))
    return tops[1] - tops[0]


def equation_5(cases: Cases) -> Exhibit:
    """The distance of the two lines against eq. 5, at several speeds."""
    case = cases["table_1"]
    z2_to_z1 = printed.CIRCULAR_SPLINE_TEETH.value / printed.FLEXSPLINE_TEETH.value
    rows, worst = [], 0.0
    orders = case.model.reducer.output_orders
    speeds = np.unique([0.5 * case.speed, case.speed, cases["rig"].speed, 2.0 * cases["rig"].speed])
    curves, places, distances = [], list[float](), list[float]()
    for k in harmonics_of(case.model):
        measured = []
        for speed in speeds:
            record = steady_record(case.model, speed, REVOLUTIONS)
            distance = line_distance(record, orders.circular_spline * k, orders.flexspline * k)
            expected = k * speed / 30.0 * (z2_to_z1 - 1.0)
            worst = max(worst, abs(distance / expected - 1.0))
            measured.append(distance)
        rows.append(
            (
                f"Δf measured, k = {k}",
                ", ".join(f"{d:.4f} Hz at {n:g} rpm" for d, n in zip(measured, speeds, strict=True)),
            )
        )
        places.extend(speeds)
        distances.extend(measured)
        curves.append(Curve(x=speeds, y=k * speeds / 30.0 * (z2_to_z1 - 1.0), label=f"eq. 5, k = {k}"))
    return Exhibit(
        id="E5",
        title="Distance of the two lines of a bi-spectrum",
        caption="Peaks found in spectra of simulated vibration against Δf = k·n/30·(z2/z1 − 1).",
        panels=(
            Panel(
                title="Equation 5",
                x_label="wave-generator speed (rpm)",
                y_label="Δf (Hz)",
                curves=(
                    *curves,
                    Curve(x=np.asarray(places), y=np.asarray(distances), label="measured", style="points"),
                ),
            ),
        ),
        claims=(
            Claim(
                id="E5",
                statement="Δf = k·n/30·(z2/z1 − 1), k = 1…3, four speeds",
                paper="Δf by eq. 5",
                ours=f"largest deviation {worst:.2%}",
                passed=worst < 0.01,
                note=f"Tops of zoom spectra of {UNEVEN:g} output revolutions, which put no line on a Fourier bin.",
            ),
        ),
        facts=tuple(rows),
    )

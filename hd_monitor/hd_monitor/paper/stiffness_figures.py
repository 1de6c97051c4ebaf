"""Figures 4 and 7: stiffness over the wave-generator angle, computed and measured on a static test bed."""

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..model import ParametricModel, StiffnessSeries
from ..model.static_test import StiffnessFit, fit_stiffness
from . import printed
from .cases import Case, Cases
from .exhibit import Claim, Curve, Exhibit, Panel
from .speed_figures import resonance_speed

ANGLE_LABEL = "wave-generator angle (°)"
STIFFNESS_LABEL = "torsional stiffness (N·m/rad)"


def stiffness_curves(model: ParametricModel, revolutions: float) -> dict[str, FloatArray]:
    """Stiffness [N·m/rad] over some wave-generator revolutions (eq. 2).

    Of shape (points,), with the defect of one spline at a time and with ``both``, over the ``angle`` [rad].
    """
    angle = np.linspace(0.0, 2.0 * np.pi * revolutions, int(720 * revolutions) + 1)
    output, none = angle / model.reducer.reduction, StiffnessSeries()
    return {
        "angle": angle,
        "circular spline": replace(model, flexspline=none).stiffness(output),
        "flexspline": replace(model, circular_spline=none).stiffness(output),
        "both": model.stiffness(output),
    }


def cycles_per_revolution(angle: FloatArray, values: FloatArray) -> float:
    """Cycles of `values` per revolution of `angle` [rad], from the first to the last rise through the mean.

    NaN if it never rises twice.
    """
    level = values - values.mean()
    rises = np.flatnonzero((level[:-1] < 0.0) & (level[1:] >= 0.0))
    if rises.size < 2:
        return float("nan")
    places = angle[rises] - level[rises] * np.diff(angle)[rises] / np.diff(level)[rises]
    return float((rises.size - 1) * 2.0 * np.pi / (places[-1] - places[0]))


def static_measurement(case: Case) -> StiffnessFit:
    """Measure a case on the virtual static test bed, over one wave-generator revolution."""
    positions = round(2.0 * np.pi / case.static_step)
    angle = np.asarray(case.static_step * np.arange(positions + 1), dtype=np.float64)
    harmonics = max(1, min(3, (positions // 2 - 1) // 2))
    return fit_stiffness(angle, case.static_test.measure(case.model, angle), harmonics=harmonics)


def static_panel(case: Case, measured: StiffnessFit, title: str) -> Panel:
    """Draw readings and fit as figures 7 and 20 do."""
    smooth = np.linspace(0.0, float(measured.angle[-1]), 721)
    degrees, mean, read = np.rad2deg(smooth), measured.mean, f"measured every {np.rad2deg(case.static_step):g}°"
    return Panel(
        title=title,
        x_label=ANGLE_LABEL,
        y_label=STIFFNESS_LABEL,
        x_step=60.0,
        curves=(
            Curve(x=np.rad2deg(measured.angle), y=measured.readings, label=read, style="dotted points"),
            Curve(x=degrees, y=measured(smooth), label=f"fit, β = {measured.index:.1%}"),
            Curve(x=degrees[[0, -1]], y=np.full(2, mean), label=f"Kav = {mean:,.0f} N·m/rad", style="dashed"),
        ),
    )


def stiffness_over_angle(case: Case) -> Exhibit:
    """Each spline's stiffness, both over as many revolutions as they take to come back, and characteristic numbers."""
    model, reducer = case.model, case.model.reducer
    pair, mount = reducer.line_frequencies(case.speed), reducer.mount.value.replace("_", " ")
    near, far = (stiffness_curves(model, revolutions) for revolutions in (2.0, reducer.reduction))
    degrees = np.rad2deg(near["angle"])
    travel = [np.rad2deg(reducer.travel_to_separate(k, window="boxcar")) for k in (1, 2, 3)]
    return Exhibit(
        title="Periodic time-varying torsional stiffness",
        caption=f"z1 = {reducer.flexspline_teeth}, z2 = {reducer.circular_spline_teeth}, {mount}.",
        panels=(
            Panel(
                title="One defect at a time",
                x_label=ANGLE_LABEL,
                y_label=STIFFNESS_LABEL,
                x_step=90.0,
                curves=(
                    Curve(x=degrees, y=near["flexspline"], label="flexspline defect"),
                    Curve(x=degrees, y=near["circular spline"], label="circular spline defect", style="dashed"),
                ),
            ),
            Panel(
                title="Both, over one output revolution",
                x_label="wave-generator revolutions",
                y_label=STIFFNESS_LABEL,
                curves=(Curve(x=far["angle"] / (2.0 * np.pi), y=far["both"]),),
            ),
        ),
        facts=(
            ("reduction", f"{reducer.reduction:g}"),
            ("circular spline, cycles per wave-generator revolution", f"{reducer.circular_spline_order:.5f}"),
            ("flexspline, cycles per wave-generator revolution", f"{reducer.flexspline_order:.5f}"),
            (f"first pair at {case.speed:g} rpm", f"{pair.circular_spline:.4f} and {pair.flexspline:.4f} Hz"),
            (f"Δf at {case.speed:g} rpm (eq. 5)", f"{reducer.line_separation(case.speed):.4f} Hz"),
            (
                "output travel that separates the pairs k = 1, 2, 3",
                ", ".join(f"{x:g}°" for x in travel) + " (Hann: twice that)",
            ),
            ("mean stiffness J(2πfn)²", f"{model.dynamics.stiffness:,.0f} N·m/rad"),
            ("ωo2 meets fn, fn/2, fn/3 at", ", ".join(f"{resonance_speed(case) / k:.0f}" for k in (1, 2, 3)) + " rpm"),
            ("index of the circular spline", f"{model.circular_spline.index:.2%}"),
            ("index of the flexspline", f"{model.flexspline.index:.2%}"),
        ),
    )


def figure_4(cases: Cases) -> Exhibit:
    """Stiffness over the wave-generator angle with a defect of either spline."""
    case = cases["stiffness_sketch"]
    long = stiffness_curves(case.model, case.model.reducer.reduction)
    splines = {"circular spline": printed.CIRCULAR_SPLINE_CYCLES, "flexspline": printed.FLEXSPLINE_CYCLES}
    return replace(
        stiffness_over_angle(case),
        claims=tuple(
            Claim(
                statement=f"Stiffness fluctuation of a {name} defect, cycles per wave-generator revolution",
                paper=str(value),
                ours=f"{cycles:.5f} (period {360.0 / cycles:.3f}°)",
                passed=abs(cycles - value.value) < 1e-4,
            )
            for name, value in splines.items()
            for cycles in (cycles_per_revolution(long["angle"], long[name]),)
        ),
    )


def static_stiffness(case: Case) -> Exhibit:
    """Static stiffness at stepped positions, the fitted curve and the index."""
    measured = static_measurement(case)
    return Exhibit(
        title="Static torsional stiffness over the wave-generator position",
        caption=f"Virtual test bed, {case.static_test.torque:g} N·m, every {np.rad2deg(case.static_step):g}°, readings "
        "rounded to the instruments' steps.",
        panels=(static_panel(case, measured, f"Static stiffness at {case.static_test.torque:g} N·m"),),
        facts=(("index Δ/Kav", f"{measured.index:.2%}"), ("Kav", f"{measured.mean:,.0f} N·m/rad")),
    )


def figure_7(cases: Cases) -> Exhibit:
    """Static stiffness of the sample that the paper measured."""
    case = cases["static_sample"]
    exhibit, measured = static_stiffness(case), static_measurement(case)
    table_1 = static_measurement(replace(case, model=cases["table_1"].model))
    kav, inertia, fn = printed.STATIC_MEAN_STIFFNESS, printed.INERTIA, printed.NATURAL_FREQUENCY
    implied = float(np.sqrt(kav.value / inertia.value) / (2.0 * np.pi))
    return replace(
        exhibit,
        claims=(
            Claim(
                statement="Index of stiffness fluctuation β = Δ/Kav from readings every 30° at 40 N·m",
                paper=str(printed.STATIC_INDEX),
                ours=f"{measured.index:.2%}",
                passed=abs(measured.index - printed.STATIC_INDEX.value) < 0.001,
                note="The sample itself cannot be measured again: a virtual one with this index is put on the "
                "virtual bed, and the procedure must return it. Δ is half the fitted curve's range, so that β is eq. "
                "2's amplitude.",
            ),
            Claim(
                statement="Kav of the sample, J and fn belong together: fn = √(Kav/J)/2π",
                paper=f"{kav}, {inertia}, {fn}",
                ours=f"{implied:.2f} Hz from the printed Kav and J; fn and J give {measured.mean:,.0f} N·m/rad",
                passed=abs(implied / fn.value - 1.0) > 0.5,
                contradiction=True,
                note="The three cannot hold together; the model is given by fn, ζ and J.",
            ),
        ),
        facts=(*exhibit.facts, ("index of Table 1's model on the same bed", f"{table_1.index:.2%}")),
    )

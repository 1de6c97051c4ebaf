"""Figures 4 and 7: stiffness over the wave-generator angle, computed and measured on a static test bed."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from ..model import ParametricModel, StiffnessSeries
from ..model.static_test import StiffnessFit, fit_stiffness
from . import printed
from .cases import Case, Cases
from .exhibit import Claim, Curve, Exhibit, Panel

ANGLE_LABEL = "wave-generator angle (°)"
STIFFNESS_LABEL = "torsional stiffness (N·m/rad)"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StiffnessCurves:
    """Stiffness [N·m/rad] over the wave-generator angle [rad], with one spline's defect at a time and with both."""

    angle: FloatArray
    circular_spline: FloatArray
    flexspline: FloatArray
    both: FloatArray


def stiffness_curves(model: ParametricModel, revolutions: float) -> StiffnessCurves:
    """Stiffness over some wave-generator revolutions (eq. 2)."""
    angle = np.linspace(0.0, 2.0 * np.pi * revolutions, int(720 * revolutions) + 1)
    output = angle / model.reducer.reduction
    none = StiffnessSeries()

    def stiffness(of: ParametricModel) -> FloatArray:
        return of.dynamics.stiffness * (1.0 + of.stiffness_fluctuation(output))

    return StiffnessCurves(
        angle=angle,
        circular_spline=stiffness(replace(model, flexspline=none)),
        flexspline=stiffness(replace(model, circular_spline=none)),
        both=stiffness(model),
    )


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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StaticMeasurement:
    """Readings of the static test bed: positions [rad], stiffness [N·m/rad], and the curve through them."""

    angle: FloatArray
    stiffness: FloatArray
    fit: StiffnessFit


def static_measurement(case: Case) -> StaticMeasurement:
    """Measure a case on the virtual static test bed, over one wave-generator revolution."""
    positions = round(2.0 * np.pi / case.static_step)
    angle = np.asarray(case.static_step * np.arange(positions + 1), dtype=np.float64)
    stiffness = case.static_test.measure(case.model, angle)
    harmonics = max(1, min(3, (positions // 2 - 1) // 2))
    return StaticMeasurement(angle=angle, stiffness=stiffness, fit=fit_stiffness(angle, stiffness, harmonics=harmonics))


def static_panel(case: Case, measured: StaticMeasurement, title: str) -> Panel:
    """Draw readings and fit as figures 7 and 20 do."""
    smooth = np.linspace(0.0, float(measured.angle[-1]), 721)
    degrees, mean, read = np.rad2deg(smooth), measured.fit.mean, f"measured every {np.rad2deg(case.static_step):g}°"
    return Panel(
        title=title,
        x_label=ANGLE_LABEL,
        y_label=STIFFNESS_LABEL,
        x_step=60.0,
        curves=(
            Curve(x=np.rad2deg(measured.angle), y=measured.stiffness, label=read, style="dotted points"),
            Curve(x=degrees, y=measured.fit(smooth), label=f"fit, β = {measured.fit.index:.1%}"),
            Curve(x=degrees[[0, -1]], y=np.full(2, mean), label=f"Kav = {mean:,.0f} N·m/rad", style="dashed"),
        ),
    )


def stiffness_panels(model: ParametricModel) -> tuple[Panel, ...]:
    """Draw figure 4: each spline's stiffness, then both over as many revolutions as they take to come back."""
    near = stiffness_curves(model, 2.0)
    far = stiffness_curves(model, model.reducer.reduction)
    degrees = np.rad2deg(near.angle)
    return (
        Panel(
            title="One defect at a time",
            x_label=ANGLE_LABEL,
            y_label=STIFFNESS_LABEL,
            x_step=90.0,
            curves=(
                Curve(x=degrees, y=near.flexspline, label="flexspline defect"),
                Curve(x=degrees, y=near.circular_spline, label="circular spline defect", style="dashed"),
            ),
        ),
        Panel(
            title="Both, over one output revolution",
            x_label="wave-generator revolutions",
            y_label=STIFFNESS_LABEL,
            curves=(Curve(x=far.angle / (2.0 * np.pi), y=far.both),),
        ),
    )


def figure_4(cases: Cases) -> Exhibit:
    """Stiffness over the wave-generator angle with a defect of either spline."""
    case = cases["stiffness_sketch"]
    reducer = case.model.reducer
    long = stiffness_curves(case.model, reducer.reduction)
    splines = (
        ("circular spline", long.circular_spline, printed.CIRCULAR_SPLINE_CYCLES),
        ("flexspline", long.flexspline, printed.FLEXSPLINE_CYCLES),
    )
    return Exhibit(
        title="Periodic time-varying torsional stiffness",
        caption=f"z1 = {reducer.flexspline_teeth}, z2 = {reducer.circular_spline_teeth}, first harmonic of each "
        "spline.",
        panels=stiffness_panels(case.model),
        claims=tuple(
            Claim(
                statement=f"Stiffness fluctuation of a {name} defect, cycles per wave-generator revolution",
                paper=str(value),
                ours=f"{cycles:.5f} (period {360.0 / cycles:.3f}°)",
                passed=abs(cycles - value.value) < 1e-4,
            )
            for name, stiffness, value in splines
            for cycles in (cycles_per_revolution(long.angle, stiffness),)
        ),
    )


def figure_7(cases: Cases) -> Exhibit:
    """Static stiffness at stepped positions, the fitted curve and the index."""
    case = cases["static_sample"]
    measured = static_measurement(case)
    table_1 = static_measurement(replace(case, model=cases["table_1"].model))
    kav, inertia, fn = printed.STATIC_MEAN_STIFFNESS, printed.INERTIA, printed.NATURAL_FREQUENCY
    implied = float(np.sqrt(kav.value / inertia.value) / (2.0 * np.pi))
    return Exhibit(
        title="Static torsional stiffness over the wave-generator position",
        caption=f"Virtual test bed, {case.static_test.torque:g} N·m, every {np.rad2deg(case.static_step):g}°, readings "
        "rounded to the instruments' steps.",
        panels=(static_panel(case, measured, f"Static stiffness at {case.static_test.torque:g} N·m"),),
        claims=(
            Claim(
                statement="Index of stiffness fluctuation β = Δ/Kav from readings every 30° at 40 N·m",
                paper=str(printed.STATIC_INDEX),
                ours=f"{measured.fit.index:.2%}",
                passed=abs(measured.fit.index - printed.STATIC_INDEX.value) < 0.001,
                note="The sample itself cannot be measured again: a virtual one with this index is put on the "
                "virtual bed, and the procedure must return it. Δ is half the fitted curve's range, so that β is eq. "
                "2's amplitude.",
            ),
            Claim(
                statement="Kav of the sample, J and fn belong together: fn = √(Kav/J)/2π",
                paper=f"{kav}, {inertia}, {fn}",
                ours=f"{implied:.2f} Hz from the printed Kav and J; fn and J give {measured.fit.mean:,.0f} N·m/rad",
                passed=abs(implied / fn.value - 1.0) > 0.5,
                contradiction=True,
                note="The three cannot hold together; the model is given by fn, ζ and J.",
            ),
        ),
        facts=(("index of Table 1's model on the same bed", f"{table_1.fit.index:.2%}"),),
    )

"""The paper's figures for a user's own reducer: the same functions, without claims."""

from dataclasses import replace

import numpy as np

from ..model import growth_rate, line_pairs
from .cases import Case
from .exhibit import Exhibit
from .line_figures import bispectra_panels
from .records import REVOLUTIONS, steady_record
from .reproduction import Entry
from .rig_figures import beat_panel, phase_panels
from .speed_figures import chart_panel, curve_panel, property_curve, resonance_speed
from .stiffness_figures import static_measurement, static_panel, stiffness_panels
from .sweep_figures import sweep_panel, sweep_response


def geometry(case: Case) -> Exhibit:
    """Stiffness over the angle, and the reducer's characteristic numbers."""
    model, reducer = case.model, case.model.reducer
    pair, mount = reducer.line_frequencies(case.speed), reducer.mount.value.replace("_", " ")
    travel = [np.rad2deg(reducer.travel_to_separate(k, window="boxcar")) for k in (1, 2, 3)]
    return Exhibit(
        title="Time-varying torsional stiffness",
        caption=f"{reducer.flexspline_teeth}/{reducer.circular_spline_teeth} teeth, {mount}.",
        panels=stiffness_panels(model),
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


def static(case: Case) -> Exhibit:
    """The static stiffness test."""
    measured = static_measurement(case)
    return Exhibit(
        title="Static torsional stiffness",
        caption=f"Virtual test bed, {case.static_test.torque:g} N·m.",
        panels=(static_panel(case, measured, "Static stiffness"),),
        facts=(("index Δ/Kav", f"{measured.index:.2%}"), ("Kav", f"{measured.mean:,.0f} N·m/rad")),
    )


def spectra(case: Case) -> Exhibit:
    """Spectrum and zoom spectra at the case's speed."""
    pairs = line_pairs(case.model, case.speed)
    return Exhibit(
        title=f"Bi-spectra at {case.speed:g} rpm",
        caption=f"Displacement, {REVOLUTIONS} output revolutions, Hann window.",
        panels=bispectra_panels(case, steady_record(case.model, case.speed)),
        facts=tuple(
            (f"θ'' of pair k = {k}", f"circular spline {p.circular_spline:.4g}, flexspline {p.flexspline:.4g} rad/s²")
            for k, p in enumerate(pairs, start=1)
        ),
    )


def sweep(case: Case) -> Exhibit:
    """Envelope of a sweep."""
    return Exhibit(
        title="Envelope of a sweep",
        caption=f"ωo2/2π from {case.sweep.start:g} to {case.sweep.stop:g} Hz at {case.sweep.rate:.3g} Hz/s.",
        panels=(sweep_panel(sweep_response(case), "Sweep"),),
    )


def history(case: Case) -> Exhibit:
    """Time history at the case's speed."""
    return Exhibit(
        title=f"Time history at {case.speed:g} rpm",
        caption=f"Tangential acceleration at {case.sensor_radius:g} m.",
        panels=(beat_panel(case, steady_record(case.model, case.speed)),),
    )


def curve(case: Case) -> Exhibit:
    """Property curve, with the speeds to avoid."""
    measured = property_curve(case)
    speed, rms = measured.highest
    unstable = ", ".join(f"{n:g}" for n in measured.speed[measured.growth >= 0.0])
    return Exhibit(
        title="Property of torsional vibration-speed",
        caption=f"RMS of the tangential acceleration at {case.sensor_radius:g} m in the steady state.",
        panels=(curve_panel(case, measured, "Property curve"),),
        facts=(
            ("highest", f"{rms:.3g} g at {speed:g} rpm" if rms > 0.0 else "none: no stable speed"),
            ("peaks", ", ".join(f"{n:g}" for n in measured.peaks) + " rpm"),
            ("unstable speeds (left out of the curve)", f"{unstable} rpm" if unstable else "none"),
        ),
    )


def trace(case: Case) -> Exhibit:
    """Phase trace at the case's speed."""
    return Exhibit(
        title=f"Phase trace at {case.speed:g} rpm",
        caption="Displacement and velocity in the steady state.",
        panels=phase_panels(case, steady_record(case.model, case.speed)),
    )


def chart(case: Case) -> Exhibit:
    """Stability chart over the size of the defects."""
    coarse = replace(case, speeds=case.speeds._replace(step=(case.speeds.stop - case.speeds.start) / 80.0))
    return Exhibit(
        title="Stability chart",
        caption="Floquet growth rate with all indexes scaled; the black line is the limit of stability.",
        panels=(chart_panel(coarse),),
        facts=((f"growth rate at {case.speed:g} rpm", f"{growth_rate(case.model, case.speed):.3g} 1/s"),),
    )


FIGURES = (
    Entry("F4", "stiffness and characteristic numbers", geometry),
    Entry("F7", "static stiffness", static),
    Entry("F8", "bi-spectra", spectra),
    Entry("F10", "sweep", sweep),
    Entry("F13", "time history", history),
    Entry("F16", "property curve", curve),
    Entry("F17", "phase trace", trace),
    Entry("ST", "stability chart", chart),
)

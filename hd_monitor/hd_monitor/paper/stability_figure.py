"""The stability chart over speed and size of a defect, as Strutt's diagram shows it for one frequency."""

from dataclasses import replace

import numpy as np

from ..model import ParametricModel, StiffnessSeries, growth_rate, scale_defects, stability_chart
from .cases import Case, Cases
from .exhibit import Claim, Exhibit, Mark, Panel, Surface

_SEARCH_STEPS = 12


def principal_threshold(model: ParametricModel) -> float:
    """Smallest β of a single flexspline harmonic whose principal tongue is unstable, by bisection of the growth rate.

    Other harmonics of the model are left out; the search runs along the tongue's middle, ωo1 = 2ωn.
    """
    speed = 60.0 * 2.0 * model.dynamics.natural_frequency / model.reducer.flexspline_order
    near = np.linspace(0.995 * speed, 1.005 * speed, 11)
    low, high = 0.0, 1.0
    for _ in range(_SEARCH_STEPS):
        middle = (low + high) / 2.0
        trial = replace(model, flexspline=StiffnessSeries((middle,)), circular_spline=StiffnessSeries())
        if max(growth_rate(trial, float(n)) for n in near) > 0.0:
            high = middle
        else:
            low = middle
    return (low + high) / 2.0


def chart_panel(case: Case) -> Panel:
    """Draw growth rates over speed and the size of the defects, with the limit of stability."""
    speeds, scales = case.speeds.values, case.scales.values
    fn, order = case.model.dynamics.natural_frequency, case.model.reducer.flexspline_order
    rates = stability_chart(case.model, speeds, scales)
    single = len(case.model.flexspline.beta) == 1 and not case.model.circular_spline.beta
    sizes = scales * (case.model.flexspline.index if single else 1.0)
    return Panel(
        title="Stability over speed and size of the defect",
        x_label="wave-generator speed (rpm)",
        y_label="β of the flexspline" if single else "factor on all indexes β",
        surface=Surface(x=speeds, y=sizes, values=rates, label="growth rate (1/s)"),
        marks=tuple(
            Mark(at=60.0 * times * fn / order, label=label)
            for times, label in ((1.0, "ωo1 = fn"), (2.0, "ωo1 = 2 fn"))
            if speeds[0] <= 60.0 * times * fn / order <= speeds[-1]
        ),
    )


def stability(cases: Cases) -> Exhibit:
    """Stability chart with the thresholds that the paper's sweeps depend on."""
    case = cases["stability"]
    zetas = (case.model.dynamics.damping_ratio, cases["sweep_single_damped"].model.dynamics.damping_ratio)
    thresholds = [
        principal_threshold(replace(case.model, dynamics=replace(case.model.dynamics, damping_ratio=zeta)))
        for zeta in zetas
    ]
    table = cases["table_1"]
    rate = growth_rate(table.model, table.speed)
    limit = _stable_up_to(table.model, table.speed)
    return Exhibit(
        title="Stability chart (Strutt)",
        caption=f"Floquet growth rate with a single β11, fn = {case.model.dynamics.natural_frequency:g} Hz, ζ = "
        f"{case.model.dynamics.damping_ratio:g}; the black line is the limit of stability. Without damping the "
        "tongues would touch β = 0.",
        panels=(chart_panel(case),),
        claims=(
            Claim(
                statement="Threshold of the principal instability for one β, ζ = " + ", ".join(f"{z:g}" for z in zetas),
                paper="4ζ = "
                + ", ".join(f"{4 * z:.3f}" for z in zetas)
                + " (theory; the paper sweeps with 0.14, above it)",
                ours=", ".join(f"{t:.4f}" for t in thresholds),
                passed=all(abs(t / (4.0 * z) - 1.0) < 0.01 for t, z in zip(thresholds, zetas, strict=True)),
            ),
            Claim(
                statement="Table 1 has a steady state at 25 Hz",
                paper="steady-state vibration is simulated",
                ours=f"growth rate {rate:.2f} 1/s",
                passed=rate < 0.0,
            ),
        ),
        facts=(("Table 1's indexes may grow, at 750 rpm, before it becomes unstable, by", limit),),
    )


def _stable_up_to(model: ParametricModel, speed: float) -> str:
    for factor in np.arange(1.0, 8.01, 0.25):
        if growth_rate(scale_defects(model, float(factor)), speed) > 0.0:
            return f"a factor of {factor:g}"
    return "a factor of more than 8"

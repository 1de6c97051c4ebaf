"""Figure 17: the phase trace, and how one tells that it is quasi-periodic."""

from dataclasses import dataclass

import numpy as np

from .cases import Case, Cases
from .claim import Claim
from .exhibit import Curve, Exhibit, Panel
from .line_figures import REVOLUTIONS
from .records import SteadyRecord, steady_record


@dataclass(frozen=True, slots=True, kw_only=True)
class Quasiperiodicity:
    """How a steady vibration repeats.

    Attributes
    ----------
    stroboscopic_spread : float
        Standard deviation of the states (θ, θ'/ωn) caught once per circular-spline period, over that of all states:
        0 for a motion of that one period.
    closing_error : float
        Largest distance of the state after the lines' common period over the size of the motion: 0 if it comes back.
    lattice_power : float
        Part of the acceleration's power in lines p·ωo1 + q·ωo2.
    """

    stroboscopic_spread: float
    closing_error: float
    lattice_power: float


def quasiperiodicity(case: Case, record: SteadyRecord) -> Quasiperiodicity:
    """Measure a record over at least two output revolutions."""
    response, omega = record.response, case.model.dynamics.angular_frequency
    states = np.stack([response.displacement, response.velocity / omega])
    size = float(np.sqrt(states.var(axis=1).sum()))
    cs = case.model.reducer.output_orders.circular_spline
    strobe = np.arange(0.0, cs) / (cs * record.output_frequency)
    caught = np.stack([np.interp(strobe, response.times, row) for row in states])
    common = round(case.model.reducer.output_orders.flexspline - cs)  # times per output revolution
    period = response.times.size // (record.revolutions * common)
    back = states[:, period : 2 * period] - states[:, :period]
    power = np.abs(np.fft.rfft(response.acceleration)) ** 2
    return Quasiperiodicity(
        stroboscopic_spread=float(np.sqrt(caught.var(axis=1).sum())) / size,
        closing_error=float(np.abs(back).max()) / size,
        lattice_power=float(power[:: common * record.revolutions].sum() / power.sum()),
    )


def phase_panel(record: SteadyRecord) -> Panel:
    """Draw the phase trace as figure 17 does, over half an output revolution: the common period of both lines."""
    response = record.response
    one = slice(0, response.times.size // record.revolutions // 2)
    return Panel(
        title="Phase trace, half an output revolution",
        x_label="displacement θ (mrad)",
        y_label="velocity θ' (rad/s)",
        curves=(Curve(x=response.displacement[one] * 1e3, y=response.velocity[one], style="fine"),),
        equal=True,
    )


def strobe_panel(case: Case, record: SteadyRecord) -> Panel:
    """Draw the states caught once per circular-spline period: a closed curve if quasi-periodic, else one point."""
    response = record.response
    cs = case.model.reducer.output_orders.circular_spline
    strobe = np.arange(0.0, cs) / (cs * record.output_frequency)
    return Panel(
        title="Caught once per circular-spline period",
        x_label="displacement θ (mrad)",
        y_label="velocity θ' (rad/s)",
        curves=(
            Curve(
                x=np.interp(strobe, response.times, response.displacement) * 1e3,
                y=np.interp(strobe, response.times, response.velocity),
                style="points",
            ),
        ),
        equal=True,
    )


def figure_17(cases: Cases) -> Exhibit:
    """Phase trace at 850 rpm."""
    case = cases["rig"]
    record = steady_record(case.model, case.speed, REVOLUTIONS)
    measured = quasiperiodicity(case, record)
    return Exhibit(
        id="F17",
        title=f"Phase trace at {case.speed:g} rpm",
        caption="Simulated displacement and velocity in the steady state.",
        panels=(phase_panel(record), strobe_panel(case, record)),
        claims=(
            Claim(
                id="F17",
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

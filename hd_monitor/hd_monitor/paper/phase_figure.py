"""Figure 17: the phase trace, and the test for its being quasi-periodic."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from .cases import Case, Cases
from .exhibit import Claim, Curve, Exhibit, Panel, Style
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


def _strobe(case: Case, record: SteadyRecord, rows: Iterable[FloatArray]) -> FloatArray:
    """Catch the rows once per circular-spline period, over one output revolution."""
    cs = case.model.reducer.output_orders.circular_spline
    times = np.arange(0.0, cs) / (cs * record.output_frequency)
    return np.stack([np.interp(times, record.response.times, row) for row in rows])


def quasiperiodicity(case: Case, record: SteadyRecord) -> Quasiperiodicity:
    """Measure a record over at least two output revolutions."""
    response, omega = record.response, case.model.dynamics.angular_frequency
    states = np.stack([response.displacement, response.velocity / omega])
    size = float(np.sqrt(states.var(axis=1).sum()))
    caught = _strobe(case, record, states)
    cs, fs = case.model.reducer.output_orders
    common = round(fs - cs)  # times per output revolution
    period = response.times.size // (record.revolutions * common)
    back = states[:, period : 2 * period] - states[:, :period]
    power = np.abs(np.fft.rfft(response.acceleration)) ** 2
    return Quasiperiodicity(
        stroboscopic_spread=float(np.sqrt(caught.var(axis=1).sum())) / size,
        closing_error=float(np.abs(back).max()) / size,
        lattice_power=float(power[:: common * record.revolutions].sum() / power.sum()),
    )


def phase_panels(case: Case, record: SteadyRecord) -> tuple[Panel, ...]:
    """Draw the phase trace as figure 17 does, and the states caught once per circular-spline period.

    The trace covers half an output revolution, the common period of both lines. The states caught make a closed curve
    if the motion is quasi-periodic, else one point.
    """
    states = record.response.displacement, record.response.velocity
    half = record.response.times.size // record.revolutions // 2
    caught = _strobe(case, record, states)
    return (
        _phase_panel("Phase trace, half an output revolution", states[0][:half], states[1][:half], "fine"),
        _phase_panel("Caught once per circular-spline period", caught[0], caught[1], "points"),
    )


def _phase_panel(title: str, displacement: FloatArray, velocity: FloatArray, style: Style) -> Panel:
    curve = Curve(x=displacement * 1e3, y=velocity, style=style)
    return Panel(
        title=title, x_label="displacement θ (mrad)", y_label="velocity θ' (rad/s)", curves=(curve,), equal=True
    )


def figure_17(cases: Cases) -> Exhibit:
    """Phase trace at 850 rpm."""
    case = cases["rig"]
    record = steady_record(case.model, case.speed)
    measured = quasiperiodicity(case, record)
    return Exhibit(
        title=f"Phase trace at {case.speed:g} rpm",
        caption="Simulated displacement and velocity in the steady state.",
        panels=phase_panels(case, record),
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

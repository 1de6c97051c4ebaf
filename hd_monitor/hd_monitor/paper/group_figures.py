"""Figures 9 and 14: the combined harmonic groups that a load fluctuation raises around the bi-spectra."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..model import ParametricModel
from ..model.simulation import TimeResponse
from ..orders.zoom import Zoom
from . import printed
from .cases import Case, Cases
from .exhibit import Claim, Curve, Exhibit, Mark, Panel
from .line_figures import MICRO, spectrum_panel
from .records import REVOLUTIONS, amplitude, output_frequency, steady_record

PRESENT = 0.01
"""Part of a group's largest line from which another line of it counts as present."""

GROUP_1 = {"2ωo2 − ωo1": (2, -1), "ωo2": (1, 0), "ωo1": (0, 1), "2ωo1 − ωo2": (-1, 2)}
"""First group: names and the factors (of ωo2, of ωo1)."""

GROUP_2_PRINTED = {"4ωo2 − 2ωo1": (4, -2), "2ωo2": (2, 0), "2ωo1": (0, 2), "4ωo1 − 2ωo2": (-2, 4)}
GROUP_2 = {"3ωo2 − ωo1": (3, -1), "2ωo2": (2, 0), "ωo1 + ωo2": (1, 1), "2ωo1": (0, 2), "3ωo1 − ωo2": (-1, 3)}


class Line(NamedTuple):
    """A line of a group: its name, frequency [Hz], and amplitude of θ [rad] with and without the load's fluctuation."""

    name: str
    frequency: float
    amplitude: float
    unloaded: float


def without_fluctuation(model: ParametricModel) -> ParametricModel:
    """Return the model under its mean torque alone."""
    return replace(model, torque=replace(model.torque, load_fluctuation=0.0, drive_fluctuation=0.0))


def record_pair(case: Case) -> tuple[TimeResponse, TimeResponse]:
    """Simulate a case with and without the load's fluctuation."""
    return steady_record(case.model, case.speed), steady_record(without_fluctuation(case.model), case.speed)


def group_lines(
    model: ParametricModel, records: tuple[TimeResponse, TimeResponse], names: dict[str, tuple[int, int]]
) -> tuple[Line, ...]:
    """Read the named combination lines off the records with and without load fluctuation, by frequency."""
    orders = sorted((float(np.dot(factors, model.reducer.output_orders)), name) for name, factors in names.items())
    return tuple(
        Line(name, order * output_frequency(records[0]), *(amplitude(r.displacement, order) for r in records))
        for order, name in orders
    )


def group_panel(lines: tuple[Line, ...], records: tuple[TimeResponse, TimeResponse], title: str) -> Panel:
    """Draw a group with and without the load's fluctuation, on a logarithmic scale that shows the small lines."""
    spacing = min(b.frequency - a.frequency for a, b in pairwise(lines))
    low, high = lines[0].frequency - 1.6 * spacing, lines[-1].frequency + 1.6 * spacing
    zoom = Zoom(records[0].displacement.size, 1.0 / records[0].rate, low, high, 400)
    loaded, unloaded = (zoom(record.displacement * MICRO) for record in records)
    top = float(max(loaded.max(), unloaded.max()))
    return Panel(
        title=title,
        x_label="frequency (Hz)",
        y_label="amplitude (µrad)",
        curves=(
            Curve(x=zoom.frequencies, y=loaded, label="with load fluctuation"),
            Curve(x=zoom.frequencies, y=unloaded, label="without", style="dashed"),
        ),
        marks=tuple(Mark(at=line.frequency, label=line.name) for line in lines),
        log_y=True,
        x_range=(low, high),
        y_range=(1e-4 * top, 60.0 * top),
    )


def _table(lines: tuple[Line, ...]) -> str:
    return ", ".join(
        f"{x.name} ({x.frequency:.4f} Hz): {x.amplitude * MICRO:.3g} (without {x.unloaded * MICRO:.3g})" for x in lines
    )


def _heights(lines: tuple[Line, ...]) -> str:
    return "µrad: " + ", ".join(f"{x.name} {x.amplitude * MICRO:.3g}" for x in lines)


def _are_present(lines: Iterable[Line], group: tuple[Line, ...]) -> bool:
    return min(x.amplitude for x in lines) > PRESENT * max(x.amplitude for x in group)


def figure_9(cases: Cases) -> Exhibit:
    """The combined harmonic groups under Table 1's defects and a fluctuating load."""
    case = cases["combined_groups"]
    model = case.model
    records = record_pair(case)
    first = group_lines(model, records, GROUP_1)
    second = group_lines(model, records, GROUP_2)
    as_printed = group_lines(model, records, GROUP_2_PRINTED)
    outer = (as_printed[0].amplitude, as_printed[-1].amplitude)
    new = (second[0], second[2], second[-1])
    inner = [line.amplitude for line in new]
    pair = model.reducer.line_frequencies(case.speed)
    needed = pair.flexspline - pair.circular_spline
    as_rad = printed.LOAD_FREQUENCY.value / (2.0 * np.pi)
    rise = min(line.amplitude / line.unloaded for line in (second[0], second[-1]))
    return Exhibit(
        title="The combined harmonic group in the spectrum of forced parametric vibration",
        caption=f"Table 1 with a load fluctuation of {model.torque.load_fluctuation:g} N·m, {model.torque.load_order} "
        f"per output revolution, {case.speed:g} rpm; displacement, {REVOLUTIONS} output revolutions, Hann window.",
        panels=(
            spectrum_panel(
                records[0].displacement * MICRO, records[0].rate, unit="µrad", top=1.25 * 3 * pair.flexspline,
                bottom=0.2 * pair.circular_spline, title="Spectrum of θ, above the load's own line",
            ),
            group_panel(first, records, "First group"),
            group_panel(second, records, "Second group"),
        ),
        claims=(
            Claim(
                statement="The first group contains 2ωo2 − ωo1, ωo2, ωo1 and 2ωo1 − ωo2",
                paper="the four lines",
                ours=_heights(first),
                passed=_are_present(first, first),
                note="The outer two are there without a load fluctuation too, by the coupling of the two splines.",
            ),
            Claim(
                statement="With the load fluctuation a combined group appears around the second pair",
                paper="the phenomenon appears",
                ours=f"its outer lines rise {rise:.0f}-fold",
                passed=rise > 10.0 and _are_present(new, second),
            ),
            Claim(
                statement="Which lines the second group contains",
                paper=", ".join(GROUP_2_PRINTED) + " (2Δf apart)",
                ours=", ".join(GROUP_2) + f" (Δf apart); the printed outer ones are "
                    f"{max(inner) / max(outer):.0f} times smaller",
                passed=min(inner) > 10.0 * max(outer),
                contradiction=True,
                note="A load at ωo1 − ωo2 shifts lines by Δf; the lines that the model gives are reported.",
            ),
            Claim(
                statement="Frequency of the load fluctuation",
                paper=str(printed.LOAD_FREQUENCY),
                ours=f"{needed:.4f} Hz (0.3125 rad/s would be {as_rad:.4f} Hz and put the lines elsewhere)",
                passed=abs(needed - printed.LOAD_FREQUENCY.value) < 1e-9,
                contradiction=True,
                note="The group needs ωo1 − ωo2, twice per output revolution, so the unit must be Hz.",
            ),
        ),
        facts=(("first group, µrad", _table(first)), ("second group, µrad", _table(second))),
    )  # fmt: skip


def figure_14(cases: Cases) -> Exhibit:
    """The combined group on the rig with its asymmetric inertia, at the printed lower line."""
    case = cases["rig_loaded"]
    model = case.model
    records = record_pair(case)
    lines = group_lines(model, records, GROUP_1)
    ratio = model.reducer.circular_spline_teeth / model.reducer.flexspline_teeth
    values = sorted(printed.LOADED_LINES.values())
    printed_ratio = values[2] / values[1]
    nearest = min((abs((z + 2) / z - printed_ratio), z) for z in range(100, 400))[1]
    spacing = np.diff([line.frequency for line in lines])
    return Exhibit(
        title="Combined harmonic group in torsional vibration",
        caption=f"The rig at {case.speed:g} rpm with a load fluctuation of {model.torque.load_fluctuation:g} N·m, "
        f"{model.torque.load_order} per output revolution.",
        panels=(group_panel(lines, records, "Zoom spectrum of θ"),),
        claims=(
            Claim(
                statement="The group 2ωo2 − ωo1, ωo2, ωo1, 2ωo1 − ωo2 can be seen, evenly spaced",
                paper="four lines",
                ours=_heights(lines),
                passed=_are_present(lines, lines) and float(np.ptp(spacing)) < 1e-9,
            ),
            Claim(
                statement="ωo1 and ωo2, and their ratio",
                paper=f"ωo1 = {printed.LOADED_LINES['ωo1']}, ωo2 = {printed.LOADED_LINES['ωo2']} Hz, ratio "
                f"{printed_ratio:.4f}",
                ours=f"ωo2 = {lines[1].frequency:.2f}, ωo1 = {lines[2].frequency:.2f} Hz, ratio {ratio:.4f}",
                passed=abs(printed_ratio - ratio) > 0.002 and lines[1].frequency < lines[2].frequency,
                contradiction=True,
                note="The labels are reversed (ωo1 = ωo2·z2/z1 is the higher line), and the printed ratio would need "
                f"z1 ≈ {nearest} for z2 = z1 + 2. The group is shown, its numbers are not matched.",
            ),
        ),
        facts=tuple(
            (line.name, f"{line.frequency:.4f} Hz, printed {printed.LOADED_LINES[line.name]:.2f} Hz") for line in lines
        ),
    )

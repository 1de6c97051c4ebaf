"""Table 1: the indexes, recovered from the simulated vibration alone."""

import numpy as np

from . import printed
from .cases import Cases
from .diagnosis import SENSOR_NOISE, diagnose
from .exhibit import Claim, Curve, Exhibit, Panel

_LARGEST_ERROR = 0.001  # of the mean stiffness


def table_1(cases: Cases) -> Exhibit:
    """Let the monitor identify Table 1's indexes from acceleration and angle."""
    case = cases["table_1"]
    assessment = diagnose(case)
    found = assessment.identification
    claims, curves, identified = [], [], []
    for row, (name, values) in enumerate(printed.TABLE_1.items(), start=1):
        phasors = np.zeros(0) if found is None else getattr(found, name)
        measured = np.abs(phasors)[: len(values)]
        ok = measured.size == len(values) and float(np.abs(measured - values).max()) < _LARGEST_ERROR
        part = name.replace("_", " ")
        symbols = ", ".join(f"β{row}{k}" for k in range(1, len(values) + 1))
        claims.append(
            Claim(
                statement=f"{symbols} ({part}), identified from the vibration",
                paper=", ".join(f"{v:g}" for v in values),
                ours=", ".join(f"{v:.4f}" for v in measured) or "nothing identified",
                passed=ok,
                note=f"The monitor knows teeth, fn, ζ, J and M0 and nothing of the indexes; sensor noise "
                f"{SENSOR_NOISE:g} rad/s².",
            )
        )
        places = np.arange(1.0, len(values) + 1.0) + 0.06 * (2 * row - 3)
        curves.append(Curve(x=places, y=np.asarray(values), label=f"{part}, printed", style="stems"))
        if measured.size == len(values):
            identified.append((places, measured))
    x, y = np.concatenate(identified, axis=1) if identified else np.empty((2, 0))
    curves.append(Curve(x=x, y=y, label="identified", style="points"))
    return Exhibit(
        title="Index values of the stiffness fluctuation",
        caption=f"Simulated at {case.speed:g} rpm, identified by the monitor from acceleration and joint angle.",
        panels=(
            Panel(
                title="Table 1",
                x_label="harmonic",
                y_label="index β",
                curves=tuple(curves),
                x_step=1.0,
                x_range=(0.5, 3.5),
                y_range=(0.0, 0.075),
            ),
        ),
        claims=tuple(claims),
    )

"""Drives to choose by name, with the document each of their numbers comes from."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from hd_monitor.parameter import Value

PAPER = "paper"
"""The drive of Gu et al. 2021 and the default: every parameter keeps its own default."""

SOURCES = {
    "CSF": "Harmonic Drive LLC, catalogue *Cup Type Component Sets & Housed Units, CSF & CSG Series*",
    "CHA": "Harmonic Drive AG, *AC Servo Actuators CHA, Engineering Data*, 1018854 (12/2015), size 20A, ratio above 50",
    "Zhang": "Zhang, Zhang, Wang et al., *Accelerated Life Test and Performance Degradation Test of Harmonic Drive "
    "with Failure Analysis*, Machines 13 (2025) 918, doi 10.3390/machines13100918; its abstract and conclusions",
    "Gu": "Gu, Tong, Huang, Li 2021, the paper that this project follows",
}
"""The documents by the short name that :attr:`Sourced.source` uses."""


class Sourced(NamedTuple):
    """A parameter's value in a preset, and where it comes from."""

    value: Value
    source: str


_RATED = 34.0  # N·m
_STIFFNESS = (16e3, 25e3, 29e3)  # N·m/rad: K1, K2, K3
_INERTIA = 0.65  # kg·m²
_WORN_STIFFNESS = (10e3, 20e3, 25e3)


def _elasticity(stiffness: tuple[float, float, float], source: str) -> dict[str, Sourced]:
    """Express K1, K2 and K3 [N·m/rad] as the natural frequency of the load on K2."""
    _, middle, _ = stiffness
    frequency = math.sqrt(middle / _INERTIA) / (2.0 * math.pi)
    return {
        "dynamics.natural_frequency": Sourced(round(frequency, 2), f"K2 with this inertia; {source}"),
    }


_CATALOGUE: dict[str, Sourced] = {
    "defect": Sourced("none", "a sound unit"),
    "reducer.flexspline_teeth": Sourced(160, "ratio 80 with two lobes"),
    "reducer.circular_spline_teeth": Sourced(162, "ratio 80 with two lobes"),
    "dynamics.inertia": Sourced(_INERTIA, "assumed: an elbow that holds 4 kg at 0.35 m, and its link"),
    **_elasticity(_STIFFNESS, "16, 25, 29 kN·m/rad: CHA, table 50.3"),
    "torque.mean": Sourced(_RATED / 2.0, "half the rated torque; 34 N·m from memory, as 44 of a CSG less 30 % (CSF)"),
    "torque.ripple": Sourced(
        (0.34, 0.17, 0.10), "typical of a servo motor: 1, 0.5, 0.3 % of the rated torque at 2, 6, 12; no document found"
    ),
}

_WORN: dict[str, Sourced] = _CATALOGUE | {
    "defect": Sourced("flexspline", "stiffness fluctuation of the size of Gu, Table 1, on the part that wears most"),
    **_elasticity(_WORN_STIFFNESS, "assumed: K1 −38 %, K2 −20 %, K3 −14 %; that stiffness falls: Zhang"),
}

DRIVES: Mapping[str, Mapping[str, Sourced]] = {PAPER: {}, "catalogue": _CATALOGUE, "worn": _WORN}
"""Presets by the value of the parameter `drive`: parameters by name, in place of their defaults."""


def preset(drive: object) -> dict[str, Value]:
    """Values that a drive gives to parameters that are not given; none for a name that is not a drive's.

    Examples
    --------
    >>> preset("catalogue")["torque.mean"]
    17.0
    """
    return {name: entry.value for name, entry in DRIVES.get(str(drive), {}).items()}

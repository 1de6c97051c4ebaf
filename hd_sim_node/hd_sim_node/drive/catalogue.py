"""Drives to choose by name, with the document each of their numbers comes from."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from hd_monitor.parameter import Value

PAPER = "paper"
"""The drive of Gu et al. 2021 and the default: every parameter keeps its own default."""

SOURCES = {
    "CSF": "Harmonic Drive LLC, catalogue *Cup Type Component Sets & Housed Units, CSF & CSG Series*",
    "CHA": "Harmonic Drive AG, *AC Servo Actuators CHA, Engineering Data*, 1018854 (12/2015), p. 50, size 20A, ratio "
    "above 50",
    "TPI": "Schaeffler, catalogue TPI 275, series RT1-H-CS, size 20, ratio 100, at 20 °C and 2000 rpm; not itself, "
    "but as the open-source package harmonic-drive-twin tabulates it",
    "CSD": "Harmonic Drive AG, *Component Sets CSD-2A, Engineering Data*, 1019659 (11/2014); its curves were not "
    "read off",
    "Shi": "Shi, Yin, Li, Tang, *Modeling and Parameter Identification of Friction Characteristics of Harmonic "
    "Reducer*, J. Northeastern Univ. (Nat. Sci.) 43 (2022) 89–97, doi 10.12068/j.issn.1005-3026.2022.01.013, on an "
    "SHF-20-80-2UJ; its abstract",
    "Yao": "Yao, Chen, Xing, on the main frequencies of the transmission error of harmonic gears (in Chinese), "
    "Computer Integrated Manufacturing Systems, August 2022; its abstract",
    "Zhang": "Zhang, Zhang, Wang et al., *Accelerated Life Test and Performance Degradation Test of Harmonic Drive "
    "with Failure Analysis*, Machines 13 (2025) 918, doi 10.3390/machines13100918; its abstract and conclusions",
}
"""The documents by the short name that :attr:`Sourced.source` uses."""


class Sourced(NamedTuple):
    """A parameter's value in a preset, and where it comes from."""

    value: Value
    source: str


_RATIO = 80.0
_OUTPUT_SHARE = 1.0 / 3.0  # of the friction, assumed
_RATED = 34.0  # N·m
_STIFFNESS = (16e3, 25e3, 29e3)  # N·m/rad: K1, K2, K3
_INERTIA = 0.65  # kg·m²
_WORN_STIFFNESS = (10e3, 20e3, 25e3)
_RUN_SPEED = 2000.0 * 2.0 * math.pi / 60.0 / _RATIO  # rad/s at the output


def _elasticity(stiffness: tuple[float, float, float], source: str) -> dict[str, Sourced]:
    """Express K1, K2 and K3 [N·m/rad] as the natural frequency of the load on K2 and ratios to it."""
    low, middle, high = stiffness
    frequency = math.sqrt(middle / _INERTIA) / (2.0 * math.pi)
    return {
        "dynamics.natural_frequency": Sourced(round(frequency, 2), f"K2 with this inertia; {source}"),
        "elasticity.ratios": Sourced((low / middle, 1.0, high / middle), source),
    }


def _loop(arcmin: float, twist: float, stiffness: float, source: str) -> dict[str, Sourced]:
    """Express a hysteresis loss, the loop's full width [arcmin] at zero torque, by half its height at K1 [N·m/rad]."""
    half = stiffness * math.radians(arcmin / 60.0) / 2.0
    return {
        "hysteresis.torque": Sourced(round(half, 2), f"K1 times half a loop of {arcmin:g}′; {source}"),
        "hysteresis.twist": Sourced(twist, "typical: the loop closes before the rated torque; no document found"),
    }


_CATALOGUE: dict[str, Sourced] = {
    "defect": Sourced("none", "a sound unit"),
    "reducer.flexspline_teeth": Sourced(160, "ratio 80 with two lobes"),
    "reducer.circular_spline_teeth": Sourced(162, "ratio 80 with two lobes"),
    "dynamics.inertia": Sourced(_INERTIA, "assumed: an elbow that holds 4 kg at 0.35 m, and its link"),
    "dynamics.damping_ratio": Sourced(
        0.05, "typical of a joint with its links: twice the test rig's; no document found"
    ),
    **_elasticity(_STIFFNESS, "16, 25, 29 kN·m/rad: CHA, table 50.3"),
    "elasticity.torques": Sourced((7.0, 25.0), "T1, T2: CHA, table 50.3; the same in CSF, tables 41 and 42"),
    **_loop(1.0, 2.0, _STIFFNESS[0], "CHA, table 50.1: below 1′"),
    "torque.mean": Sourced(_RATED / 2.0, "half the rated torque, 34 N·m from memory; a CSG bears 30 % more (CSF)"),
    "flexspline.transmission_error": Sourced(
        (0.30, 0.08, 0.03), "share of the 1′ in all of CSF, table 40 (p. 49); the split is assumed"
    ),
    "flexspline.transmission_error_phase": Sourced((0.4, 2.2, 4.5), "arbitrary"),
    "circular_spline.transmission_error": Sourced(
        (0.25, 0.08, 0.03), "share of the 1′ in all of CSF, table 40 (p. 49); the split is assumed"
    ),
    "circular_spline.transmission_error_phase": Sourced((1.3, 3.6, 5.2), "arbitrary"),
    "wave_generator.transmission_error": Sourced(
        (0.15, 0.05, 0.03), "share of the same 1′; that these lines are among the main ones: Yao"
    ),
    "friction.coulomb": Sourced(
        0.8, "starting torque 37 mN·m (TPI) × 80, a third on the output, less the Stribeck part"
    ),
    "friction.stribeck": Sourced(0.2, "typical: a fifth of the starting torque; no document found"),
    "friction.stribeck_velocity": Sourced(0.05, "typical: 38 rpm of the wave generator; no document found"),
    "friction.viscous": Sourced(
        round((0.105 * _RATIO * _OUTPUT_SHARE - 0.8) / _RUN_SPEED, 2),
        "no-load running torque 105 mN·m (TPI) × 80, a third on the output, less Coulomb's; how it depends on speed: "
        "Shi",
    ),
    "torque.ripple": Sourced(
        (0.34, 0.17, 0.10), "typical of a servo motor: 1, 0.5, 0.3 % of the rated torque at 2, 6, 12; no document found"
    ),
    "drift.natural_frequency": Sourced(-0.005, "typical: steel's modulus falls by 0.03 % per kelvin, over 30 K"),
    "drift.damping_ratio": Sourced(-0.1, "assumed"),
    "drift.friction": Sourced(-0.4, "typical of grease; CSD, p. 26, plots the no-load torque over temperature"),
    "drift.time": Sourced(1200.0, "typical of a robot's joint; no document found"),
}

_WORN: dict[str, Sourced] = _CATALOGUE | {
    "defect": Sourced("flexspline", "the part that fails by fatigue: Zhang; the size is that of `defect`"),
    **_elasticity(_WORN_STIFFNESS, "assumed: K1 −38 %, K2 −20 %, K3 −14 %; that stiffness falls: Zhang"),
    **_loop(3.0, 4.0, _WORN_STIFFNESS[0], "assumed: three times the new unit's; that backlash grows: Zhang"),
    "flexspline.transmission_error": Sourced(
        (2.2, 0.6, 0.2), "assumed: 3′ in all; that accuracy degrades in every test: Zhang"
    ),
    "circular_spline.transmission_error": Sourced((0.6, 0.15, 0.05), "assumed: about twice the new unit's"),
    "wave_generator.transmission_error": Sourced((0.3, 0.1, 0.06), "assumed: twice the new unit's"),
    "friction.coulomb": Sourced(1.2, "assumed: half as much again; that efficiency falls slowly: Zhang"),
    "friction.stribeck": Sourced(0.3, "assumed: half as much again"),
    "friction.viscous": Sourced(_CATALOGUE["friction.viscous"].value, "as new"),
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

"""The sets of the study of reach: what each draws, what the monitor is told, and the truth."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from tests.studies.random_drives import (
    SPLINES,
    Draft,
    Tone,
    any_motion,
    dwells,
    gravity,
    ordinary,
    perhaps_gravity,
    readings,
    steady,
    strokes,
    sweep,
)

from hd_monitor.errors import ParameterError
from hd_monitor.reducer import ARCMIN, LinePair
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

SOUND = "none"
CATALOGUE_ERROR = 1.0
"""Transmission error [arcmin peak to peak] of a sound unit of the catalogue, which the monitor is told to expect."""


@dataclass(frozen=True, kw_only=True)
class Drive:
    """A random drive.

    Attributes
    ----------
    rig, told : dict
        Parameters of the simulated rig and of the monitor that watches it.
    bad : str
        The defective spline, or `SOUND`.
    index, error : LinePair
        True stiffness indexes, and true transmission errors [arcmin peak to peak].
    cause : str
        The cause that a right verdict states; any if empty.
    tones : tuple of Tone
    neighbour : dict or None
        Parameters of the rig of a neighbouring joint, whose vibration is heard too.
    leak : float
        Fraction of that vibration which is heard.
    """

    rig: dict[str, Any]
    told: dict[str, Any]
    bad: str
    index: LinePair
    error: LinePair
    cause: str = ""
    tones: tuple[Tone, ...] = ()
    neighbour: dict[str, Any] | None = None
    leak: float = 0.0


# What is special in each set -----------------------------------------------------------------------------------------


def paper(draft: Draft) -> None:
    """15 s or more of any motion."""
    any_motion(draft, steady, sweep, dwells, strokes)
    perhaps_gravity(draft)


def clips(draft: Draft) -> None:
    """2 to 7 s at one speed or in strokes; or half a beat of the lines to a whole one."""
    draft.rig["duration"] = draft.uniform(2.0, 7.0)
    any_motion(draft, steady, strokes, _part_of_a_beat)
    perhaps_gravity(draft)


def _part_of_a_beat(draft: Draft) -> None:
    draft.rig |= {"programme": "fixed", "fixed.speed": draft.uniform(300.0, 1200.0)}
    reduction = RigSettings.from_mapping(draft.rig).reducer.reduction
    beat = 30.0 * reduction / draft.rig["fixed.speed"]  # s: half an output revolution
    draft.rig["duration"] = draft.uniform(0.5, 1.0) * beat


def short_strokes(draft: Draft) -> None:
    """Strokes of 20° to 60° only: always the same, or random ones."""
    any_motion(draft, lambda own: strokes(own, 20.0, 60.0), _random_strokes)
    perhaps_gravity(draft)


def _random_strokes(draft: Draft) -> None:
    draft.rig |= {"programme": "short_strokes", "short_strokes.speed": draft.uniform(900.0, 2400.0)}


def varying(draft: Draft) -> None:
    """The torque varies by a factor of 2 or more and is measured."""
    any_motion(draft, steady, sweep, strokes)
    gravity(draft)


def moving(draft: Draft) -> None:
    """Constant torque, varying speed."""
    any_motion(draft, sweep, dwells, strokes)


def separable(draft: Draft) -> None:
    """Torque or speed varies, so that the data tell the cause."""
    any_motion(draft, varying, moving)


def nonlinear(draft: Draft) -> None:
    """Stiffness in steps, hysteresis, friction with reversals, drift, changing inertia: each in half of the drives."""
    separable(draft)
    rig, uniform = draft.rig, draft.uniform
    steps, loop, friction, drift, inertia = draft.chosen(5)
    if steps:
        rig["elasticity.ratios"] = [uniform(0.6, 0.85), 1.0, uniform(1.05, 1.25)]
        rig["elasticity.torques"] = [uniform(4.0, 8.0), uniform(18.0, 30.0)]
    if loop:
        stiffness = rig["dynamics.inertia"] * (math.tau * rig["dynamics.natural_frequency"]) ** 2
        rig["hysteresis.torque"] = stiffness * 0.5 * ARCMIN * uniform(0.2, 0.8)
        rig["hysteresis.twist"] = uniform(1.0, 3.0)
    if friction:
        strokes(draft)
        rig |= {"friction.coulomb": uniform(0.3, 1.0), "friction.stribeck": uniform(0.05, 0.3)}
        rig["friction.viscous"] = uniform(0.2, 1.0)
    if drift:
        rig["drift.natural_frequency"] = uniform(-0.1, 0.1)
        rig["drift.time"] = uniform(0.3, 1.0) * rig["duration"]
    if inertia:
        rig |= {"inertia.lowest": uniform(-0.3, -0.05), "inertia.highest": uniform(0.1, 0.5)}
        rig["inertia.period"] = uniform(2.0, 6.0)


def given(draft: Draft) -> None:
    """What is given is wrong, or something is late or missing: each in half of the drives."""
    separable(draft)
    rig, told, uniform = draft.rig, draft.told, draft.uniform
    frequency, damping, inertia, delay, drift, missing = draft.chosen(6)
    if frequency:
        told["dynamics.natural_frequency"] = rig["dynamics.natural_frequency"] * uniform(0.9, 1.1)
    if damping:
        told["dynamics.damping_ratio"] = rig["dynamics.damping_ratio"] * 2.0 ** uniform(-1.0, 1.0)
    if inertia:
        told["dynamics.inertia"] = rig["dynamics.inertia"] * 2.0 ** uniform(-1.0, 1.0)
    if delay:
        rig["joint_states.delay"] = uniform(0.0, 0.05)
    if drift:
        rig["sensor.clock_drift"] = uniform(-100.0, 100.0)
    if missing:
        lacking: list[dict[str, Any]] = [
            {"joint_states.velocity": "missing"},
            {"joint_states.effort": "none"},
            {"joint_states.effort_noise": 0.05 * draft.mean},
        ]
        rig |= lacking[int(draft.rng.integers(len(lacking)))]


def disturbed(draft: Draft) -> None:
    """Motor ripple, mains, a neighbouring joint, a sensor of 250 Hz: each in half of the drives."""
    any_motion(draft, steady, varying, moving)
    rig, uniform = draft.rig, draft.uniform
    ripple, mains, neighbour, slow = draft.chosen(4)
    if ripple:
        rig["torque.ripple"] = [draft.mean * uniform(0.005, 0.04) for _ in range(3)]
        rig["torque.ripple_phase"] = draft.phases()
    if mains:
        _mains(draft)
    if neighbour:
        draft.leak = uniform(0.05, 0.3)
        other = Draft(draft.rng, {"duration": rig["duration"]})
        ordinary(other)
        any_motion(other, steady, strokes)
        readings(other, str(draft.rng.choice(SPLINES)), 0.5)
        draft.neighbour = other.rig
    if slow:
        for own in (rig, draft.neighbour or {}):
            own |= {"sensor.rate": 250.0, "sensor.bandwidth": 100.0}
        draft.told["input.expected_rate"] = 250.0


def _mains(draft: Draft) -> None:
    mains = float(draft.rng.choice([50.0, 60.0])) * (1.0 + draft.uniform(-2e-3, 2e-3))
    for multiple in (1, 2, 3):
        draft.tones.append(Tone(multiple * mains, draft.uniform(0.1, 2.0), draft.uniform(0.0, math.tau)))


def catalogue(draft: Draft) -> None:
    """A sound unit of the catalogue with all effects at once."""
    any_motion(draft, steady, sweep, dwells, strokes, short_strokes)
    rig, uniform = draft.rig, draft.uniform
    for name in ("dynamics.inertia", "dynamics.natural_frequency", "dynamics.damping_ratio"):
        del rig[name]
    preset = RigSettings.from_mapping({"drive": "catalogue"}).values
    heavier = uniform(0.6, 1.6)
    rig |= {
        "drive": "catalogue",
        "torque.mean": uniform(5.0, 25.0),
        "dynamics.inertia": preset["dynamics.inertia"] * heavier,
        "dynamics.natural_frequency": preset["dynamics.natural_frequency"] / math.sqrt(heavier),
        "dynamics.damping_ratio": uniform(0.03, 0.06),
        "drift.time": uniform(20.0, 1200.0),
        "inertia.lowest": uniform(-0.3, -0.05),
        "inertia.highest": uniform(0.1, 0.5),
        "inertia.period": uniform(2.0, 6.0),
        "joint_states.delay": uniform(0.0, 0.02),
        "joint_states.effort": str(draft.rng.choice(["transmitted", "none"])),
        "joint_states.effort_noise": 0.03 * draft.mean,
        "sensor.clock_drift": uniform(-100.0, 100.0),
        "rigid_body": bool(draft.rng.random() < 0.5),
    }
    perhaps_gravity(draft)
    _mains(draft)


class ReachSet(NamedTuple):
    """A row of the table."""

    wanted: float
    """Share of right verdicts that is demanded."""
    shape: Callable[[Draft], None]
    """Draws the motion, the torque and what is special."""
    error: float = CATALOGUE_ERROR
    """Transmission error that the monitor expects, and that no sound spline exceeds [arcmin]."""
    part: str = "stiffness"
    """What of the bad spline is bad; ``nothing``: every unit is sound."""


SETS = {
    "paper's world": ReachSet(0.99, paper, error=0.0),
    "clips": ReachSet(0.95, clips, error=0.0),
    "short strokes": ReachSet(0.90, short_strokes),
    "torque varies": ReachSet(0.95, varying),
    "speed varies": ReachSet(0.95, moving),
    "steady": ReachSet(0.50, steady),
    "error": ReachSet(0.95, separable, part="transmission_error"),
    "nonlinear": ReachSet(0.70, nonlinear),
    "wrongly given": ReachSet(0.90, given),
    "disturbed": ReachSet(0.80, disturbed),
    "sound": ReachSet(0.0, catalogue, part="nothing"),
}


# Drawing -------------------------------------------------------------------------------------------------------------


def random_drive(name: str, seed: int, number: int) -> Drive:
    """Draw a drive of the set `name`; one whose vibration would grow without bound is drawn again."""
    rng = np.random.default_rng([list(SETS).index(name), seed, number])
    while True:
        drive = _random_drive(SETS[name], rng)
        try:
            Simulation(RigSettings.from_mapping(drive.rig))
        except ParameterError:
            continue
        return drive


def _random_drive(kind: ReachSet, rng: np.random.Generator) -> Drive:
    draft = Draft(rng, {"duration": float(rng.uniform(15.0, 25.0))})
    ordinary(draft)
    bad = SOUND if kind.part == "nothing" or rng.random() < 0.2 else str(rng.choice(SPLINES))
    kind.shape(draft)
    index, error = readings(draft, bad, kind.error, worn=kind.part == "transmission_error")
    shared = {name: value for name, value in draft.rig.items() if name.startswith(("dynamics.", "reducer."))}
    told = {"reducer.transmission_error": kind.error, "load.torque": draft.mean}
    return Drive(
        rig=draft.rig,
        told=shared | told | draft.told,
        bad=bad,
        index=index,
        error=error,
        cause="transmission_error" if kind.part == "transmission_error" and bad != SOUND else "",
        tones=tuple(draft.tones),
        neighbour=draft.neighbour,
        leak=draft.leak,
    )

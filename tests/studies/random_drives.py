"""What random drives are drawn from: teeth, dynamics, motions, torques and the readings of both splines."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from hd_monitor.reducer import LinePair

SPLINES = LinePair._fields
TEETH = ((160, 162), (160, 162), (200, 202), (100, 102))
SHAPE = (3.0, 1.5, 0.7)
"""Dirichlet parameters by which a reading's square is split over its harmonics."""


class Tone(NamedTuple):
    """A tone that reaches the accelerometer from elsewhere."""

    frequency: float
    """[Hz]"""
    amplitude: float
    """[rad/s²]"""
    phase: float
    """[rad]"""


@dataclass
class Draft:
    """A drive that is being drawn: the properties of :class:`Drive`, to be changed."""

    rng: np.random.Generator
    rig: dict[str, Any] = field(default_factory=dict)
    told: dict[str, Any] = field(default_factory=dict)
    tones: list[Tone] = field(default_factory=list)
    neighbour: dict[str, Any] | None = None
    leak: float = 0.0

    def uniform(self, low: float, high: float) -> float:
        """Draw a number."""
        return float(self.rng.uniform(low, high))

    def phases(self) -> list[float]:
        """Draw the phases [rad] of three harmonics."""
        return [float(phase) for phase in self.rng.uniform(0.0, math.tau, 3)]

    def chosen(self, count: int, probability: float = 0.5) -> list[bool]:
        """Draw which of so many effects there are, one at least."""
        chosen = self.rng.random(count) < probability
        chosen[self.rng.integers(count)] = True
        return [bool(one) for one in chosen]

    @property
    def mean(self) -> float:
        """Mean torque [N·m]."""
        return float(self.rig["torque.mean"])


def ordinary(draft: Draft) -> None:
    """Draw teeth, mount, natural vibration, torque and noise."""
    z1, z2 = TEETH[int(draft.rng.integers(len(TEETH)))]
    draft.rig |= {
        "reducer.flexspline_teeth": z1,
        "reducer.circular_spline_teeth": z2,
        "reducer.mount": str(draft.rng.choice(["circular_spline_fixed", "flexspline_fixed"])),
        "defect": "custom",
        "dynamics.natural_frequency": draft.uniform(40.0, 70.0),
        "dynamics.damping_ratio": draft.uniform(0.025, 0.045),
        "dynamics.inertia": 0.29,
        "torque.mean": draft.uniform(8.0, 20.0),
        "sensor.noise": 10.0 ** draft.uniform(-1.0, 0.0),
        "seed": int(draft.rng.integers(2**31)),
    }


def readings(draft: Draft, bad: str, largest: float, *, worn: bool = False) -> tuple[LinePair, LinePair]:
    """Draw both splines' stiffness and transmission error; `largest` is that of a sound one [arcmin]."""
    sizes = []
    for spline in SPLINES:
        faulty = spline == bad
        index = draft.uniform(0.07, 0.11) if faulty and not worn else draft.uniform(0.005, 0.025)
        error = draft.uniform(2.0, 4.0) if faulty and worn else draft.uniform(0.1, 1.0) * largest
        for name, phase, size in (
            ("beta", "phase", index),
            ("transmission_error", "transmission_error_phase", error),
        ):
            draft.rig[f"{spline}.{name}"] = (size * draft.rng.dirichlet(SHAPE) ** 0.5).tolist()
            draft.rig[f"{spline}.{phase}"] = draft.phases()
        sizes.append((index, error))
    indexes, errors = zip(*sizes, strict=True)
    return LinePair(*indexes), LinePair(*errors)


# Motions and torques -------------------------------------------------------------------------------------------------


def steady(draft: Draft) -> None:
    """Turn at one speed."""
    draft.rig |= {"programme": "fixed", "fixed.speed": draft.uniform(600.0, 2600.0)}


def sweep(draft: Draft) -> None:
    """Pass through all speeds once."""
    draft.rig |= {"programme": "sweep", "sweep.first": 300.0, "sweep.last": 2700.0}
    draft.rig["sweep.rate"] = 2400.0 / draft.rig["duration"]


def dwells(draft: Draft) -> None:
    """Hold five speeds, one after the other."""
    first = draft.uniform(400.0, 1200.0)
    draft.rig |= {"programme": "dwell", "dwell.first": first, "dwell.step": 300.0, "dwell.last": first + 1200.0}
    draft.rig["dwell.time"] = draft.rig["duration"] / 5.0 - 0.5


def strokes(draft: Draft, shortest: float = 120.0, longest: float = 180.0) -> None:
    """Move back and forth over an arc [deg]."""
    draft.rig |= {
        "programme": "strokes",
        "strokes.angle": draft.uniform(shortest, longest),
        "strokes.speed": draft.uniform(900.0, 2400.0),
    }


def any_motion(draft: Draft, *motions: Callable[[Draft], None]) -> None:
    """Draw one of the motions."""
    motions[int(draft.rng.integers(len(motions)))](draft)


def gravity(draft: Draft) -> None:
    """Let the torque vary by a factor of 2 or more within 120° of output travel from the start."""
    draft.rig["torque.gravity"] = draft.mean * draft.uniform(0.6, 1.2)


def perhaps_gravity(draft: Draft) -> None:
    """Let the torque vary in half of the drives."""
    if draft.rng.random() < 0.5:
        gravity(draft)

"""The virtual joint: position, velocity and effort as a robot's driver reports them, at their own rate."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.parameter import choice, number, plain

from ..drive.chunk import RigChunk
from ..drive.rig import Rig
from ..randomness import generator
from .accelerometer import nanoseconds


@dataclass(frozen=True, slots=True, kw_only=True)
class JointSettings:
    """What the joint reports: the parameters ``joint_states.*``."""

    name: str = plain("joint", "the joint's name in joint_states")
    rate: float = number(100.0, "Hz", 0.1, 10_000.0, "joint states per second")
    side: str = choice("motor", ("motor", "output"), "where the encoder sits; output: it sees the torsional vibration")
    reversed: bool = plain(False, "count against the wave generator's sense")
    resolution: float = number(0.0, "rad", 0.0, 10.0, "step of the position; 0: continuous")
    velocity: bool = plain(True, "report velocities")
    velocity_noise: float = number(0.0, "rad/s", 0.0, 1e6, "standard deviation of the velocity's noise")
    effort: str = choice(
        "transmitted",
        ("transmitted", "mean", "reaction", "none"),
        "transmitted: the output's torque without the drive's ripple; mean: torque.mean; reaction: what "
        "the reducer transmits, vibration included; none: no effort",
    )
    effort_noise: float = number(0.0, "N·m", 0.0, 1e6, "standard deviation of the effort's noise")
    jitter: float = number(0.0, "s", 0.0, 10.0, "standard deviation of the stamps")
    loss: float = number(0.0, "", 0.0, 1.0, "joint states lost, as a fraction")


class JointBatch(NamedTuple):
    """Joint states, one row a message; None where the joint does not report the quantity."""

    times: FloatArray
    """Instants [s] since the start, shape (messages,)."""
    stamps: IntArray
    """[ns] since the start."""
    position: FloatArray
    """[rad]"""
    velocity: FloatArray | None
    """[rad/s]"""
    effort: FloatArray | None
    """[N·m]"""

    def __len__(self) -> int:
        """Return the number of messages, not of fields."""
        return int(self.times.size)


class Joint:
    """Turns the rig's motion into joint states."""

    def __init__(self, rig: Rig, settings: JointSettings, *, seed: int = 0) -> None:
        self.settings = settings
        self._rig = rig
        self._velocity_noise = generator(seed, "velocity noise")
        self._effort_noise = generator(seed, "effort noise")
        self._jitter = generator(seed, "joint jitter")

    def report(self, chunk: RigChunk) -> JointBatch:
        """Joint states within a stretch of motion."""
        settings, rig = self.settings, self._rig
        first, last = (math.ceil(index * settings.rate / rig.rate) for index in (chunk.first, chunk.first + len(chunk)))
        times = np.arange(first, last) / settings.rate
        position, velocity = rig.angle(times), rig.speed(times)
        vibration = chunk.vibration_at(times) if settings.side == "output" or settings.effort == "reaction" else None
        if vibration is not None and settings.side == "output":
            position, velocity = position + vibration.displacement, velocity + vibration.velocity
        effort = None
        if settings.effort == "mean":
            effort = np.full(times.size, rig.model.torque.mean)
        elif settings.effort == "transmitted":
            effort = rig.torque(times, drive=False)
        elif settings.effort == "reaction" and vibration is not None:
            effort = rig.reaction(times, vibration)
        sign = -1.0 if settings.reversed else 1.0
        position = sign * position
        if settings.resolution:
            position = np.round(position / settings.resolution) * settings.resolution
        velocity = sign * velocity + settings.velocity_noise * self._velocity_noise.standard_normal(times.size)
        if effort is not None:
            effort = sign * effort + settings.effort_noise * self._effort_noise.standard_normal(times.size)
        error = settings.jitter * self._jitter.standard_normal(times.size)
        return JointBatch(times, nanoseconds(times + error), position, velocity if settings.velocity else None, effort)

"""The virtual joint: position, velocity and effort as a robot's driver reports them, at their own rate."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import signal

from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.parameter import choice, number, plain

from ..drive.chunk import RigChunk
from ..drive.rig import Rig
from ..randomness import generator
from .clock import nanoseconds
from .effort import EffortGauge, EffortSettings, instants_within


@dataclass(frozen=True, slots=True, kw_only=True)
class JointSettings:
    """What the joint reports besides its effort, and how."""

    name: str = plain("joint", "the joint's name in joint_states")
    rate: float = number(100.0, "Hz", 0.1, 10_000.0, "joint states per second")
    side: str = choice("motor", ("motor", "output"), "where the encoder sits; output: it sees the torsional vibration")
    reversed: bool = plain(False, "count against the wave generator's sense")
    resolution: float = number(0.0, "rad", 0.0, 10.0, "step of the position; 0: continuous")
    wrapped: bool = plain(False, "report the position between -π and π")
    velocity: str = choice(
        "reported",
        ("reported", "missing", "zero", "reversed", "filtered"),
        "missing: no velocity; zero: always 0; reversed: of the wrong sign; filtered: late by a first-order low-pass",
    )
    velocity_time_constant: float = number(0.02, "s", 1e-4, 100.0, "time constant of the filtered velocity")
    velocity_noise: float = number(0.0, "rad/s", 0.0, 1e6, "standard deviation of the velocity's noise")
    jitter: float = number(0.0, "s", 0.0, 10.0, "standard deviation of the stamps")
    delay: float = number(0.0, "s", -10.0, 10.0, "by how much the stamps are late: the values are older than they say")
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
    """Turns the rig's motion into joint states.

    Parameters
    ----------
    rig : Rig
    settings : JointSettings
        May be replaced while it runs (attribute `settings`), except the rate.
    effort : EffortSettings, optional
        May be replaced too (attribute `effort.settings`).
    seed : int
    """

    def __init__(
        self, rig: Rig, settings: JointSettings, effort: EffortSettings | None = None, *, seed: int = 0
    ) -> None:
        self.settings = settings
        self.effort = EffortGauge(rig, effort or EffortSettings(), seed=seed)
        self._rig = rig
        self._velocity_noise = generator(seed, "velocity noise")
        self._jitter = generator(seed, "joint jitter")
        self._lag: tuple[float, float] | None = None  # newest velocity [rad/s] before and behind the low-pass

    def report(self, chunk: RigChunk) -> JointBatch:
        """Joint states within a stretch of motion."""
        settings, rig = self.settings, self._rig
        times = instants_within(chunk, rig.rate, settings.rate)
        position, velocity = rig.angle(times), rig.speed(times)
        if settings.side == "output":
            vibration = chunk.vibration_at(times)
            position, velocity = position + vibration.displacement, velocity + vibration.velocity
        sign = -1.0 if settings.reversed else 1.0
        position = sign * position
        if settings.resolution:
            position = np.round(position / settings.resolution) * settings.resolution
        if settings.wrapped:
            position = np.remainder(position + math.pi, 2.0 * math.pi) - math.pi
        error = settings.delay + settings.jitter * self._jitter.standard_normal(times.size)
        return JointBatch(
            times,
            nanoseconds(times + error),
            position,
            self._reported(sign * velocity),
            self.effort.report(chunk, times, sign=sign),
        )

    def _reported(self, velocity: FloatArray) -> FloatArray | None:
        """Return the velocity as it is reported, or None."""
        settings = self.settings
        noise = settings.velocity_noise * self._velocity_noise.standard_normal(velocity.size)
        if settings.velocity != "filtered":
            self._lag = None
        match settings.velocity:
            case "missing":
                return None
            case "zero":
                return np.zeros(velocity.size)
            case "reversed":
                return noise - velocity
            case "filtered":
                return self._filtered(velocity) + noise
            case _:
                return velocity + noise

    def _filtered(self, velocity: FloatArray) -> FloatArray:
        """Low-pass the velocity: exact for one that changes linearly between messages (ramp-invariant)."""
        if not velocity.size:
            return velocity
        before, behind = self._lag or (velocity[0], velocity[0])
        step = 1.0 / (self.settings.rate * self.settings.velocity_time_constant)
        decay, mean = math.exp(-step), -math.expm1(-step) / step
        numerator, denominator = np.array([1.0 - mean, mean - decay]), np.array([1.0, -decay])
        state = np.array([numerator[1] * before + decay * behind])
        filtered = np.asarray(signal.lfilter(numerator, denominator, velocity, zi=state)[0])
        self._lag = (float(velocity[-1]), float(filtered[-1]))
        return filtered

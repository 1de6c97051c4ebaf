"""Speeds of the rig's programme at which the defects make vibration grow without bound."""

from collections.abc import Iterable
from typing import NamedTuple

from hd_monitor.model import ParametricModel, growth_rate

from .programme import SpeedProgramme

_DEEPEST_TONGUE = 4  # at 2 fn / m with m above it, damping outweighs any stiffness fluctuation that a gear can have


class UnstableSpeed(NamedTuple):
    """A wave-generator speed [rpm] and the rate [1/s] at which vibration grows there."""

    speed_rpm: float
    growth_rate: float


def unstable_speeds(model: ParametricModel, programme: SpeedProgramme) -> list[UnstableSpeed]:
    """Speeds of the programme at which the model is parametrically unstable (Floquet), in rising order."""
    found = []
    for speed in _worth_a_look(model, programme.visited_speeds().tolist()):
        rate = growth_rate(model, speed)
        if rate > 0.0:
            found.append(UnstableSpeed(speed, rate))
    return found


def describe(unstable: Iterable[UnstableSpeed]) -> str:
    """Say in a sentence where vibration grows and what to do about it."""
    worst = max(unstable, key=lambda u: u.growth_rate)
    speeds = sorted(u.speed_rpm for u in unstable)
    where = f"at {speeds[0]:g} rpm" if len(speeds) == 1 else f"at speeds from {speeds[0]:g} to {speeds[-1]:g} rpm"
    return (
        f"the defects are parametrically unstable {where}: at {worst.speed_rpm:g} rpm vibration grows by e every "
        f"{1.0 / worst.growth_rate:.2g} s, without bound; lower the β of the splines, raise dynamics.damping_ratio, or "
        "leave these speeds out (unstable: warn runs it all the same)"
    )


def _worth_a_look(model: ParametricModel, speeds: list[float]) -> list[float]:
    """Drop speeds whose highest stiffness harmonic stays below the tongues: their periods take long to compute."""
    harmonics = max(len(model.circular_spline.beta), len(model.flexspline.beta))
    if not harmonics:
        return []
    orders_per_second = harmonics * model.reducer.flexspline_order / 60.0
    lowest = 2.0 * model.dynamics.natural_frequency / _DEEPEST_TONGUE / orders_per_second
    return [speed for speed in speeds if speed >= 0.8 * lowest]

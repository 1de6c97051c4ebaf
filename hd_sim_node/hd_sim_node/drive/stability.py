"""Speeds of the rig's programme at which the defects make vibration grow without bound."""

from collections.abc import Iterable
from typing import NamedTuple

from hd_monitor.errors import ParameterError
from hd_monitor.model import ParametricModel, growth_rate

from ..motion.programme import SpeedProgramme

POLICIES = ("refuse", "warn", "ignore")
"""What to do if vibration grows without bound at a speed of the programme."""

_DEEPEST_TONGUE = 4  # at 2 fn / m with m above it, damping outweighs any stiffness fluctuation that a gear can have


class UnstableSpeed(NamedTuple):
    """A wave-generator speed [rpm] and the rate [1/s] at which vibration grows there."""

    speed_rpm: float
    growth_rate: float


def unstable_speeds(model: ParametricModel, programme: SpeedProgramme) -> list[UnstableSpeed]:
    """Speeds of the programme at which the model is parametrically unstable (Floquet), in rising order."""
    harmonics = max(len(model.circular_spline.beta), len(model.flexspline.beta))
    highest = harmonics * model.reducer.flexspline_order / 60.0  # Hz per rpm
    # Speeds whose highest stiffness harmonic stays below the tongues are left out: their periods take long to compute.
    lowest = 0.8 * 2.0 * model.dynamics.natural_frequency / _DEEPEST_TONGUE
    speeds = [speed for speed in programme.visited_speeds().tolist() if speed * highest >= lowest]
    found = [UnstableSpeed(speed, growth_rate(model, speed)) for speed in speeds]
    return [speed for speed in found if speed.growth_rate > 0.0]


def describe(unstable: Iterable[UnstableSpeed]) -> str:
    """Say in a sentence where vibration grows and what to do about it."""
    worst = max(unstable, key=lambda u: u.growth_rate)
    speeds = sorted(u.speed_rpm for u in unstable)
    where = f"at {speeds[0]:g} rpm" if len(speeds) == 1 else f"at speeds from {speeds[0]:g} to {speeds[-1]:g} rpm"
    return (
        f"the defects are parametrically unstable {where}: at {worst.speed_rpm:g} rpm vibration grows by e every "
        f"{1.0 / worst.growth_rate:.2g} s, without bound; lower the β of the splines, raise dynamics.damping_ratio, or "
        "leave these speeds out (unstable: warn runs it anyway)"
    )


def check_stability(model: ParametricModel, programme: SpeedProgramme, policy: str) -> str:
    """Search the programme for speeds at which vibration grows without bound, unless told to ignore them.

    Parameters
    ----------
    model : ParametricModel
    programme : SpeedProgramme
    policy : str
        One of :data:`POLICIES`.

    Returns
    -------
    str
        The warning; empty if there is none.

    Raises
    ------
    ParameterError
        If the policy is ``refuse`` and there is such a speed.
    """
    found = unstable_speeds(model, programme) if policy != "ignore" else []
    warning = describe(found) if found else ""
    if warning and policy == "refuse":
        raise ParameterError(warning)
    return warning

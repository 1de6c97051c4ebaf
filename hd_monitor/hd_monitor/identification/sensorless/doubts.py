"""What a technician should know of a result from joint states alone, and why there is none."""

import math

import numpy as np

from ...reducer import LinePair, Mount, Reducer

STILL = "The signal does not change at all while the joint turns: check what the driver publishes"

_ENOUGH_MESSAGES = 100
_NOTABLE, _NEARLY_ALL = 0.1, 0.9  # parts of the motion that are too fast


def doubts_about(index: LinePair, reducer: Reducer, *, one_speed: float, too_fast: float) -> tuple[str, ...]:
    """Doubts beside a name.

    Parameters
    ----------
    index : LinePair
    reducer : Reducer
    one_speed : float
        Output speed [rad/s] if there was only one; NaN otherwise.
    too_fast : float
        Part of the motion that was too fast for the rate of the joint states.
    """
    doubts = []
    # The line of the spline that stands still has exactly the order 2 of the wave generator.
    at_order_two = index.circular_spline if reducer.mount is Mount.CIRCULAR_SPLINE_FIXED else index.flexspline
    if at_order_two == max(index):
        doubts.append(
            "the larger line comes exactly twice per wave-generator revolution, as ripple of the motor and a bent "
            "shaft do: check the motor too"
        )
    if np.isfinite(one_speed):
        lower, upper = (order * one_speed / math.tau for order in reducer.output_orders)
        doubts.append(
            f"the joint turned at one speed: a fixed frequency of the machine at {lower:.1f} or {upper:.1f} Hz "
            "would look the same"
        )
    if too_fast > _NOTABLE:
        doubts.append(f"{too_fast:.0%} of the motion was too fast for the rate of the joint states and was left out")
    return tuple(doubts)


def complaints_about(source: str, *, messages: int, usable: int, too_fast: float) -> tuple[str, ...]:
    """What keeps the input from ever yielding a result; empty if nothing does so far.

    Parameters
    ----------
    source : str
        ``joint_effort`` or ``joint_velocity``.
    messages, usable : int
        Joint states seen, and those of them that carry the signal.
    too_fast : float
        Part of the motion that was too fast for the rate of the joint states.
    """
    field, other = ("effort", "joint_velocity") if source == "joint_effort" else ("velocity", "joint_effort")
    if messages >= _ENOUGH_MESSAGES and not usable:
        return (f"The joint states carry no {field}: set input.source to {other}, or have the driver publish it",)
    if too_fast > _NEARLY_ALL:
        return (
            "The joint turns too fast for the rate of its joint states, the lines lie above half of it: "
            "publish them faster, or let the joint turn slower once in a while",
        )
    return ()

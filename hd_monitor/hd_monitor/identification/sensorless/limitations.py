"""What limits a result from joint states alone, apart from the evidence itself."""

import math

from ...limitation import Limitation, LimitationCode, blocker, doubt
from ...reducer import LinePair, Mount, Reducer

_ENOUGH_MESSAGES = 100
_NOTABLE, _NEARLY_ALL = 0.1, 0.9  # parts of the motion that are too fast


def doubts_of_result(index: LinePair, reducer: Reducer, *, one_speed: float, too_fast: float) -> tuple[Limitation, ...]:
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
    # The line of the stationary spline has exactly the order 2 of the wave generator.
    at_order_two = index.circular_spline if reducer.mount is Mount.CIRCULAR_SPLINE_FIXED else index.flexspline
    if at_order_two == max(index):
        doubts.append(doubt(LimitationCode.MOTOR_SHARES_LINE))
    if math.isfinite(one_speed):
        lower, upper = (order * one_speed / math.tau for order in reducer.output_orders)
        doubts.append(doubt(LimitationCode.ONE_SPEED, lower_hz=lower, upper_hz=upper))
    if too_fast > _NOTABLE:
        doubts.append(doubt(LimitationCode.PARTLY_TOO_FAST, share=too_fast))
    return tuple(doubts)


def blockers_of_input(source: str, *, messages: int, usable: int, too_fast: float) -> tuple[Limitation, ...]:
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
    if messages >= _ENOUGH_MESSAGES and not usable:
        field, other = ("effort", "joint_velocity") if source == "joint_effort" else ("velocity", "joint_effort")
        return (blocker(LimitationCode.SIGNAL_MISSING, field=field, other=other),)
    if too_fast > _NEARLY_ALL:
        return (blocker(LimitationCode.ALL_TOO_FAST),)
    return ()

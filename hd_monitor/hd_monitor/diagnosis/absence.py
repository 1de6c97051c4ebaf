"""Verdicts where input is lost, unusable or not enough: no part is named."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

from ..acquisition.presence import Loss
from ..acquisition.recorder import AssembledPeriod
from ..contract import NANOSECONDS
from ..settings import JointSettings
from ..sources import Quantity
from .verdict import Component, FaultCode, Level, Verdict

Explain = Callable[[Quantity], str]
"""Explains why an input is silent, as far as the ROS graph shows it."""

_WORDS = {
    Quantity.VIBRATION: "vibration signal",
    Quantity.MOTION: "joint states",
    Quantity.TORQUE: "torque signal",
}


def _error(reason: str, code: FaultCode) -> Verdict:
    return Verdict(component=Component.UNDETERMINED, level=Level.ERROR, fault_code=code, reason=reason)


def _listed(quantities: Iterable[Quantity]) -> str:
    return " and no ".join(_WORDS[quantity] for quantity in quantities)


_UNITS = (("days", 86_400), ("hours", 3600), ("minutes", 60))


def remembered(verdict: Verdict, age: float, waiting: Verdict) -> Verdict:
    """Return the last verdict of an earlier run, of `age` [s], as long as this one is `waiting` for its own."""
    unit, size = next(((u, s) for u, s in _UNITS if age >= 2 * s), ("seconds", 1))
    reason = f"{verdict.reason} (last verdict, {age / size:.0f} {unit} ago; now: {waiting.sentence})"
    return replace(verdict, reason=reason)


def nothing_received(absent: Sequence[Quantity], timeout: float) -> Verdict:
    """Say that nothing came for `timeout` [s]; `absent` lists the inputs never received."""
    reason = f"No {_listed(absent)} received yet" if absent else f"No new data for {timeout:g} s"
    return _error(f"{reason}: check that the publishers run and the topics match", FaultCode.INPUT_LOST)


def lost(losses: Sequence[Loss], fault: str, timeout: float) -> Verdict:
    """Say that inputs have been silent, or unusable because of `fault`, for `timeout` [s] while others have not."""
    if silent := [loss.quantity for loss in losses if loss.silent]:
        return _error(
            f"No {_listed(silent)} for {timeout:g} s or more while other input continues: "
            "check the publisher, the topic's name and the stamps" + (f"; last complaint: {fault}" if fault else ""),
            FaultCode.INPUT_LOST,
        )
    words = _WORDS[losses[0].quantity]
    return _error(
        f"No usable {words} for {timeout:g} s or more, although messages arrive: {fault}; check the sensor",
        FaultCode.INPUT_INVALID,
    )


def lost_by_clock(losses: Sequence[Loss], stamps: Mapping[Quantity, int], fault: str, explain: Explain) -> Verdict:
    """Say what a node knows of lost inputs: why, by the ROS graph, or by their newest stamps [ns]."""
    reasons = []
    for loss in losses:
        words, stamp = _WORDS[loss.quantity], stamps.get(loss.quantity)
        if loss.silent:
            reasons.append(f"no {words} for {loss.since / NANOSECONDS:.0f} s: {explain(loss.quantity)}")
        else:
            still = "" if stamp is None else f"their stamps are stuck at {stamp / NANOSECONDS:.3f} s"
            reasons.append(f"messages with the {words} come but cannot be used: {fault or still}")
    silent = any(loss.silent for loss in losses)
    return _error(_sentence("; ".join(reasons)), FaultCode.INPUT_LOST if silent else FaultCode.INPUT_INVALID)


def stamped_by_two_clocks(stamps: Mapping[Quantity, int]) -> Verdict:
    """Say that inputs come whose newest stamps [ns] are far apart."""
    first, last = min(stamps, key=stamps.__getitem__), max(stamps, key=stamps.__getitem__)
    apart = (stamps[last] - stamps[first]) / NANOSECONDS
    return _error(
        _sentence(
            f"{_WORDS[first]} and {_WORDS[last]} both come, but their stamps are {apart:.1f} s apart: stamp both from "
            "one clock"
        ),
        FaultCode.INPUT_LOST,
    )


def internal_error(error: Exception) -> Verdict:
    """Say that the core failed."""
    return _error(
        f"Internal error, please report it: {type(error).__name__}: {error}; this joint's evidence was dropped and its "
        "monitoring restarts",
        FaultCode.INTERNAL_ERROR,
    )


WAITING = Verdict.waiting("nothing has been received so far")
NO_SIMULATED_TIME = Verdict.naming(
    Component.UNDETERMINED,
    Level.WARN,
    "use_sim_time is set, but no simulated time has arrived yet: does anything publish /clock?",
)


def not_enough(
    period: AssembledPeriod,
    settings: JointSettings,
    absent: Sequence[Quantity],
    *,
    speed: float,
    rate: float,
    fault: str,
) -> Verdict:
    """Say why there is no evidence yet, by the last period, its wave-generator speed [rpm] and sampling rate [Hz]."""
    turns = speed >= settings.analysis.minimum_speed
    if absent:
        reason = f"no {_listed(absent)} so far"
    elif not settings.sensorless and not period.records:
        known = "motion and torque" if Quantity.TORQUE in settings.sources else "motion"
        reason = f"no vibration with known {known} in the last period" + (f": {fault}" if fault else "")
    elif not settings.sensorless and Quantity.VIBRATION not in period.usable:
        reason = f"no usable vibration sample in the last period: {fault}"
    elif not turns:
        reason = "the joint has not turned enough: the lines appear only in motion"
    elif not settings.sensorless and settings.reducer.line_frequencies(speed).circular_spline > 0.5 * rate:
        return Verdict.naming(
            Component.UNDETERMINED,
            Level.WARN,
            f"At {speed:.0f} rpm all lines lie above half the sampling rate of {rate:.0f} Hz: check that positions "
            "are in rad on the output side, or sample faster",
        )
    else:
        reason = "too little motion: keep the joint turning"
    return Verdict.waiting(reason)


def with_assumed_torque(verdict: Verdict, torque: float) -> Verdict:
    """Add that a torque [N·m] was assumed, as none is measured."""
    note = f"no effort was measured: the torque is taken to be {torque:g} N·m"
    return replace(verdict, reason=f"{verdict.reason}; {note}")


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]

"""Verdicts where there is nothing to judge yet: no part is named."""

from collections.abc import Sequence
from dataclasses import replace

from ..acquisition.recorder import AssembledPeriod
from ..settings import JointSettings
from ..sources import Quantity
from .inputs import listed
from .verdict import Component, FaultCode, Level, Verdict

WAITING = Verdict.waiting("nothing has been judged so far")
WITHOUT_INPUT = Verdict.waiting("an input is lost or unusable; the input's status says which")


def internal_error(error: Exception) -> Verdict:
    """Say that the core failed."""
    return Verdict(
        component=Component.UNDETERMINED,
        level=Level.ERROR,
        fault_code=FaultCode.INTERNAL_ERROR,
        reason=f"Internal error, please report it: {type(error).__name__}: {error}; this joint's evidence was dropped "
        "and its monitoring restarts",
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
        reason = f"no {listed(absent)} so far"
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

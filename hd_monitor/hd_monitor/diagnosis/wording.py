"""Sentences of a verdict, in the words of a maintenance technician."""

import math

from ..identification.result import VAGUE, Identification
from ..settings import DiagnosisSettings
from .limitations import describe_limitation
from .probability import Probabilities
from .uncertain import with_std
from .verdict import Cause, Component, Level

_ALIKE = -0.8
"""Correlation of a spline's index and transmission error from which the motion does not separate the two."""

PART_NAMES = {
    Component.FLEXSPLINE: "flexspline",
    Component.CIRCULAR_SPLINE: "circular spline",
    Component.BOTH: "flexspline and circular spline",
}


def _percent(value: float) -> str:
    return f"{100.0 * value:.1f} %"


def _percent_with_std(value: float, std: float) -> str:
    return f"{with_std(100.0 * value, 100.0 * std)} %"


def _indexes(evidence: Identification) -> str:
    index, std = evidence.index, evidence.index_std
    return (
        f"flexspline index {_percent_with_std(index.flexspline, std.flexspline)}, "
        f"circular spline index {_percent_with_std(index.circular_spline, std.circular_spline)}"
    )


def _errors(evidence: Identification) -> str:
    error, std = evidence.transmission_error, evidence.transmission_error_std
    if error is None or std is None:
        return ""
    return (
        f"transmission error of the flexspline {_arcmin(error.flexspline, std.flexspline)}, "
        f"of the circular spline {_arcmin(error.circular_spline, std.circular_spline)}"
    )


def _arcmin(value: float, std: float) -> str:
    return f"{with_std(value, std)}'"


def _readings(cause: Cause, level: Level, evidence: Identification, limits: DiagnosisSettings) -> str:
    """List the readings with their limit at a level, those that accuse a part first."""
    of_level = {Level.ERROR: (limits.error_index, limits.error_transmission_error)}
    index_limit, error_limit = of_level.get(level, (limits.warn_index, limits.warn_transmission_error))
    word = f"{level.name.lower()} limit" if level > Level.OK else "limit"
    readings = [f"{_indexes(evidence)}, {word} {_percent(index_limit)}"]
    if errors := _errors(evidence):
        readings.append(f"{errors}, {word} {error_limit:g}'")
    return "; ".join(readings[::-1] if cause is Cause.TRANSMISSION_ERROR else readings)


def _with_doubts(sentence: str, evidence: Identification) -> str:
    return "; ".join([sentence, *map(describe_limitation, evidence.doubts)])


def describe_component(
    component: Component,
    level: Level,
    cause: Cause,
    evidence: Identification,
    limits: DiagnosisSettings,
    motor_side: Component,
) -> str:
    """Say which part is at fault and by how much its reading exceeds the limit.

    `motor_side` is the spline whose line is exactly twice per wave-generator revolution, as the motor's own ripple is.
    """
    if component is Component.NONE:
        return _with_doubts(f"Both splines are sound: {_readings(cause, level, evidence, limits)}", evidence)
    word, verb = "defective" if level is Level.ERROR else "suspect", "are" if component is Component.BOTH else "is"
    sentence = f"The {PART_NAMES[component]} {verb} {word}: {_readings(cause, level, evidence, limits)}"
    if cause is Cause.EITHER:
        sentence += "; whether its stiffness or its transmission error is at fault would show at another torque"
    if component in (motor_side, Component.BOTH):
        part = PART_NAMES[motor_side]
        sentence += f"; wave generator, motor shaft and motor ripple share the {part}'s line: check them too"
    return _with_doubts(sentence, evidence)


def describe_relative(component: Component, evidence: Identification) -> str:
    """Say which line dominates where its size in per cent of the stiffness cannot be known."""
    index = evidence.index
    larger, smaller = max(index), min(index)
    ratio = f"{larger / smaller:.1f} times the other" if smaller > 0.0 else "the other does not show"
    if component is Component.BOTH:
        sentence = "Flexspline and circular spline contribute about equally"
    else:
        sentence = f"The {PART_NAMES[component]} dominates ({ratio})"
    return _with_doubts(
        f"{sentence}; relative only, as torque or transfer function are unknown: compare with a baseline",
        evidence,
    )


def describe_unknown_scale(evidence: Identification) -> str:
    """Say that no limit applies, as the torque is not known well enough, and that nothing points to a defect."""
    return _with_doubts(
        f"The torque is not known well enough to compare the indexes with a limit ({_indexes(evidence)}): have the "
        "driver publish efforts, or give load.torque and load.assumed_uncertainty",
        evidence,
    )


def describe_unexplained(evidence: Identification) -> str:
    """Say that the model does not explain the vibration well enough for a verdict, and what to check."""
    return _with_doubts(
        f"The vibration is not explained well enough ({_indexes(evidence)}): check teeth, mount, natural frequency and "
        "torque, and the sensor's gain and bandwidth, and look for another source of vibration near the lines (mains "
        "hum, a neighbouring machine)",
        evidence,
    )


def describe_doubtful_limit(evidence: Identification, limits: DiagnosisSettings, limit: float) -> str:
    """Say that a reading may lie on either side of its limit, and what would help."""
    spline = max((0, 1), key=lambda s: evidence.index[s] + evidence.index_std[s])
    index, std = evidence.index[spline], evidence.index_std[spline]
    if evidence.correlation is not None and float(evidence.correlation[spline, spline + 2]) < _ALIKE:
        return _with_doubts(
            f"A fluctuating stiffness and a transmission error look alike in this motion ({_indexes(evidence)}; "
            f"{_errors(evidence)}): a change of torque or of speed would separate them",
            evidence,
        )
    if std > VAGUE * limits.warn_index:
        return _with_doubts(
            f"The indexes are not known well enough ({_indexes(evidence)}): more motion, more speed or more load "
            "would show more",
            evidence,
        )
    factor = (std / max(abs(index - limit), 0.1 * limit)) ** 2
    return _with_doubts(
        f"The larger index, {_percent_with_std(index, std)}, is close to the limit of {_percent(limit)}; "
        f"about {max(2, math.ceil(4.0 * factor))} times as much motion would decide",
        evidence,
    )


def describe_doubtful_name(evidence: Identification, odds: Probabilities) -> str:
    """Say that a defect shows but not whose it is."""
    shares = f"circular spline {odds.circular_spline:.0%}, flexspline {odds.flexspline:.0%}, both {odds.both:.0%}"
    return _with_doubts(
        f"A stiffness defect shows ({_indexes(evidence)}) but not in which spline (probabilities: {shares}); "
        "more output travel, or another speed, would decide",
        evidence,
    )

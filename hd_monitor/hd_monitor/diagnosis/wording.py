"""Sentences of a verdict, in the words of a maintenance technician."""

import math

from ..identification.result import Identification
from ..settings import DiagnosisSettings
from .limitations import describe_limitation
from .probability import Probabilities
from .verdict import Component, Level

PART_NAMES = {
    Component.FLEXSPLINE: "flexspline",
    Component.CIRCULAR_SPLINE: "circular spline",
    Component.BOTH: "flexspline and circular spline",
}


def _percent(value: float) -> str:
    return f"{100.0 * value:.1f} %"


def _with_std(value: float, std: float) -> str:
    return f"{_percent(value)} ± {_percent(max(std, 1e-3))}"


def _indexes(evidence: Identification) -> str:
    index, std = evidence.index, evidence.index_std
    return (
        f"flexspline index {_with_std(index.flexspline, std.flexspline)}, "
        f"circular spline index {_with_std(index.circular_spline, std.circular_spline)}"
    )


def _with_doubts(sentence: str, evidence: Identification) -> str:
    return "; ".join([sentence, *map(describe_limitation, evidence.doubts)])


def describe_component(
    component: Component,
    level: Level,
    evidence: Identification,
    limits: DiagnosisSettings,
    motor_side: Component,
) -> str:
    """Say which part is at fault and by how much its index exceeds the limit.

    `motor_side` is the spline whose line is exactly twice per wave-generator revolution, as the motor's own ripple is.
    """
    if component is Component.NONE:
        return _with_doubts(
            f"Both splines are sound: {_indexes(evidence)}, limit {_percent(limits.warn_index)}", evidence
        )
    limit, word = (limits.error_index, "defective") if level is Level.ERROR else (limits.warn_index, "suspect")
    verb = "are" if component is Component.BOTH else "is"
    sentence = (
        f"The {PART_NAMES[component]} {verb} {word}: {_indexes(evidence)}, {level.name.lower()} limit {_percent(limit)}"
    )
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


def describe_doubtful_limit(evidence: Identification, limit: float) -> str:
    """Say that the index may lie on either side of the limit, and what would help."""
    index, std = max(zip(evidence.index, evidence.index_std, strict=True))
    factor = (std / max(abs(index - limit), 0.1 * limit)) ** 2
    return _with_doubts(
        f"The larger index, {_with_std(index, std)}, is close to the limit of {_percent(limit)}; "
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

"""A replay's result in a few lines of text, for the terminal."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from ..diagnosis.something_else import describe_something_else
from ..diagnosis.uncertain import with_std
from ..diagnosis.verdict import Level
from .result import JointResult

_FAULTS = {
    "gaps": "gaps", "duplicates": "duplicates", "out_of_order": "out of order", "not_finite": "not finite",
    "clipped": "clipped", "stuck": "stuck", "spikes": "spikes", "clock_jumps": "clock jumps",
    "motion_faults": "bad joint states", "torque_faults": "bad torque samples", "rejected": "rejected",
    "dropped": "dropped",
}  # fmt: skip
"""Names of the counters of a `Quality`."""


def faults_in_words(counters: Mapping[str, Any]) -> str:
    """List what is wrong with the data, by the counters of a `Quality`.

    Examples
    --------
    >>> faults_in_words({"gaps": 2, "spikes": 0, "motion_faults": 1}), faults_in_words({})
    ('gaps 2, bad joint states 1', 'no faults in the data')
    """
    named = (f"{name} {counters[key]}" for key, name in _FAULTS.items() if counters.get(key))
    return ", ".join(named) or "no faults in the data"


def percent_with_std(value: float, std: float) -> str:
    """Write a fraction and its standard deviation in per cent.

    Examples
    --------
    >>> percent_with_std(0.10312, 0.00123)
    '10.31 ± 0.12 %'
    """
    return f"{with_std(100.0 * value, 100.0 * std)} %"


def summarise(result: JointResult) -> str:
    """Write what was found out about a joint."""
    last = result.last
    if last is None:
        return result.unusable
    verdict, found = last.verdict, last.identification
    lines = [
        f"{result.plan.joint}: {Level(verdict.level).name}, {verdict.component.value} ({verdict.fault_code.value})",
        f"  {verdict.reason}",
    ]
    if last.input.level > Level.OK:
        lines.append(f"  input: {Level(last.input.level).name}, {last.input.code.value}: {last.input.reason}")
    if found is not None and math.isfinite(found.index_std.flexspline):
        kind = "relative index" if found.relative else "index"
        index, std, limits = found.index, found.index_std, last.settings.diagnosis
        lines += [
            f"  flexspline {kind} {percent_with_std(index.flexspline, std.flexspline)}, "
            f"circular spline {percent_with_std(index.circular_spline, std.circular_spline)}"
            + ("" if found.relative else f"; limits {100 * limits.warn_index:g} % and {100 * limits.error_index:g} %"),
            f"  from {math.degrees(found.travel):.0f}° of travel, signal to noise {found.signal_to_noise:.0f} dB",
        ]
        lines += [f"  something else: {describe_something_else(row)}" for row in found.something_else]
    quality = last.quality
    samples = "" if result.plan.settings.sensorless else f"{quality.samples} samples at {quality.rate:.1f} Hz, "
    lines.append(f"  {samples}{quality.motion_messages} joint states; {faults_in_words(asdict(quality))}")
    lines += [f"  note: {note}" for note in result.plan.notes]
    return "\n".join(lines)

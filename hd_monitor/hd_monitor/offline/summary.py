"""A replay's result in a few lines of text, for the terminal."""

import math

from ..diagnosis.verdict import Level
from .percent import percent_with_std
from .result import JointResult


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
    if found is not None:
        kind = "relative index" if found.relative else "index"
        index, std = found.index, found.index_std
        lines += [
            f"  flexspline {kind} {percent_with_std(index.flexspline, std.flexspline)}, "
            f"circular spline {percent_with_std(index.circular_spline, std.circular_spline)}"
            + ("" if found.relative else f"; limits {100 * last.warn_limit:g} % and {100 * last.error_limit:g} %"),
            f"  from {math.degrees(found.travel):.0f}° of travel, signal to noise {found.signal_to_noise:.0f} dB",
        ]
    quality = last.quality
    faults = {
        "gaps": quality.gaps,
        "duplicates": quality.duplicates,
        "out of order": quality.out_of_order,
        "not finite": quality.not_finite,
        "clipped": quality.clipped,
        "stuck": quality.stuck,
        "spikes": quality.spikes,
        "clock jumps": quality.clock_jumps,
        "bad joint states": quality.motion_faults,
        "rejected": quality.rejected,
    }
    wrong = ", ".join(f"{name} {count}" for name, count in faults.items() if count) or "no faults in the data"
    samples = "" if result.plan.settings.sensorless else f"{quality.samples} samples at {quality.rate:.1f} Hz, "
    lines.append(f"  {samples}{quality.motion_messages} joint states; {wrong}")
    lines += [f"  note: {note}" for note in result.plan.notes]
    return "\n".join(lines)

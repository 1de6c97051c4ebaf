"""An identification as a table for the terminal."""

import math
from collections.abc import Iterator

from ..diagnosis.limitations import describe_limitation
from ..identification.result import Identification
from . import identify_numbers as numbers
from .identify import JointIdentification
from .identify_numbers import Estimate
from .identify_result import SHOWN, quality_sums, teeth_contradict
from .summary import faults_in_words

_SPLINES = ("circular spline", "flexspline")


def table(joint: JointIdentification) -> str:
    """Write all that was identified of a joint."""
    found = joint.found
    assert found is not None
    parts = [_head(joint, found), _splines(joint, found)]
    parts.append(_directions(joint) if joint.settings.sensorless else _dynamics(joint, found))
    parts += [_lines(joint, found), _evidence(joint, found), _teeth(joint)]
    return "\n".join(line for part in parts for line in part)


def _head(joint: JointIdentification, found: Identification) -> Iterator[str]:
    yield f"{joint.plan.joint}: identified from {', '.join(joint.bags)}"
    if teeth_contradict(joint):
        given = joint.settings.reducer
        yield (
            f"  WRONG TEETH? {joint.teeth.statement if joint.teeth else ''}; "
            f"given are {given.flexspline_teeth}/{given.circular_spline_teeth}, so nothing below holds: "
            "correct reducer.* and identify again"
        )
    for blocker in found.blockers:
        yield f"  no part can be named: {describe_limitation(blocker)}"
    for doubt in found.doubts:
        yield f"  note: {describe_limitation(doubt)}"
    for note in joint.plan.notes:
        yield f"  note: {note}"


def _splines(joint: JointIdentification, found: Identification) -> Iterator[str]:
    indexes = [Estimate.gaussian(*index) for index in zip(found.index, found.index_std, strict=True)]
    if joint.settings.sensorless:
        yield "  relative index (share of the lines' size)      95 % interval"
        for name, index in zip(_SPLINES, indexes, strict=True):
            yield f"    {name:<16} {_value(index, 1.0)}"
        return
    kind = "relative β, no torque is known" if found.relative else "β of the mean stiffness"
    yield f"  {kind:<32} %  95 % interval               phase, rad"
    for name, harmonics, index in zip(_SPLINES, numbers.harmonics(found).values(), indexes, strict=True):
        for h in harmonics:
            phase = f"{h.phase:+.3f} ± {h.phase_std:.2g}" if math.isfinite(h.phase) else "in the noise"
            yield f"    {name:<16} k = {h.k}   {_value(h.beta, 100.0):<45} {phase}"
        yield f"    {name:<16} index   {_value(index, 100.0)}"
    yield f"    correlation of the two indexes' errors {found.index_correlation:+.2f}"


def _dynamics(joint: JointIdentification, found: Identification) -> Iterator[str]:
    given = joint.settings.dynamics
    fn, zeta = numbers.dynamics(found, joint.settings.uncertainty).values()
    for name, unit, (estimate, identified), start in (
        ("natural frequency fn", " Hz", fn, given.natural_frequency),
        ("damping ratio ζ", "", zeta, given.damping_ratio),
    ):
        if identified:
            yield f"  {name:<22} {_value(estimate, 1.0)}{unit}; given was {start:g}{unit}"
        else:
            yield f"  {name:<22} {start:g}{unit} as given: the motion does not tell it better"
    load = Estimate.gaussian(found.load_fluctuation, found.load_fluctuation_std)
    yield f"  {'load fluctuation':<22} {_value(load, 1.0)} N·m"
    speed = found.critical_speed
    unstable = f"{speed:.0f} rpm of the wave generator" if math.isfinite(speed) else "no speed"
    yield f"  {'unstable from':<22} {unstable}"


def _directions(joint: JointIdentification) -> Iterator[str]:
    orders = joint.settings.reducer.output_orders
    for d in joint.directions:
        rival = f"; a larger line at {d.rival:.0f}" if d.rival is not None else ""
        yield f"  {d.name}: {d.segments} strokes, {d.samples} samples{rival}"
        rows = zip(_SPLINES, orders, d.amplitude, d.std, d.chance, d.dominance, strict=True)
        for name, order, size, std, chance, dominance in rows:
            yield (
                f"    {name:<16} {order:>5g}/rev  {size:.4g} ± {std:.2g}, by chance {chance:.1g}, the larger one with "
                f"probability {dominance:.3f}"
            )


def _lines(joint: JointIdentification, found: Identification) -> Iterator[str]:
    unit = {"joint_effort": "effort's unit", "joint_velocity": "rad/s"}.get(joint.settings.input.source, "rad/s²")
    if found.lines:
        yield f"  line amplitudes, {unit}   circular spline        flexspline"
    for line in found.lines:
        cells = [f"{size:.4g} ± {std:.2g}" for size, std in zip(line.amplitude, line.std, strict=True)]
        yield f"    k = {line.k}                    {cells[0]:<22} {cells[1]}"


def _evidence(joint: JointIdentification, found: Identification) -> Iterator[str]:
    yield (
        f"  from {math.degrees(found.travel):.0f}° of travel, {found.samples} samples; signal to noise "
        f"{found.signal_to_noise:.0f} dB, misfit {found.misfit:.2f}"
    )
    yield f"  {faults_in_words(quality_sums(joint.qualities))}"


def _teeth(joint: JointIdentification) -> Iterator[str]:
    ranking = joint.teeth
    if ranking is None:
        return
    given = joint.settings.reducer
    yield f"  tooth check ({given.flexspline_teeth}/{given.circular_spline_teeth} given): {ranking.statement}"
    best = ranking.ranked[0].log_evidence
    for pair in ranking.ranked[:SHOWN]:
        if math.isfinite(pair.log_evidence):
            behind = (best - pair.log_evidence) / math.log(10.0)
            yield (
                f"    {pair.teeth.flexspline}/{pair.teeth.circular_spline}  {pair.lines_found} of its first 2 lines "
                f"found, odds 10^{behind:.1f} to 1 behind the first"
            )


def _value(estimate: Estimate, scale: float) -> str:
    """Value ± std [interval], to the digits that the deviation leaves a meaning."""
    value, std = scale * estimate.value, scale * estimate.std
    if not (math.isfinite(std) and std > 0.0):
        return f"{value:.4g}"
    digits = min(max(1 - math.floor(math.log10(std)), 0), 8)
    low, high = scale * estimate.low, scale * estimate.high
    return f"{value:.{digits}f} ± {std:.{digits}f}  [{low:.{digits}f}, {high:.{digits}f}]"

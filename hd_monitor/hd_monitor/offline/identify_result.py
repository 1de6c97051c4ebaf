"""An identification as plain data (what ``--json`` writes) and as a ROS parameter file (``--yaml``)."""

import math
from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import yaml

from .. import __version__
from ..acquisition.quality import Quality
from ..diagnosis.limitations import describe_limitation
from ..diagnosis.tooth_ranking import ConcludedRanking
from ..identification.teeth.candidates import ToothPair
from . import identify_numbers as numbers
from .identify import JointIdentification
from .identify_numbers import Estimate, Harmonic
from .parameters import NODE
from .result import line_entries, plain

SHOWN = 5
"""Candidate tooth pairs listed."""


def as_dict(joints: Sequence[JointIdentification], bags: Sequence[str], notes: Sequence[str]) -> dict[str, Any]:
    """Write the whole JSON: indexes as fractions, intervals at `numbers.CONFIDENCE`."""
    return {
        "joints": [joint_entry(joint) for joint in joints],
        "bags": list(bags),
        "notes": list(notes),
        "confidence": numbers.CONFIDENCE,
        "generator": f"hd_monitor {__version__}",
    }


def joint_entry(joint: JointIdentification) -> dict[str, Any]:
    """Write one joint's part of the JSON."""
    found, settings = joint.found, joint.settings
    assert found is not None
    entry: dict[str, Any] = {
        "joint": joint.plan.joint,
        "bags": joint.bags,
        "source": settings.input.source,
        "relative": bool(found.relative),
        "torque_source": joint.last.torque_source if joint.last and not settings.sensorless else "unknown",
        **{
            name: _spline(getattr(found.index, name), getattr(found.index_std, name), betas)
            for name, betas in numbers.harmonics(found).items()
        },
        "index_correlation": found.index_correlation,
        **dict.fromkeys(("natural_frequency", "damping_ratio", "load_fluctuation")),
        "instability_speed_rpm": found.critical_speed,
        "never_unstable": math.isinf(found.critical_speed),
        "lines": line_entries(found),
        "directions": [
            {
                "direction": d.name,
                **{name: getattr(d, name)._asdict() for name in ("amplitude", "std", "chance", "dominance")},
                "rival_order": d.rival,
                "strokes": d.segments,
                "samples": d.samples,
            }
            for d in joint.directions
        ],
        "travel_deg": math.degrees(found.travel),
        "samples": found.samples,
        "signal_to_noise_db": found.signal_to_noise,
        "misfit": found.misfit,
        "fit_status": found.fit_status,
        "doubts": [describe_limitation(doubt) for doubt in found.doubts],
        "blockers": [describe_limitation(blocker) for blocker in found.blockers],
        "teeth": _teeth(joint.teeth),
        "quality": quality_sums(joint.qualities),
        "parameters": dict(settings.values),
        "notes": list(joint.plan.notes),
    }
    if not settings.sensorless:
        for name, (estimate, identified) in numbers.dynamics(found, settings.uncertainty).items():
            given = getattr(settings.dynamics, name)
            entry[name] = estimate._asdict() | {"given": given, "identified": identified}
        entry["load_fluctuation"] = Estimate.gaussian(found.load_fluctuation, found.load_fluctuation_std)._asdict()
    return dict(plain(entry))


def quality_sums(qualities: Sequence[Quality]) -> dict[str, int]:
    """Add up the counters of several recordings."""
    names = [f.name for f in fields(Quality)]
    counters = [n for n in names if all(type(getattr(quality, n)) is int for quality in qualities)]
    return {name: sum(getattr(quality, name) for quality in qualities) for name in counters}


def parameter_file(joints: Sequence[JointIdentification]) -> tuple[str, list[str]]:
    """Write what was found as a parameter file for the monitor; empty if there is nothing to write.

    Returns
    -------
    tuple of (str, list of str)
        The file's text, and for each joint that is not in it the reason.
    """
    below: dict[str, dict[str, Any]] = {}
    reasons = []
    for joint in joints:
        if values := refined(joint):
            below[joint.plan.joint] = values
        else:
            reasons.append(f"joint {joint.plan.joint!r}: {_why_not(joint)}")
    if not below:
        return "", reasons
    parameters: dict[str, Any] = below if len(joints) > 1 else next(iter(below.values()))
    text = yaml.safe_dump({NODE: {"ros__parameters": parameters}}, sort_keys=False)
    bags = dict.fromkeys(" ".join(bag.split()) for joint in joints for bag in joint.bags)
    origin = f"# Identified by hd-monitor identify from {', '.join(bags)}; merge into the node's parameters.\n"
    return origin + text, reasons


def refined(joint: JointIdentification) -> dict[str, Any]:
    """Parameters of a joint that the recordings tell better than what was given."""
    found, settings, values = joint.found, joint.settings, dict[str, Any]()
    assert found is not None
    if joint.teeth is not None and joint.teeth.conclusive:
        values["reducer"] = _teeth_entry(joint.teeth.ranked[0].teeth)
    if settings.sensorless or found.blockers or teeth_contradict(joint):
        return values
    estimates = numbers.dynamics(found, settings.uncertainty).items()
    known = {name: float(f"{estimate.value:.6g}") for name, (estimate, identified) in estimates if identified}
    return values | ({"dynamics": known} if known else {})


def teeth_contradict(joint: JointIdentification) -> bool:
    """Whether the recordings show other teeth than the parameters give: what was identified with these is void."""
    if joint.teeth is None or not joint.teeth.conclusive:
        return False
    reducer, best = joint.settings.reducer, joint.teeth.ranked[0].teeth
    return (best.flexspline, best.circular_spline) != (reducer.flexspline_teeth, reducer.circular_spline_teeth)


def _why_not(joint: JointIdentification) -> str:
    found = joint.found
    if found is not None and found.blockers:
        return describe_limitation(found.blockers[0])
    if joint.settings.sensorless:
        return "joint states alone tell neither natural frequency nor damping, and the tooth check is not conclusive"
    return "the recordings tell neither natural frequency nor damping: vary the speed, best in a sweep over fn"


def _spline(index: float, std: float, betas: Sequence[Harmonic]) -> dict[str, Any]:
    return {
        "index": Estimate.gaussian(index, std)._asdict(),
        "harmonics": [
            {"k": h.k, "beta": h.beta._asdict(), "phase_rad": h.phase, "phase_std_rad": h.phase_std} for h in betas
        ],
    }


def _teeth_entry(teeth: ToothPair) -> dict[str, int]:
    return {"flexspline_teeth": int(teeth.flexspline), "circular_spline_teeth": int(teeth.circular_spline)}


def _teeth(ranking: ConcludedRanking | None) -> dict[str, Any] | None:
    if ranking is None:
        return None
    return {
        "statement": ranking.statement,
        "conclusive": ranking.conclusive,
        "margin": ranking.margin,
        "travel_deg": math.degrees(ranking.travel),
        "ranked": [
            {
                **_teeth_entry(pair.teeth),
                "log_evidence": pair.log_evidence,
                "chance": pair.chance,
                "lines_found": pair.lines_found,
            }
            for pair in ranking.ranked[:SHOWN]
        ],
    }

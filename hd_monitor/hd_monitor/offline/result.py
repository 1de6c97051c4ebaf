"""The result of a replay as plain data: what ``--json`` writes and what reports and comparisons read."""

import math
from dataclasses import asdict, dataclass, field
from typing import Any

from .. import __version__
from ..assessment import Assessment
from ..contract import NANOSECONDS
from ..diagnosis.status import status_of
from ..diagnosis.verdict import Level
from ..identification.result import Identification
from ..sources import Quantity
from .plan import JointPlan
from .replay import Replayed


def plain(value: Any) -> Any:
    """Make a value fit for JSON: numbers that are not finite become null."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value


def verdict_entry(assessment: Assessment) -> dict[str, Any]:
    """Write the verdict and the numbers it rests on: indexes as fractions, transmission errors in arcmin."""
    verdict, found, quality = assessment.verdict, assessment.identification, assessment.quality
    return {
        "component": verdict.component.value,
        "level": int(verdict.level),
        "level_name": Level(verdict.level).name,
        "fault_code": verdict.fault_code.value,
        "cause": verdict.cause.value,
        "reason": verdict.reason,
        **{
            f"{spline}_{name}": getattr(getattr(found, name, None), spline, None)
            for spline in ("flexspline", "circular_spline")
            for name in ("index", "index_std", "transmission_error", "transmission_error_std")
        },
        "travel_deg": math.degrees(found.travel) if found else 0.0,
        "samples": quality.samples,
        "gaps": quality.gaps,
    }


def input_entry(assessment: Assessment) -> dict[str, Any]:
    """Write whether the inputs arrived."""
    state = assessment.input
    return {
        "level": int(state.level),
        "level_name": Level(state.level).name,
        "fault_code": state.code.value,
        "reason": state.reason,
    }


def line_entries(found: Identification | None) -> list[dict[str, Any]]:
    """Write the amplitudes of the characteristic lines and their standard deviations, in the signal's unit."""
    return [
        {
            "k": line.k,
            **line.amplitude._asdict(),
            **{f"{spline}_std": std for spline, std in line.std._asdict().items()},
        }
        for line in (found.lines if found else ())
    ]


@dataclass(slots=True)
class JointResult:
    """What was said of one joint, collected as it comes."""

    plan: JointPlan
    timeline: list[dict[str, Any]] = field(default_factory=list)
    """One entry an assessment."""
    last: Assessment | None = None
    """What a node would show at the recording's end."""

    def add(self, said: Replayed) -> None:
        """Take the next assessment."""
        if said.last:
            self.last = said.assessment
        if not said.last or not self.timeline:
            entry = {"stamp": said.assessment.stamp, "time": said.assessment.stamp / NANOSECONDS}
            entry |= verdict_entry(said.assessment) | {"input": said.assessment.input.code.value}
            entry |= {"speed_rpm": said.assessment.speed, "rms": said.assessment.rms}
            self.timeline.append(plain(entry))

    def followed_by(self, later: "JointResult") -> "JointResult":
        """Return the history that goes on with a later recording; one of which nothing can be said adds nothing."""
        if later.unusable:
            return self
        timeline = later.timeline if self.unusable else [*self.timeline, *later.timeline]
        return JointResult(later.plan, timeline, later.last)

    @property
    def unusable(self) -> str:
        """Why nothing can be said of the joint; empty if something can."""
        if self.last is None:
            return f"joint {self.plan.joint!r}: too few messages were recorded for a single verdict"
        quality = self.last.quality
        for quantity, taken, what in (
            (Quantity.MOTION, quality.motion_messages, "joint states"),
            (Quantity.VIBRATION, quality.samples, "vibration samples"),
            (Quantity.TORQUE, quality.torque_messages, "torque samples"),
        ):
            if quantity in self.plan.topics and not taken:
                return f"joint {self.plan.joint!r}: no usable {what}: {quality.last_fault or self._why(quantity)}"
        return ""

    def _why(self, quantity: Quantity) -> str:
        """Say why nothing of a topic could be used."""
        topic, messages = self.plan.topics[quantity], self.plan.messages[quantity]
        if len(self.plan.topics) == 1:
            return f"the recording's {messages} message(s) on {topic} are too few"
        return (
            f"those recorded on {topic} ({messages}) and those of the other inputs hardly overlap in time, by their "
            "stamps; record them together for some seconds"
        )

    def as_dict(self) -> dict[str, Any]:
        """Write the joint's part of the JSON."""
        last, plan = self.last, self.plan
        if last is None:
            return {"joint": plan.joint, "verdict": None, "lines": [], "rms_curve": [], "timeline": self.timeline}
        limits = last.settings.diagnosis
        entry = {
            "joint": plan.joint,
            "verdict": verdict_entry(last),
            "input": input_entry(last),
            "lines": line_entries(last.identification),
            "torque_shares": [
                asdict(row) | {"reading": row.reading} for row in getattr(last.identification, "torque_shares", ())
            ],
            "something_else": [asdict(row) for row in getattr(last.identification, "something_else", ())],
            "rms_curve": [{"rpm": rpm, "rms": rms, "samples": samples} for rpm, rms, samples in last.rms_curve],
            "timeline": self.timeline,
            "relative": bool(last.identification.relative) if last.identification else None,
            "warn_limit": limits.warn_index,
            "error_limit": limits.error_index,
            "quality": asdict(last.quality),
            "status": dict(status_of(last, plan.joint).values),
            "topics": {quantity.value: plan.topics.get(quantity) for quantity in Quantity},
            "parameters": dict(plan.settings.values),
            "notes": list(plan.notes),
        }
        return dict(plain(entry))


def as_dict(bags: list[str], notes: list[str], joints: list[JointResult]) -> dict[str, Any]:
    """Write the whole JSON."""
    return {
        "joints": [joint.as_dict() for joint in joints],
        "bag": ", ".join(bags),
        "notes": notes,
        "generator": f"hd_monitor {__version__}",
    }

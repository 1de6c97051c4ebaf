"""Replay a recording from start to end and collect what was said: what the commands do with a bag."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .bag import Bag
from .errors import BagError
from .plan import JointPlan, Request, plan
from .progress import ProgressLine
from .replay import replay
from .result import JointResult, as_dict

if TYPE_CHECKING:
    from .report.collector import Collector


def _collectors(plans: Sequence[JointPlan]) -> dict[str, "Collector"]:
    from .report.collector import Collector  # a plain replay needs none of it

    return {item.joint: Collector(item.settings) for item in plans}


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What a replay gave.

    Attributes
    ----------
    content : dict
        As ``--json`` writes it.
    joints : list of JointResult
    notes : list of str
        What is wrong with the recording or one of its joints.
    collectors : mapping of str to Collector
        By joint; empty unless a report was requested.
    """

    content: dict[str, Any]
    joints: list[JointResult]
    notes: list[str]
    collectors: Mapping[str, "Collector"]


def replay_bag(path: Path, request: Request, *, for_report: bool = False) -> Outcome:
    """Replay a recording, with progress on standard error.

    Raises
    ------
    BagError
        If nothing can be said of any joint.
    ParameterError
        If the parameters are wrong.
    """
    with Bag(path) as bag:
        plans = plan(bag, request)
        results = {item.joint: JointResult(item) for item in plans}
        collectors = _collectors(plans) if for_report else {}
        progress = ProgressLine(bag)
        for said in replay(bag, plans, progress):
            results[said.plan.joint].add(said)
            if collectors and not said.last:
                collectors[said.plan.joint].add(said.assessment)
        progress.close()
        notes = list(bag.notes)
    joints = list(results.values())
    complaints = [joint.unusable for joint in joints if joint.unusable]
    if len(complaints) == len(joints):
        raise BagError("; ".join([*complaints, *notes]))
    return Outcome(
        content=as_dict(str(path), notes, joints), joints=joints, notes=notes + complaints, collectors=collectors
    )

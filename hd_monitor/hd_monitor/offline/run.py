"""Replay a recording from start to end and collect what was said: what the commands do with a bag."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..assessment import Assessment
from .bag import Bag
from .errors import BagError
from .plan import JointPlan, Request, plan
from .progress import ProgressLine
from .replay import SomeIdentifier, replay
from .result import JointResult, as_dict

if TYPE_CHECKING:
    from .report.collector import Collector


class Outcome(NamedTuple):
    """What a replay gave."""

    content: dict[str, Any]
    """As ``--json`` writes it."""
    joints: list[JointResult]
    notes: list[str]
    """What is wrong with the recording or one of its joints."""
    collectors: Mapping[str, "Collector"]
    """By joint; empty unless a report was requested."""


def run(
    bag: Bag,
    plans: Sequence[JointPlan],
    listeners: Mapping[str, Callable[[Assessment], None]],
    identifiers: Mapping[str, SomeIdentifier] | None = None,
) -> list[JointResult]:
    """Replay an open recording, with progress on standard error; `listeners` and `identifiers` are by joint."""
    results = {item.joint: JointResult(item) for item in plans}
    progress = ProgressLine(bag)
    for said in replay(bag, plans, progress, identifiers):
        joint = said.plan.joint
        results[joint].add(said)
        if joint in listeners and not said.last:
            listeners[joint](said.assessment)
    progress.close()
    return list(results.values())


def _collectors(plans: Sequence[JointPlan]) -> dict[str, "Collector"]:
    from .report.collector import Collector  # a plain replay needs none of it

    return {item.joint: Collector(item.settings) for item in plans}


def replay_bag(path: Path, request: Request, *, for_report: bool = False) -> Outcome:
    """Replay a recording.

    Raises
    ------
    BagError
        If nothing can be said of any joint.
    ParameterError
        If the parameters are wrong.
    """
    with Bag(path, request.chunk_limit) as bag:
        plans = plan(bag, request)
        collectors = _collectors(plans) if for_report else {}
        joints = run(bag, plans, {joint: collector.add for joint, collector in collectors.items()})
        notes = list(bag.notes)
    complaints = [joint.unusable for joint in joints if joint.unusable]
    if len(complaints) == len(joints):
        raise BagError("; ".join([*complaints, *notes]))
    return Outcome(as_dict(str(path), notes, joints), joints, notes + complaints, collectors)

"""Replay a recording from start to end and collect what was said: what the commands do with a bag."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..assessment import Assessment
from ..evidence import SomeIdentifier, end_recording, new_identifier
from ..history.diary import Diary
from ..history.ledger import Ledger
from ..history.rating import Baseline, baseline_of
from .bag import Bag
from .errors import BagError
from .plan import JointPlan, Request, check_same_settings, plan
from .progress import ProgressLine
from .replay import replay
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
    baselines: Mapping[str, Baseline | None] | None = None,
) -> list[JointResult]:
    """Replay an open recording, with progress on standard error; the mappings are by joint."""
    results = {item.joint: JointResult(item) for item in plans}
    progress = ProgressLine(bag)
    for said in replay(bag, plans, progress, identifiers, baselines):
        joint = said.plan.joint
        results[joint].add(said)
        if joint in listeners and not said.last:
            listeners[joint](said.assessment)
    progress.close()
    return list(results.values())


def _listener(
    joint: str, collectors: Mapping[str, "Collector"], diaries: Mapping[str, Diary], ledger: Ledger | None
) -> Callable[[Assessment], None]:
    """Return what is told of every assessment of a joint."""

    def listen(assessment: Assessment) -> None:
        if joint in collectors:
            collectors[joint].add(assessment)
        if ledger is not None and (entry := diaries[joint].note(assessment)):
            ledger.append(entry)

    return listen


def _baselines(plans: Sequence[JointPlan], ledger: Ledger | None) -> dict[str, Baseline | None]:
    """Return each joint's lines as they should be, as far as the ledger knows them."""
    if ledger is None:
        return {}
    return {item.joint: baseline_of(ledger.entries(item.settings.serial, item.joint)) for item in plans}


def _collectors(plans: Sequence[JointPlan]) -> dict[str, "Collector"]:
    from .report.collector import Collector  # a plain replay needs none of it

    return {item.joint: Collector(item.settings) for item in plans}


def replay_bag(path: Path, request: Request, *, for_report: bool = False) -> Outcome:
    """Replay a recording, as `replay_bags` does."""
    return replay_bags([path], request, for_report=for_report)


def replay_bags(
    paths: Sequence[Path],
    request: Request,
    *,
    for_report: bool = False,
    ledger: Ledger | None = None,
) -> Outcome:
    """Replay recordings as one history of the arm: each goes on with the evidence of those before it.

    Parameters
    ----------
    paths : sequence of Path
        In the order of their time.
    request : Request
    for_report : bool
        Whether to collect what the report draws.
    ledger : Ledger, optional
        Where each recording gets its entries, and which knows the baselines that they are rated against.

    Raises
    ------
    BagError
        If nothing can be said of any joint.
    ParameterError
        If the parameters are wrong, or the recordings need different ones.
    """
    histories: dict[str, JointResult] = {}
    first: dict[str, JointPlan] = {}
    identifiers: dict[str, SomeIdentifier] = {}
    collectors: dict[str, Collector] = {}
    notes: list[str] = []
    complaints: list[str] = []
    for path in paths:
        before = f"{path}: " if len(paths) > 1 else ""
        try:
            with Bag(path, request.chunk_limit) as bag:
                plans = plan(bag, request)
                for item in plans:
                    check_same_settings(first.setdefault(item.joint, item), item, path)
                    identifiers.setdefault(item.joint, new_identifier(item.settings))
                if for_report:
                    collectors = _collectors(plans) | collectors
                diaries = {item.joint: Diary(item.joint, item.settings.history.interval, str(path)) for item in plans}
                listeners = {item.joint: _listener(item.joint, collectors, diaries, ledger) for item in plans}
                found = run(bag, plans, listeners, identifiers, _baselines(plans, ledger))
                notes += [before + note for note in bag.notes]
        except BagError as error:
            raise error if str(path) in str(error) or not before else BagError(before + str(error)) from None
        for result in found:
            if result.unusable:
                complaints.append(before + result.unusable)
            elif ledger and result.last and (entry := diaries[result.plan.joint].close(result.last)):
                ledger.append(entry)
            end_recording(identifiers[result.plan.joint])
            known = histories.get(result.plan.joint)
            histories[result.plan.joint] = result if known is None else known.followed_by(result)
    joints = list(histories.values())
    if all(joint.unusable for joint in joints):
        raise BagError("; ".join([*complaints, *notes]))
    return Outcome(as_dict([str(path) for path in paths], notes, joints), joints, notes + complaints, collectors)

"""Identification from recordings: all that is known of a joint, pooled over bags, by the monitor's own core."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..acquisition.quality import Quality
from ..assessment import Assessment
from ..diagnosis.limitations import describe_limitation
from ..diagnosis.tooth_ranking import ConcludedRanking
from ..evidence import SomeIdentifier, end_recording, new_identifier
from ..identification.result import Identification
from ..identification.sensorless.agreement import DirectionEvidence
from ..identification.sensorless.identifier import SensorlessIdentifier
from ..settings import JointSettings
from .bag import Bag
from .errors import BagError
from .identify_teeth import ToothCheck
from .plan import JointPlan, Request, check_same_settings, plan
from .run import run

WHOLE_RECORDING: Mapping[str, Any] = {"analysis.memory": 86_400.0}
"""What a parameter file says for watching does not suit identification: nothing fades."""


@dataclass(slots=True, kw_only=True)
class JointIdentification:
    """What the recordings tell of one joint."""

    plan: JointPlan
    """As in the first recording."""
    identifier: SomeIdentifier
    """Carries the evidence from one recording to the next."""
    tooth_check: ToothCheck
    bags: list[str] = field(default_factory=list)
    """Recordings with usable data."""
    found: Identification | None = None
    """None if there was not enough motion."""
    teeth: ConcludedRanking | None = None
    """None if there was no motion at all."""
    last: Assessment | None = None
    """The last one of the last usable recording."""
    qualities: list[Quality] = field(default_factory=list)
    """Of each usable recording."""
    complaints: list[str] = field(default_factory=list)
    """Why recordings were not usable."""

    @property
    def settings(self) -> JointSettings:
        """The joint's settings."""
        return self.plan.settings

    @property
    def directions(self) -> tuple[DirectionEvidence, ...]:
        """What each direction of motion tells; sensorless only."""
        return self.identifier.directions if isinstance(self.identifier, SensorlessIdentifier) else ()

    @property
    def unusable(self) -> str:
        """Why nothing can be said of the joint; empty if something can."""
        if not self.bags:
            return "; ".join(self.complaints)
        if self.found is None or not self.found.samples:
            blockers = self.found.blockers if self.found else ()
            reason = describe_limitation(blockers[0]) if blockers else self.last.verdict.reason if self.last else ""
            return f"joint {self.plan.joint!r}: nothing to identify in {', '.join(self.bags)}: {reason}"
        return ""


def identify(
    paths: Sequence[Path],
    request: Request,
    *,
    by_hand: Sequence[str] = (),
    note: Callable[[str], None] = lambda _: None,
) -> list[JointIdentification]:
    """Identify the joints in some recordings, all recordings of a joint together; progress goes to standard error.

    Parameters
    ----------
    paths : sequence of Path
    request : Request
    by_hand : sequence of str
        Parameters in force as they are, even where they are of `WHOLE_RECORDING`.
    note : callable
        Told in a sentence of what is wrong with a recording.

    Raises
    ------
    BagError
        If nothing can be said of any joint.
    ParameterError
        If the parameters are wrong, or the recordings need different ones.
    """
    request = replace(request, parameters=_for_identification(request.parameters, by_hand))
    joints: dict[str, JointIdentification] = {}
    for path in paths:
        try:
            with Bag(path, request.chunk_limit) as bag:
                plans = plan(bag, request)
                _pair_up(joints, plans, path)
                _go_through(bag, plans, joints)
        except BagError as error:
            raise error if str(path) in str(error) else BagError(f"{path}: {error}") from None
        for sentence in bag.notes:
            note(f"{path}: {sentence}" if len(paths) > 1 else sentence)
    for joint in joints.values():
        joint.found = joint.identifier.finish()
        joint.teeth = joint.tooth_check.ranking()
    complaints = [joint.unusable for joint in joints.values() if joint.unusable]
    if len(complaints) == len(joints):
        raise BagError("; ".join(complaints))
    for joint in joints.values():
        for complaint in dict.fromkeys([*joint.complaints, joint.unusable]):
            if complaint:
                note(complaint)
    return [joint for joint in joints.values() if not joint.unusable]


def _for_identification(parameters: Mapping[str, Any], by_hand: Sequence[str]) -> dict[str, Any]:
    """Put `WHOLE_RECORDING` in force, also below the joints' names."""
    ours = {name: value for name, value in WHOLE_RECORDING.items() if name not in by_hand}
    void = {name for name in parameters if name not in by_hand and any(f".{name}".endswith(f".{own}") for own in ours)}
    return {name: value for name, value in parameters.items() if name not in void} | ours


def _pair_up(joints: dict[str, JointIdentification], plans: Sequence[JointPlan], path: Path) -> None:
    """Find every joint's evidence from earlier recordings, or make room for it."""
    for item in plans:
        known = joints.get(item.joint)
        if known is None:
            own = item.settings
            identifier = new_identifier(own, sparing=False)
            joints[item.joint] = JointIdentification(plan=item, identifier=identifier, tooth_check=ToothCheck(own))
        else:
            check_same_settings(known.plan, item, path)


def _go_through(bag: Bag, plans: Sequence[JointPlan], joints: Mapping[str, JointIdentification]) -> None:
    """Feed one recording to the identifiers."""
    checks = {name: joint.tooth_check.add for name, joint in joints.items()}
    for result in run(bag, plans, checks, {name: joint.identifier for name, joint in joints.items()}):
        joint = joints[result.plan.joint]
        end_recording(joint.identifier)
        joint.tooth_check.cut()
        if result.unusable:
            joint.complaints.append(f"{bag.path}: {result.unusable}")
        else:
            joint.bags.append(str(bag.path))
            joint.last = result.last
            joint.qualities += [result.last.quality] if result.last else []

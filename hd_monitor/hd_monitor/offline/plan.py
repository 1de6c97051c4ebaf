"""What to replay: which joints with which settings, listening to which of a recording's topics."""

import itertools
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from .. import cdr
from ..errors import ParameterError
from ..settings import JointSettings, split_joints
from ..sources import INPUT_SOURCES, JOINT_STATES, Quantity
from .bag import Bag
from .compression import CHUNK_LIMIT
from .errors import BagError
from .topics import TopicFinder

_SOURCE = "input.source"
_JOINTS = "joints"
_FIRST_MESSAGES = 200


class JointPlan(NamedTuple):
    """A joint to replay."""

    joint: str
    """Its name in the parameters."""
    settings: JointSettings
    topics: dict[Quantity, str]
    """Full names."""
    messages: dict[Quantity, int]
    """Messages recorded on these topics; of all joints where they share a topic."""
    notes: tuple[str, ...]
    """What was taken for granted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What the user requested."""

    parameters: Mapping[str, Any] = field(default_factory=dict)
    """The node's parameters by dotted name."""
    joints: Sequence[str] = ()
    """Joints to replay; all of the parameters' if empty."""
    namespace: str | None = None
    """Namespace of the node, if several have been recorded."""
    remap: Mapping[str, str] = field(default_factory=dict)
    """From the contract's relative names to the recording's."""
    chunk_limit: int = CHUNK_LIMIT
    """Bytes to which a compressed chunk or message of a recording may expand."""


def check_same_settings(known: JointPlan, item: JointPlan, path: Path) -> None:
    """Raise a `ParameterError` where the recording at `path` needs other parameters of a joint than those before it."""
    if known.settings.values == item.settings.values:
        return
    ours, theirs = dict(known.settings.values), dict(item.settings.values)
    differ = ", ".join(f"{name} = {ours[name]} and {theirs[name]}" for name in ours if ours[name] != theirs[name])
    raise ParameterError(
        f"joint {item.joint!r}: {path} would need other parameters than the recordings before it ({differ}); "
        "set them with -p, or take the recordings one by one"
    )


def plan(bag: Bag, request: Request) -> list[JointPlan]:
    """Find out what to replay.

    Raises
    ------
    BagError
        If a topic is missing or ambiguous.
    ParameterError
        If the parameters are wrong, or a joint requested is not one of theirs.
    """
    finder = TopicFinder(
        bag.topics, lambda topic: array_labels(bag, topic), namespace=request.namespace, remap=request.remap
    )
    parameters = dict(request.parameters)
    notes: list[str] = []
    if not any(name == _SOURCE or name.endswith(f".{_SOURCE}") for name in parameters):
        parameters[_SOURCE] = _choose_source(finder, notes)
    named = parameters.get(_JOINTS) or list(request.joints) or _discover(bag, finder, parameters.get(_SOURCE), request)
    if named:
        parameters[_JOINTS] = named
    settings = split_joints(parameters)
    if unknown := [joint for joint in request.joints if joint not in settings]:
        raise ParameterError(f"{', '.join(unknown)}: not among the parameters' joints, {', '.join(settings)}")
    recorded: Counter[str] = Counter()
    for topic in bag.topics:
        recorded[topic.name] += topic.messages
    plans = []
    for joint, own in settings.items():
        if request.joints and joint not in request.joints:
            continue
        below = joint if len(settings) > 1 else None
        topics = finder.joint_topics(own.sources, below)
        extra = {quantity: source for quantity, source in own.all_sources.items() if quantity not in topics}
        topics |= finder.joint_topics({q: source for q, source in extra.items() if finder.has(source)}, below)
        messages = {quantity: recorded[topic] for quantity, topic in topics.items()}
        plans.append(JointPlan(joint, own, topics, messages, tuple(notes)))
    return plans


def array_labels(bag: Bag, topic: str) -> tuple[str, ...]:
    """Labels of the dimensions of an array topic's first message; none if it cannot be read."""
    first = next(iter(bag.messages([topic])), None)
    groups, _ = cdr.decode_multi_arrays([first.data] if first else [])
    return tuple(dimension.label for dimension in groups[0].dimensions) if groups else ()


def joint_names(bag: Bag, topic: str) -> tuple[str, ...]:
    """Names of the joints in a joint_states topic's first messages; several publishers may share the topic."""
    first = [message.data for message in itertools.islice(bag.messages([topic]), _FIRST_MESSAGES)]
    groups, _ = cdr.decode_joint_states(first)
    return tuple(dict.fromkeys(name for group in groups for name in group.names))


def _choose_source(finder: TopicFinder, notes: list[str]) -> str:
    """Choose the vibration signal where the parameters leave it open."""
    sensors = {name: source for name, source in INPUT_SOURCES.items() if source.quantity is Quantity.VIBRATION}
    for name, source in sensors.items():
        if finder.has(source):
            if name != "block":
                notes.append(f"input.source is not given: {name} was recorded and is taken")
            return name
    if finder.has(JOINT_STATES):
        wanted = ", ".join(source.topic for source in sensors.values())
        raise BagError(
            f"none of {wanted} was recorded; for a verdict from joint_states alone set input.source to joint_effort or "
            "joint_velocity, else name the vibration topic with --remap"
        )
    return "block"


def _discover(bag: Bag, finder: TopicFinder, name: object, request: Request) -> list[str]:
    """Take the joints below whose names vibration topics stand, if joint_states knows them and nobody was named."""
    source = INPUT_SOURCES.get(str(name), JOINT_STATES)
    if source is JOINT_STATES or request.namespace is not None or request.remap:
        return []
    prefixes = finder.prefixes(source)
    if len(prefixes) < 2 or any(not prefix for prefix in prefixes):
        return []
    names = [prefix.rpartition("/")[2] for prefix in prefixes]
    (motion,) = finder.joint_topics({Quantity.MOTION: JOINT_STATES}).values()
    known = joint_names(bag, motion)
    return names if len(set(names)) == len(names) and set(names) <= set(known) else []

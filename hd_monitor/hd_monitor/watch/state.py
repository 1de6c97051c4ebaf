"""What is known of every joint: frozen values, replaced as statuses and curves come in."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

from ..cdr import Diagnostics, ReceivedStatus
from ..contract import NANOSECONDS
from ..diagnosis.verdict import Component, FaultCode, Level
from .curves import Curve
from .reading import GROWTH, Reading, readings_of
from .trail import Step, Trail

STALE_AFTER = 5.0
"""Seconds without a status after which a node counts as gone, as in other viewers."""

_SUBJECTS = ("reducer", "input")
_NO_VERDICT = {FaultCode.WAITING, FaultCode.UNRATED}
"""Codes at level OK that do not say that the reducer is sound."""
_LETTERS = {Level.OK: ".", Level.WARN: "W", Level.ERROR: "E"}


class Key(NamedTuple):
    """Which joint of which node."""

    node: str
    """Fully qualified; in a replay, the recording's name."""
    joint: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A joint as its statuses describe it.

    Attributes
    ----------
    key : Key
    reducer, input : ReceivedStatus or None
        The newest of each; None before the first.
    heard : float
        When the newest status came, by the view's clock [s].
    stamp : int
        Its stamp [ns].
    since : int
        Stamp of the first status that said what the newest one says: level, component and fault code [ns].
    before : str
        What was said before `since`, in short; empty if that was said from the first status on.
    trail : Trail
    curves : mapping of str to Curve
        By the topics' names in the contract.
    """

    key: Key
    reducer: ReceivedStatus | None = None
    input: ReceivedStatus | None = None
    heard: float = 0.0
    stamp: int = 0
    since: int = 0
    before: str = ""
    trail: Trail = field(default_factory=Trail)
    curves: Mapping[str, Curve] = field(default_factory=dict)

    @property
    def values(self) -> Mapping[str, str]:
        """Values of the reducer's status; empty before the first."""
        return self.reducer.values if self.reducer else {}

    @property
    def level(self) -> Level:
        """The reducer's level; OK before its first status."""
        return _level(self.reducer)

    @property
    def input_level(self) -> Level:
        """The inputs' level."""
        return _level(self.input)

    @property
    def code(self) -> str:
        """The reducer's fault code; empty before its first status."""
        return self.values.get("fault_code", "")

    @property
    def component(self) -> str:
        """The part named."""
        return self.values.get("component", Component.UNDETERMINED)

    @property
    def readings(self) -> tuple[Reading, ...]:
        """The reducer's readings."""
        return readings_of(self.values)

    @property
    def decisive(self) -> Reading | None:
        """The reading that bears the verdict: of the part and cause accused if any, the one worst by its limit."""
        candidates = self.readings
        accused = [reading for reading in candidates if reading.part == self.component]
        candidates = tuple(accused) or candidates
        if (cause := self.values.get("cause")) in ("stiffness", "transmission_error", "relative"):
            wanted = [r for r in candidates if (r.quantity == "transmission error") == (cause == "transmission_error")]
            candidates = tuple(wanted) or candidates
        # Without limits the growth says more than a share, and parts are compared with each other.
        return max(
            candidates,
            key=lambda r: (r.limited, r.quantity == GROWTH, r.severity if r.limited else r.value),
            default=None,
        )

    def with_status(self, status: ReceivedStatus, subject: str, stamp: int, now: float) -> Self:
        """Return the joint after a status of its reducer or its input, stamped [ns] and heard at the time `now` [s]."""
        if subject == "input":
            return replace(self, input=status, heard=now, stamp=stamp)
        new = replace(self, reducer=status, heard=now, stamp=stamp)
        if self.reducer is None:
            new = replace(new, since=stamp)
        elif self._said != new._said:
            named = f"{self.level.name}, {self.component.replace('_', ' ')}"
            new = replace(new, since=stamp, before="no verdict" if self.code == FaultCode.WAITING else named)
        severity = max((r.severity for r in new.readings if r.limited), default=float("nan"))
        mark = "?" if new.code in _NO_VERDICT else _LETTERS[new.level]
        return replace(new, trail=self.trail.then(Step(stamp, severity, mark)))

    @property
    def _said(self) -> tuple[Level, str, str]:
        return self.level, self.component, self.code


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """Everything on the screen.

    Attributes
    ----------
    source : str
        Where it comes from, in words.
    awaiting : str
        What to check while no joint is known.
    live : bool
        Whether silence means that a node is gone; not so in a recording.
    now : float
        Time of the view's clock [s].
    progress : float or None
        Part of a recording that has been read, 0 to 1; None where it has no end.
    joints : mapping of Key to Joint
    notes : tuple of str
        What is wrong with the source.
    """

    source: str
    awaiting: str
    live: bool
    now: float = 0.0
    progress: float | None = None
    joints: Mapping[Key, Joint] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def with_diagnostics(self, message: Diagnostics) -> Self:
        """Return the view after an array of statuses; those of other programs are left out."""
        joints = dict(self.joints)
        for status in message.statuses:
            node, _, subject = status.name.rpartition(": ")
            joint, _, what = subject.rpartition(" ")
            if node and what in _SUBJECTS and status.values.get("fault_code", "").startswith("HD_"):
                key = Key(node, joint)
                joints[key] = joints.get(key, Joint(key=key)).with_status(status, what, message.stamp, self.now)
        return replace(self, joints=joints)

    def with_curves(self, curves: Iterable[tuple[Key, str, Curve]]) -> Self:
        """Return the view after curves of joints that are known, each with its topic's name in the contract."""
        joints = dict(self.joints)
        for key, name, curve in curves:
            joints[key] = replace(joints[key], curves={**joints[key].curves, name: curve})
        return replace(self, joints=joints)

    def silent_for(self, joint: Joint) -> float:
        """Seconds since a node that must have gone was heard; 0 while it is there."""
        silence = self.now - joint.heard
        return silence if self.live and silence > STALE_AFTER else 0.0

    def urgency(self, joint: Joint) -> int:
        """How much it needs a person, 0 to 2: the worst level; a node that has gone is as bad as an error."""
        return Level.ERROR if self.silent_for(joint) else max(joint.level, joint.input_level)

    @property
    def ranked(self) -> tuple[Joint, ...]:
        """The joints, those that need a person first, else by name."""
        return tuple(sorted(self.joints.values(), key=lambda joint: (-self.urgency(joint), joint.key)))


def seconds_between(start: int, end: int) -> float:
    """Seconds between two stamps [ns]; 0 where the clock was set back."""
    return max(0, end - start) / NANOSECONDS


def _level(status: ReceivedStatus | None) -> Level:
    return Level(min(status.level, Level.ERROR)) if status else Level.OK

"""What a joint's input status says: whether the inputs arrive, and if not, why."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from ..acquisition.presence import Absence, Missing
from ..contract import NANOSECONDS
from ..sources import Quantity
from .verdict import Level

Explain = Callable[[Quantity], str]
"""Explains why an input is silent, as far as the ROS graph shows it."""

_WORDS = {
    Quantity.VIBRATION: "vibration signal",
    Quantity.MOTION: "joint states",
    Quantity.TORQUE: "torque signal",
}
_ADVICE = "check the publisher, the topic's name and the stamps"


class InputCode(StrEnum):
    """Machine-readable state of a joint's inputs."""

    OK = "HD_INPUT_OK"
    WAITING = "HD_INPUT_WAITING"
    LOST = "HD_INPUT_LOST"
    INVALID = "HD_INPUT_INVALID"


@dataclass(frozen=True, slots=True, kw_only=True)
class InputState:
    """State of a joint's inputs at one time.

    Attributes
    ----------
    level, code
    reason : str
        One sentence for a technician.
    """

    level: Level
    code: InputCode
    reason: str

    @property
    def failed(self) -> bool:
        """Whether an input is lost or unusable, so that there is nothing new to judge."""
        return self.code in (InputCode.LOST, InputCode.INVALID)


_STATES = {
    Absence.AWAITED: (Level.OK, InputCode.WAITING),
    Absence.OVERDUE: (Level.WARN, InputCode.WAITING),
    Absence.UNUSABLE: (Level.ERROR, InputCode.INVALID),
    Absence.LOST: (Level.ERROR, InputCode.LOST),
}
ARRIVING = InputState(level=Level.OK, code=InputCode.OK, reason="All inputs arrive")


def listed(quantities: Iterable[Quantity]) -> str:
    """Write the names of inputs that are missing, to stand behind a "no"."""
    return " and no ".join(_WORDS[quantity] for quantity in quantities)


def describe_inputs(
    missing: Sequence[Missing],
    fault: str,
    *,
    explain: Explain | None = None,
    stamps: Mapping[Quantity, int] | None = None,
) -> InputState:
    """Say which inputs are missing, and why.

    Parameters
    ----------
    missing : sequence of Missing
    fault : str
        The newest complaint about what came; empty if there is none.
    explain : callable, optional
        Where there is a ROS graph to ask.
    stamps : mapping of Quantity to int, optional
        Newest stamp of each input [ns], where messages come in real time.
    """
    if not missing:
        return ARRIVING
    worst = max(absence for _, absence in missing)
    level, code = _STATES[worst]
    reasons = []
    if silent := [quantity for quantity, absence in missing if absence is not Absence.UNUSABLE]:
        causes = [_ADVICE, f"last complaint: {fault}" if fault else ""] if explain is None else map(explain, silent)
        missed = f"no {listed(silent)}" if worst is Absence.LOST else f"no {listed(silent)} yet"
        reasons.append(": ".join(filter(None, [missed, "; ".join(filter(None, causes))])))
    for quantity in (quantity for quantity, absence in missing if absence is Absence.UNUSABLE):
        stamp = (stamps or {}).get(quantity)
        stuck = "" if stamp is None else f"their stamps are stuck at {stamp / NANOSECONDS:.3f} s"
        cause = fault or stuck or "check the sensor and the stamps"
        reasons.append(f"messages with the {_WORDS[quantity]} come but cannot be used: {cause}")
    return InputState(level=level, code=code, reason=_sentence("; ".join(reasons)))


def describe_silence(absent: Sequence[Quantity]) -> InputState:
    """Say that nothing comes at all; `absent` lists the inputs never received."""
    reason = f"No {listed(absent)} yet" if absent else "No input comes any more"
    level, code = _STATES[Absence.LOST]
    return InputState(
        level=level, code=code, reason=f"{reason}: check that the publishers run and that the topics match"
    )


def stamped_by_two_clocks(stamps: Mapping[Quantity, int]) -> InputState:
    """Say that inputs come whose newest stamps [ns] are far apart."""
    first, last = min(stamps, key=stamps.__getitem__), max(stamps, key=stamps.__getitem__)
    apart = (stamps[last] - stamps[first]) / NANOSECONDS
    words = f"{_WORDS[first]} and {_WORDS[last]} both come, but their stamps are {apart:.0f} s apart"
    level, code = _STATES[Absence.LOST]
    return InputState(level=level, code=code, reason=f"{_sentence(words)}: stamp both from one clock")


def no_simulated_time(level: Level) -> InputState:
    """Say that the clock by which inputs are awaited has not begun."""
    reason = "use_sim_time is set, but no simulated time has arrived yet: does anything publish /clock?"
    return InputState(level=level, code=InputCode.WAITING, reason=reason)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]

"""The verdict: which spline is at fault, how sure that is, and why."""

from dataclasses import dataclass
from enum import IntEnum, StrEnum
from typing import Self


class Component(StrEnum):
    """The part named."""

    FLEXSPLINE = "flexspline"
    CIRCULAR_SPLINE = "circular_spline"
    BOTH = "both"
    NONE = "none"
    UNDETERMINED = "undetermined"


class Cause(StrEnum):
    """What of a part is at fault."""

    STIFFNESS = "stiffness"
    TRANSMISSION_ERROR = "transmission_error"
    EITHER = "either"
    RELATIVE = "relative"
    NONE = "none"


class FaultCode(StrEnum):
    """Machine-readable reason of a status."""

    OK = "HD_OK"
    FLEXSPLINE = "HD_FLEXSPLINE"
    CIRCULAR_SPLINE = "HD_CIRCULAR_SPLINE"
    BOTH_SPLINES = "HD_BOTH_SPLINES"
    WAITING = "HD_WAITING"
    UNRATED = "HD_UNRATED"
    UNDETERMINED = "HD_UNDETERMINED"
    INTERNAL_ERROR = "HD_INTERNAL_ERROR"


_NO_VERDICT_YET = "No verdict yet: "

_FAULT_CODES = {
    Component.NONE: FaultCode.OK,
    Component.FLEXSPLINE: FaultCode.FLEXSPLINE,
    Component.CIRCULAR_SPLINE: FaultCode.CIRCULAR_SPLINE,
    Component.BOTH: FaultCode.BOTH_SPLINES,
    Component.UNDETERMINED: FaultCode.UNDETERMINED,
}


class Level(IntEnum):
    """Levels of diagnostic_msgs/DiagnosticStatus that a monitor may publish."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What a status says of one reducer at one time.

    Attributes
    ----------
    component, level, fault_code
        The part named, the level and the code.
    reason : str
        One sentence for a technician.
    cause : Cause
        The reading that accuses the part: ``either`` where the data cannot tell, ``relative`` without torque, ``none``
        where no part is accused.
    """

    component: Component
    level: Level
    fault_code: FaultCode
    reason: str
    cause: Cause = Cause.NONE

    @classmethod
    def naming(
        cls, component: Component, level: Level, reason: str, cause: Cause = Cause.NONE, *, rated: bool = False
    ) -> Self:
        """Return the verdict whose fault code says no more than its component.

        A relative one says nothing of the size of a defect, unless it is `rated` against a baseline.
        """
        unrated = cause is Cause.RELATIVE and not rated
        code = FaultCode.UNRATED if unrated else _FAULT_CODES[component]
        return cls(component=component, level=level, fault_code=code, reason=reason, cause=cause)

    @classmethod
    def waiting(cls, reason: str) -> Self:
        """Return that there is no verdict yet, which needs nobody; the reason says what is awaited."""
        return cls(
            component=Component.UNDETERMINED,
            level=Level.OK,
            fault_code=FaultCode.WAITING,
            reason=f"{_NO_VERDICT_YET}{reason[:1].lower()}{reason[1:]}",
        )

    @property
    def sentence(self) -> str:
        """The reason without the words that say that there is no verdict yet."""
        reason = self.reason.removeprefix(_NO_VERDICT_YET)
        return reason[:1].upper() + reason[1:]

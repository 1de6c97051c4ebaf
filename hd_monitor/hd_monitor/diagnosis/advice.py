"""What a verdict asks of a person, by its fault code and level."""

from collections.abc import Mapping

from .verdict import FaultCode, Level

_PARTS: Mapping[str, str] = {
    FaultCode.FLEXSPLINE: "the flexspline",
    FaultCode.CIRCULAR_SPLINE: "the circular spline",
    FaultCode.BOTH_SPLINES: "both splines",
}

_OTHERS: Mapping[str, str] = {
    FaultCode.OK: "Nothing",
    FaultCode.WAITING: "Nothing: let the joint work",
    FaultCode.UNRATED: "Set a baseline while the reducer is known to be sound (~/set_baseline), or give the torque",
    FaultCode.UNDETERMINED: "Check what the reason names; until then nothing can be concluded",
    FaultCode.INTERNAL_ERROR: "Report the error with the lines of the node's log",
}


def advise(code: str, level: Level) -> str:
    """Say what to do about a reducer whose status has this fault code and level.

    Examples
    --------
    >>> advise("HD_FLEXSPLINE", Level.WARN)
    'Plan an inspection of the flexspline and have a spare ready'
    """
    if code not in _PARTS:
        return _OTHERS.get(code, "Read the reason")
    if level is Level.ERROR:
        return f"Inspect {_PARTS[code]} at the next stop; replace the reducer if it is worn or cracked"
    return f"Plan an inspection of {_PARTS[code]} and have a spare ready"

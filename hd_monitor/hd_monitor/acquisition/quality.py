"""Counters of faults in the incoming data, shown in every status."""

from dataclasses import dataclass, field, fields
from typing import Any


def _count(key: str, meaning: str) -> Any:
    """Make a counter from 0, with its key in the status."""
    return field(default=0, metadata={"key": key, "meaning": meaning})


@dataclass(frozen=True, slots=True, kw_only=True)
class Quality:
    """Counts since the start, of the vibration signal unless a name says otherwise.

    Attributes
    ----------
    rate : float
        Sampling rate measured [Hz]; 0 before anything came.
    last_fault : str
        The newest complaint in words; empty if there is none.
    """

    samples: int = _count("samples", "samples accepted")
    gaps: int = _count("gaps", "holes: places where samples are missing, however many")
    lost: int = _count("lost samples", "samples missing in those holes")
    duplicates: int = _count("duplicates", "samples or blocks whose stamp or sequence number had come before; dropped")
    out_of_order: int = _count("out of order", "samples that came late but were sorted in, or dropped if too late")
    not_finite: int = _count("not finite", "NaN, infinite and absurdly large values")
    clipped: int = _count("clipped", "samples at the sensor's full scale")
    stuck: int = _count("stuck", "samples of a signal that did not change at all while the joint was turning")
    spikes: int = _count("spikes", "samples left out as outliers")
    clock_jumps: int = _count("clock jumps", "times the stamps jumped back, or ahead beyond any gap")
    motion_messages: int = _count("joint states", "joint states accepted")
    motion_faults: int = _count("bad joint states", "dropped: not finite, without position, out of order or repeated")
    torque_messages: int = _count("torque samples", "samples of a torque sensor accepted")
    torque_faults: int = _count("bad torque samples", "dropped: not finite, out of order or repeated")
    rejected: int = _count("rejected messages", "messages with a wrong layout")
    dropped: int = _count("dropped", "dropped: mixed from several publishers, placed by no clock, or beyond a buffer")
    rate: float = 0.0
    last_fault: str = ""

    def counts(self) -> tuple[tuple[str, str], ...]:
        """Return every counter as a status shows it: key and value."""
        return tuple((f.metadata["key"], str(getattr(self, f.name))) for f in fields(self) if f.metadata)

"""Counters of faults in the incoming data, shown in every status."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Quality:
    """Counts since the start, of the vibration signal unless a name says otherwise.

    Attributes
    ----------
    samples : int
        Samples accepted.
    gaps : int
        Holes: places where samples are missing, however many.
    lost : int
        Samples missing in those holes.
    duplicates : int
        Samples or blocks dropped because their stamp or sequence number had come before.
    out_of_order : int
        Samples that came late but were sorted in, or dropped if too late.
    not_finite : int
        NaN or infinite values.
    clipped : int
        Samples at the sensor's full scale.
    stuck : int
        Samples of a signal that did not change at all while the joint was turning.
    spikes : int
        Samples left out as outliers.
    clock_jumps : int
        Times the stamps jumped back, or ahead beyond any gap.
    motion_messages : int
        Joint states accepted.
    motion_faults : int
        Joint states dropped: not finite, without position, out of order or repeated.
    torque_messages, torque_faults : int
        Samples of a torque sensor accepted, and dropped: not finite, out of order or repeated.
    rejected : int
        Messages with a wrong layout.
    rate : float
        Sampling rate measured [Hz]; 0 before anything came.
    last_fault : str
        The newest complaint in words; empty if there is none.
    """

    samples: int = 0
    gaps: int = 0
    lost: int = 0
    duplicates: int = 0
    out_of_order: int = 0
    not_finite: int = 0
    clipped: int = 0
    stuck: int = 0
    spikes: int = 0
    clock_jumps: int = 0
    motion_messages: int = 0
    motion_faults: int = 0
    torque_messages: int = 0
    torque_faults: int = 0
    rejected: int = 0
    rate: float = 0.0
    last_fault: str = ""

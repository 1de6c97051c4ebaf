"""An entry of the ledger: what was known of one reducer at one time, on how much motion."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from typing import Any, Self

from .. import __version__
from ..assessment import Assessment
from ..contract import NANOSECONDS
from ..diagnosis.verdict import Cause, Component, FaultCode, Level, Verdict
from ..identification.result import LineEstimate
from ..identification.sensorless.agreement import DirectionEvidence
from ..orders.rms_curve import SpeedBin
from ..reducer import LinePair


class Kind(StrEnum):
    """Why an entry was made."""

    EVIDENCE = "evidence"
    """A share of motion is through, or a recording."""
    TRANSITION = "transition"
    """The verdict changed."""
    EXCHANGE = "exchange"
    """The reducer was exchanged: what was before belongs to another one."""
    BASELINE = "baseline"
    """The reducer is declared to be as it should be from here on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """What was known of one reducer.

    Attributes
    ----------
    serial, joint : str
        The reducer's serial number, empty where none is given, and the joint's name.
    time : float
        Stamp of the newest message behind it [s], on the messages' clock.
    kind : Kind
    verdict : Verdict or None
        None for marks.
    index, index_std : LinePair or None
        Stiffness indexes, fractions; shares if `relative`.
    relative : bool
    transmission_error, transmission_error_std : LinePair or None
        [arcmin peak to peak]
    index_limits, transmission_error_limits : tuple of float
        Of the warning and of the error, in the same units.
    lines : tuple of LineEstimate
    evidence : tuple of DirectionEvidence
        Lines direction by direction with their covariance, from joint states alone.
    rms_curve : tuple of SpeedBin
        Of the motion since the entry before, with bins of `rms_bin_width` [rpm].
    revolutions : float
        Revolutions of the wave generator since the entry before, while this was watched.
    seconds : float
        Motion since the entry before [s].
    speed : float
        Mean speed of the wave generator over that motion [rpm]; NaN without any.
    torque : float
        Mean effort over that motion [N·m, or the effort's own unit]; NaN where none is measured.
    temperature : float
        Mean temperature over that motion [°C]; NaN where none is measured.
    source : str
        ``input.source``: lines of different signals cannot be compared.
    recording : str
        Where it came from; empty for a running node.
    version : str
        Of the software.
    """

    serial: str
    joint: str
    time: float
    kind: Kind
    verdict: Verdict | None = None
    index: LinePair | None = None
    index_std: LinePair | None = None
    relative: bool = False
    transmission_error: LinePair | None = None
    transmission_error_std: LinePair | None = None
    index_limits: tuple[float, float] = (math.nan, math.nan)
    transmission_error_limits: tuple[float, float] = (math.nan, math.nan)
    lines: tuple[LineEstimate, ...] = ()
    evidence: tuple[DirectionEvidence, ...] = ()
    rms_curve: tuple[SpeedBin, ...] = ()
    rms_bin_width: float = 100.0
    revolutions: float = 0.0
    seconds: float = 0.0
    speed: float = math.nan
    torque: float = math.nan
    temperature: float = math.nan
    source: str = ""
    recording: str = ""
    version: str = __version__

    @classmethod
    def of(cls, assessment: Assessment, joint: str, *, kind: Kind = Kind.EVIDENCE, recording: str = "") -> Self:
        """Sum up an assessment; the motion behind it is for the caller to add."""
        limits = assessment.settings.diagnosis
        entry = cls(
            serial=assessment.settings.serial,
            joint=joint,
            time=assessment.stamp / NANOSECONDS,
            kind=kind,
            verdict=assessment.verdict,
            index_limits=(limits.warn_index, limits.error_index),
            transmission_error_limits=(limits.warn_transmission_error, limits.error_transmission_error),
            rms_curve=assessment.rms_curve,
            rms_bin_width=assessment.settings.analysis.rms_bin_width,
            source=assessment.settings.input.source,
            recording=recording,
        )
        found = assessment.identification
        if found is None or not found.samples or not all(map(math.isfinite, found.index_std)):
            return entry
        return replace(
            entry,
            index=found.index,
            index_std=found.index_std,
            relative=found.relative,
            transmission_error=found.transmission_error,
            transmission_error_std=found.transmission_error_std,
            lines=found.lines,
            evidence=found.evidence,
        )

    def with_motion(
        self,
        *,
        revolutions: float,
        seconds: float,
        torque: float,
        temperature: float,
        rms_curve: tuple[SpeedBin, ...],
    ) -> Self:
        """Return the entry with the motion since the one before."""
        return replace(
            self,
            revolutions=revolutions,
            seconds=seconds,
            speed=revolutions / seconds * 60.0 if seconds else math.nan,
            torque=torque,
            temperature=temperature,
            rms_curve=rms_curve,
        )

    def content(self) -> dict[str, Any]:
        """Write what is in no column of its own as plain data, fit for JSON."""
        whole = _plain(asdict(self))
        return {name: value for name, value in whole.items() if name not in ("serial", "joint", "time", "kind")}

    @classmethod
    def from_content(cls, serial: str, joint: str, time: float, kind: str, content: Mapping[str, Any]) -> Self:
        """Read what `content` wrote; keys that this version does not know are left out."""
        given = {name: value for name, value in content.items() if name in cls.__dataclass_fields__}
        verdict = given.get("verdict")
        given |= {name: math.nan if given.get(name) is None else given[name] for name in _NUMBERS}
        given |= {name: tuple(_both(given[name])) for name in _LIMITS if name in given}
        given |= {name: _pair(given.get(name)) for name in _PAIRS}
        given["verdict"] = None if verdict is None else _verdict(verdict)
        given["lines"] = tuple(map(_line, given["lines"]))
        given["evidence"] = tuple(map(_direction, given["evidence"]))
        given["rms_curve"] = tuple(SpeedBin(*point) for point in given["rms_curve"])
        return cls(serial=serial, joint=joint, time=time, kind=Kind(kind), **given)


_NUMBERS = ("speed", "torque", "temperature")
_LIMITS = ("index_limits", "transmission_error_limits")
_PAIRS = ("index", "index_std", "transmission_error", "transmission_error_std")


def _plain(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def _both(values: Any) -> LinePair:
    circular_spline, flexspline = values  # spelt out: a large ledger has ten thousands
    return LinePair(
        math.nan if circular_spline is None else circular_spline, math.nan if flexspline is None else flexspline
    )


def _pair(values: Any) -> LinePair | None:
    return None if values is None else _both(values)


def _line(given: Mapping[str, Any]) -> LineEstimate:
    return LineEstimate(k=given["k"], amplitude=_both(given["amplitude"]), std=_both(given["std"]))


def _verdict(given: Mapping[str, Any]) -> Verdict:
    return Verdict(
        component=Component(given["component"]),
        level=Level(given["level"]),
        fault_code=FaultCode(given["fault_code"]),
        reason=given["reason"],
        cause=Cause(given["cause"]),
    )


def _direction(given: Mapping[str, Any]) -> DirectionEvidence:
    whole = dict(given)
    for name in ("amplitude", "std", "chance", "dominance", "phase"):
        whole[name] = _both(whole[name])
    for name in ("noise", "floor", "speed"):
        if whole[name] is None:
            whole[name] = math.nan
    return DirectionEvidence(**whole)

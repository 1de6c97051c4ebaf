"""An assessment as two diagnostic statuses, the reducer's and its inputs'; the same for node, replay and report."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..assessment import Assessment
from ..change import Growth
from ..identification.result import Identification
from ..reducer import LinePair
from .something_else import describe_all_else
from .uncertain import decimals, significant
from .verdict import Component

LONGEST_MESSAGE = 128
"""Characters of a string that ``ros2 topic echo`` shows before it truncates."""

_DIGITS = 3
"""Decimals of a number, unless it says otherwise."""

_NOTHING = Identification.none((), relative=False)
"""Stands in as long as nothing is identified."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """What goes into a diagnostic_msgs/DiagnosticStatus.

    Attributes
    ----------
    subject : str
        What the status is of, as the end of its name: ``elbow reducer``.
    level : int
        0 OK, 1 WARN, 2 ERROR.
    message, hardware_id : str
    kind : tuple of str
        What kind of reason it gives: the sentence may change in numbers alone.
    values : tuple of (str, str)
        Keys with their units, and values: one plain number or word each; unknown numbers are left out.
    """

    subject: str
    level: int
    message: str
    hardware_id: str
    kind: tuple[str, ...]
    values: tuple[tuple[str, str], ...]

    def value(self, key: str) -> str:
        """Return the value of a key."""
        return dict(self.values)[key]


def status_of(assessment: Assessment, joint: str) -> Status:
    """Write what an assessment says of the reducer of the joint of this name as a status."""
    verdict, quality = assessment.verdict, assessment.quality
    found = assessment.identification or _NOTHING
    index_kind = "unknown" if found is _NOTHING else "relative" if found.relative else "absolute"
    limits, needed = assessment.settings.diagnosis, assessment.settings.reducer.travel_to_separate(1)
    counts = dict(quality.counts())
    kind = tuple(blocker.code.value for blocker in found.blockers) if assessment.identification else (verdict.reason,)
    values: list[tuple[str, str | None]] = [
        ("joint", joint),
        ("component", verdict.component.value),
        ("cause", verdict.cause.value),
        ("fault_code", verdict.fault_code.value),
        ("reason", verdict.reason),
        ("speed (rpm)", _number(assessment.speed, 1)),
        ("rms (m/s^2)", _number(assessment.rms, 4)),
        ("rms growth (%)", _number(100.0 * assessment.rms_growth, 1)),
        ("evidence age (s)", _number(assessment.evidence_age, 0)),
        *_indexes(found),
        *_errors(found),
        *_growths(assessment.line_growth),
        ("index kind", index_kind),
        ("warn limit (%)", _number(100.0 * limits.warn_index)),
        ("error limit (%)", _number(100.0 * limits.error_index)),
        ("warn limit (arcmin)", _number(limits.warn_transmission_error)),
        ("error limit (arcmin)", _number(limits.error_transmission_error)),
        ("travel (deg)", _number(math.degrees(found.travel), 1)),
        ("travel needed (deg)", _number(math.degrees(needed), 1)),
        ("signal to noise (dB)", _number(found.signal_to_noise, 1)),
        ("misfit", _number(found.misfit, 2)),
        ("something else", describe_all_else(found.something_else)),
        ("fit", found.fit_status.value if found.fit_status else "none"),
        ("natural frequency (Hz)", _number(found.natural_frequency, 2)),
        ("natural frequency std (Hz)", _std(found.natural_frequency_std)),
        ("damping ratio", _number(found.damping_ratio, 4)),
        ("load fluctuation (N*m)", _number(found.load_fluctuation)),
        ("unstable from (rpm)", _number(found.critical_speed, 0)),
        ("torque source", assessment.torque_source),
        *((key, counts[key]) for key in ("samples", "gaps")),
        ("samples used", str(found.samples)),
        *assessment.extra,
    ]
    return Status(
        subject=f"{joint} reducer",
        level=int(verdict.level),
        message=shortened(_plain(verdict.reason)),
        hardware_id=assessment.settings.serial,
        kind=kind,
        values=tuple((key, _plain(value)) for key, value in values if value is not None),
    )


def input_status_of(assessment: Assessment, joint: str) -> Status:
    """Write what an assessment says of the inputs of the joint of this name as a status."""
    state, quality = assessment.input, assessment.quality
    samples, *faults = quality.counts()
    rate = _number(quality.rate or math.nan, 2)
    return Status(
        subject=f"{joint} input",
        level=int(state.level),
        message=shortened(_plain(state.reason)),
        hardware_id=assessment.settings.serial,
        kind=(state.reason,),
        values=(
            ("joint", joint),
            ("fault_code", state.code.value),
            ("reason", _plain(state.reason)),
            samples,
            *((("sampling rate (Hz)", rate),) if rate is not None else ()),
            *faults,
            ("last complaint", _plain(quality.last_fault) or "none"),
        ),
    )


def shortened(sentence: str) -> str:
    """Return as many whole clauses of a sentence as a message may have; an ellipsis says that more follows.

    Examples
    --------
    >>> shortened("Check the sensor: " + "it hears nothing of this joint, " * 4)
    'Check the sensor: it hears nothing of this joint, it hears nothing of this joint, it hears nothing of this joint …'
    """
    if len(sentence) <= LONGEST_MESSAGE:
        return sentence
    room = sentence[: LONGEST_MESSAGE - 2]
    ends = (max(map(room.rfind, marks)) for marks in ((", ", "; ", ": ", " ("), (" ",)))
    end = next((end for end in ends if end >= LONGEST_MESSAGE // 2), len(room))
    return f"{room[:end]} …"


def _indexes(found: Identification) -> list[tuple[str, str | None]]:
    """Indexes, or shares, whose squares add up to one, where the sizes mean nothing."""
    word, size = ("share", math.hypot(*found.index) or math.nan) if found.relative else ("index", 1.0)
    return _pairs(f"{word}%s (%%)", _scaled(found.index, 100.0 / size), _scaled(found.index_std, 100.0 / size))


def _scaled(pair: LinePair, factor: float) -> LinePair:
    return LinePair(*(factor * value for value in pair))


def _errors(found: Identification) -> list[tuple[str, str | None]]:
    """Transmission errors, where they are estimated."""
    if found.transmission_error is None or found.transmission_error_std is None:
        return []
    return _pairs("transmission error%s (arcmin)", found.transmission_error, found.transmission_error_std)


def _growths(growth: Mapping[Component, Growth]) -> list[tuple[str, str | None]]:
    """Growth of each spline's line, where there is a baseline."""
    if not growth:
        return []
    sides = (growth[part] for part in (Component.CIRCULAR_SPLINE, Component.FLEXSPLINE))
    values, stds = (LinePair(*(100.0 * number for number in column)) for column in zip(*sides, strict=True))
    return _pairs("line growth%s (%%)", values, stds)


def _pairs(key: str, values: LinePair, stds: LinePair) -> list[tuple[str, str | None]]:
    """Write a value of each spline and its standard deviation; the key has a place for the latter's name."""
    return [
        (f"{part.replace('_', ' ')} {key % word}", written)
        for part in ("flexspline", "circular_spline")
        for word, written in (
            ("", _number(getattr(values, part), max(_DIGITS, decimals(getattr(stds, part))))),
            (" std", _std(getattr(stds, part))),
        )
    ]


def _plain(text: str) -> str:
    """Return a text without double quotes, which loggers into databases write around it unescaped."""
    return text.replace('"', "'")


def _std(value: float) -> str | None:
    return significant(value) if math.isfinite(value) else None


def _number(value: float, digits: int = _DIGITS) -> str | None:
    """Write a number; None leaves an unknown one out, so that a key never holds a word in its place."""
    return f"{value:.{digits}f}" if math.isfinite(value) else None

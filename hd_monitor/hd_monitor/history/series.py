"""From the entries of a reducer to a series of values for each reading: indexes, transmission errors, lines, ratio."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..identification.result import LineEstimate
from ..identification.sensorless.agreement import DirectionEvidence
from ..reducer import LinePair
from .entry import Entry, Kind

BASELINE_MOTION = 3600.0
"""Motion [s] behind a baseline: the last before it was set or, where none was, the first of all."""

SAME_MOTION = 0.01
"""Part by which travel, mean speed and duration may differ where a motion is the same one again."""

FEWEST_REPEATS = 3
"""Repetitions in the baseline from which they show whether the lines' uncertainty holds."""

SPLINES = ("flexspline", "circular_spline")

Motion = Sequence[DirectionEvidence]
"""A motion, by the evidence that it gave direction by direction."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Series:
    """One reading over the life of a reducer.

    Attributes
    ----------
    name, unit : str
    times : ndarray, shape (points,)
        [s] on the messages' clock.
    revolutions : ndarray, shape (points,)
        Of the wave generator since the reducer was first seen.
    temperatures : ndarray, shape (points,)
        Of the reducer [°C]; NaN where none was measured.
    values, stds : ndarray, shape (points,)
        With the standard deviation that each measurement had by itself, as a repetition where it is one of the
        baseline's motion.
    is_baseline : ndarray of bool, shape (points,)
        What the others are compared with.
    warn, error : float
        Limits in the same unit; NaN where there are none.
    """

    name: str
    unit: str
    times: FloatArray
    revolutions: FloatArray
    temperatures: FloatArray
    values: FloatArray
    stds: FloatArray
    is_baseline: np.typing.NDArray[np.bool_]
    warn: float = math.nan
    error: float = math.nan


class _Row(NamedTuple):
    """One point of a series."""

    time: float
    revolutions: float
    temperature: float
    value: float
    std: float
    is_baseline: bool


def series_of(entries: Sequence[Entry]) -> list[Series]:
    """Return every reading of which a reducer's entries, by time, have at least one value.

    Entries of another signal than the newest are left out: their lines have another unit.
    """
    turned = dict(zip(map(id, entries), np.cumsum([entry.revolutions for entry in entries]).tolist(), strict=True))
    base = baseline_entries(entries)
    repeated, chosen = repeated_motion(base), set(map(id, base))
    columns: dict[str, list[_Row]] = {}
    about: dict[str, tuple[str, float, float]] = {}
    for entry in comparable_entries(entries):
        total, is_base = turned[id(entry)], id(entry) in chosen
        for name, unit, value, std, warn, error in _readings(entry, repeated):
            if math.isfinite(value) and math.isfinite(std) and std > 0.0:
                columns.setdefault(name, []).append(_Row(entry.time, total, entry.temperature, value, std, is_base))
                about[name] = unit, warn, error
    return [_series(name, *about[name], rows) for name, rows in columns.items()]


def _series(
    name: str,
    unit: str,
    warn: float,
    error: float,
    rows: Iterable[_Row],
) -> Series:
    times, revolutions, temperatures, values, stds, base = (np.array(column) for column in zip(*rows, strict=True))
    return Series(
        name=name,
        unit=unit,
        times=times,
        revolutions=revolutions,
        temperatures=temperatures,
        values=values,
        stds=stds,
        is_baseline=base.astype(bool),
        warn=warn,
        error=error,
    )


def comparable_entries(entries: Sequence[Entry]) -> list[Entry]:
    """Return those with readings of the signal that the newest one is of."""
    kept = [entry for entry in entries if entry.kind is Kind.EVIDENCE]
    return [entry for entry in kept if entry.source == kept[-1].source]


def baseline_entries(entries: Sequence[Entry]) -> list[Entry]:
    """Return those that the others are compared with: before the last mark, else the first; `BASELINE_MOTION` long."""
    kept = comparable_entries(entries)
    if marks := [place for place, entry in enumerate(entries) if entry.kind is Kind.BASELINE]:
        before = set(map(id, entries[: marks[-1]]))
        kept = [entry for entry in reversed(kept) if id(entry) in before]
    seconds = np.cumsum([entry.seconds for entry in kept])
    chosen = kept[: max(1, int(np.searchsorted(seconds, BASELINE_MOTION, side="right")))]
    return chosen[::-1] if marks else chosen


def repeated_motion(baseline: Sequence[Entry]) -> Motion:
    """Return the one motion of which all entries of a baseline are repetitions; none where they are not, or too few."""
    first = baseline[0].evidence if len(baseline) >= FEWEST_REPEATS else ()
    return first if all(_is_repetition(entry.evidence, first) for entry in baseline) else ()


def _is_repetition(motion: Motion, of: Motion) -> bool:
    """Whether a motion is another one again."""
    one, other = ([piece for piece in pieces if piece.k == 1] for pieces in (motion, of))
    if not one or [piece.name for piece in one] != [piece.name for piece in other]:
        return False
    numbers = (
        zip((a.travel, a.speed, a.seconds), (b.travel, b.speed, b.seconds), strict=True)
        for a, b in zip(one, other, strict=True)
    )
    return all(math.isclose(a, b, rel_tol=SAME_MOTION) for pairs in numbers for a, b in pairs)


def _readings(entry: Entry, repeated: Motion) -> Iterator[tuple[str, str, float, float, float, float]]:
    """Name, unit, value, standard deviation, warn and error limit of each reading of an entry."""
    none = (math.nan, math.nan)
    if entry.index is not None and entry.index_std is not None and not entry.relative:
        yield from _both("index", "fraction", entry.index, entry.index_std, entry.index_limits)
    if entry.transmission_error is not None and entry.transmission_error_std is not None:
        error, std = entry.transmission_error, entry.transmission_error_std
        yield from _both("transmission error", "arcmin", error, std, entry.transmission_error_limits)
    for line in lines_of(entry.lines, entry.evidence, repeated):
        yield from _both(f"line {line.k}", "signal's", line.amplitude, line.std, none)
        if line.k == 1 and min(line.amplitude) > 0.0:
            relative = [s / a for a, s in zip(line.amplitude, line.std, strict=True)]
            # The logarithm's scatter does not depend on its size, and a doubling weighs as much as a halving
            ratio = math.log(line.amplitude.flexspline / line.amplitude.circular_spline)
            yield ("log of the ratio, flexspline over circular spline", "", ratio, math.hypot(*relative), *none)


def _both(
    name: str, unit: str, value: LinePair, std: LinePair, limits: tuple[float, float]
) -> Iterator[tuple[str, str, float, float, float, float]]:
    for spline in SPLINES:
        yield (f"{spline.replace('_', ' ')} {name}", unit, getattr(value, spline), getattr(std, spline), *limits)


def lines_of(
    lines: Sequence[LineEstimate], evidence: Sequence[DirectionEvidence], repeated: Motion
) -> Iterator[LineEstimate]:
    """Lines of the newest motion; from joint states alone the pooled `lines` hold earlier motion too.

    Amplitudes that vary with the speed have skirts, which limit what one motion tells of a line. They come again with
    the same motion, so the standard deviations of a repetition are without them.
    """
    if not evidence:
        yield from lines
    again = _is_repetition(evidence, repeated)
    for k in sorted({piece.k for piece in evidence}):
        pieces = [piece for piece in evidence if piece.k == k]
        count = len(pieces)
        skirts = [max(1.0, piece.floor) if again else 1.0 for piece in pieces]  # 1 where the floor is NaN, too
        sizes, stds = (zip(*(getattr(piece, name) for piece in pieces), strict=True) for name in ("amplitude", "std"))
        yield LineEstimate(
            k=k,
            amplitude=LinePair(*(math.fsum(own) / count for own in sizes)),
            std=LinePair(
                *(
                    math.sqrt(sum(std**2 / skirt for std, skirt in zip(own, skirts, strict=True))) / count
                    for own in stds
                )
            ),
        )

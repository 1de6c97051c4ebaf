"""What a ledger says of its reducers, as plain data, as rows and as text."""

import csv
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from .. import __version__
from ..change import SIGNIFICANT, Change
from ..diagnosis.uncertain import with_std
from ..diagnosis.verdict import Verdict
from ..history.entry import Entry, Kind
from ..history.ledger import Ledger, Reducer
from ..history.property_curves import property_curves
from ..history.series import Series, series_of
from ..history.trend import Slope, Step, change_of, slope_of, step_of
from ..orders.rms_curve import SpeedBin
from .errors import BagError
from .line_changes import CurveChange, curve_change, describe_curve
from .result import plain

COLUMNS = ("serial", "joint", "time", "revolutions", "reading", "unit", "value", "std", "is_baseline", "temperature")
"""Of a row for each value, as CSV and Parquet have them."""

_POINT = {
    "time": "times",
    "revolutions": "revolutions",
    "value": "values",
    "std": "stds",
    "is_baseline": "is_baseline",
    "temperature": "temperatures",
}
"""Keys of a value in JSON, and the columns of a series that they are of."""

_UNITS = {"arcmin": (1.0, "′", "′"), "fraction": (100.0, " %", " points")}
"""How readings of a unit are shown: factor, and the unit of a value and of a difference."""

_PLAIN = (1.0, "", "")

_DECADES = ((365.25, "years"), (30.4, "months"), (1.0, "days"), (1.0 / 24.0, "hours"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """A series of values, and what changed in it."""

    series: Series
    change: Change | None
    slope: Slope | None
    step: Step | None

    @property
    def remarks(self) -> list[str]:
        """What is worth saying, in sentences; nothing where nothing changed."""
        name, said = self.series.name, []
        if (change := self.change) is not None and change.significant:
            said.append(
                f"{name}: {self._value(change.before, change.before_std)} in the baseline, "
                f"{self._value(change.after, change.after_std)} now (changed by "
                f"{self._difference(change.change, change.std)})"
            )
        if self.step is not None:
            said.append(
                f"{name}: changed in one step by {self._difference(self.step.change, self.step.std)} before "
                f"{date(self.step.time)}; if the reducer was exchanged or adjusted then, mark it"
            )
        if self.slope is not None:
            ahead = self.slope.days_to_limit
            said.append(
                f"{name}: changes by {self._difference(self.slope.per_day, self.slope.per_day_std)} a day"
                + (f"; the limit is {_duration(ahead)} away if that goes on" if ahead else "")
            )
        return said

    @property
    def newest(self) -> str:
        """The newest value, and by how much it differs from the baseline's."""
        text = self._value(float(self.series.values[-1]), float(self.series.stds[-1]))
        change = self.change
        return text + (f", changed by {self._difference(change.change, change.std)}" if change else "")

    def _value(self, value: float, std: float) -> str:
        scale, unit, _ = _UNITS.get(self.series.unit, _PLAIN)
        return f"{with_std(scale * value, scale * std)}{unit}"

    def _difference(self, value: float, std: float) -> str:
        scale, _, unit = _UNITS.get(self.series.unit, _PLAIN)
        return f"{with_std(scale * value, scale * std)}{unit}"


@dataclass(frozen=True, slots=True, kw_only=True)
class ReducerHistory:
    """What the ledger has of one reducer since it was put in."""

    reducer: Reducer
    entries: Sequence[Entry]
    readings: Sequence[Reading]
    curves: tuple[tuple[SpeedBin, ...], tuple[SpeedBin, ...]]
    """RMS by speed in the baseline, and since."""

    @property
    def curve_change(self) -> CurveChange | None:
        """What changed in the RMS at the speeds of both; None where these are too few."""
        before, after = ([point._asdict() for point in curve] for curve in self.curves)
        width = self.entries[-1].rms_bin_width if self.entries else 1.0
        return curve_change(before, after, width)

    @property
    def remarks(self) -> list[str]:
        """What is worth saying, in sentences."""
        said = [remark for reading in self.readings for remark in reading.remarks]
        change = self.curve_change
        return said + ([describe_curve(change)] if change is not None and change.p_value < SIGNIFICANT else [])

    @property
    def verdict(self) -> Verdict | None:
        """The last one."""
        return next((entry.verdict for entry in reversed(self.entries) if entry.verdict is not None), None)

    @property
    def seen(self) -> str:
        """When it was seen last, and how warm."""
        if not self.entries:
            return "never"
        warm = next((e.temperature for e in reversed(self.entries) if e.kind is Kind.EVIDENCE), math.nan)
        return f"{date(self.entries[-1].time)} UTC" + (f", {warm:.1f} °C" if math.isfinite(warm) else "")

    @property
    def joint(self) -> str:
        """Where the reducer was seen last."""
        return self.entries[-1].joint if self.entries else self.reducer.joint


def read_histories(ledger: Ledger, serial: str | None = None) -> list[ReducerHistory]:
    """Read every reducer's history, or that of one serial number.

    Raises
    ------
    BagError
        If the ledger knows nothing, or not this serial number.
    """
    chosen = ledger.reducers(serial)
    if not chosen:
        names = ", ".join(map(str, ledger.reducers())) or "no reducer yet"
        raise BagError(f"{ledger.path} has nothing on {serial or 'any reducer'}; it knows {names}")
    return [_history(reducer, ledger.entries(*reducer)) for reducer in chosen]


def _history(reducer: Reducer, entries: Sequence[Entry]) -> ReducerHistory:
    readings = [
        Reading(series=series, change=change_of(series), slope=slope_of(series), step=step_of(series))
        for series in series_of(entries)
    ]
    return ReducerHistory(reducer=reducer, entries=entries, readings=readings, curves=property_curves(entries))


def as_dict(histories: Sequence[ReducerHistory], path: str) -> dict[str, Any]:
    """Write histories as plain data, fit for JSON."""
    reducers = [
        {
            "serial": history.reducer.serial,
            "joint": history.joint,
            "entries": len(history.entries),
            "revolutions": sum(entry.revolutions for entry in history.entries),
            "verdict": _verdict(history),
            "readings": [_reading(reading) for reading in history.readings],
            "rms_curve": _curves(history),
            "remarks": history.remarks,
        }
        for history in histories
    ]
    return dict(plain({"ledger": path, "reducers": reducers, "generator": f"hd_monitor {__version__}"}))


def _verdict(history: ReducerHistory) -> dict[str, Any] | None:
    entry = next((entry for entry in reversed(history.entries) if entry.verdict is not None), None)
    if entry is None or entry.verdict is None:
        return None
    verdict = entry.verdict
    return {
        "component": verdict.component.value,
        "level": int(verdict.level),
        "level_name": verdict.level.name,
        "fault_code": verdict.fault_code.value,
        "cause": verdict.cause.value,
        "reason": verdict.reason,
        "time": entry.time,
    }


def _curves(history: ReducerHistory) -> dict[str, Any]:
    before, after = ([point._asdict() for point in curve] for curve in history.curves)
    change = history.curve_change
    return {"baseline": before, "newest": after, "change": change and change._asdict()}


def _reading(reading: Reading) -> dict[str, Any]:
    series, change, slope, step = reading.series, reading.change, reading.slope, reading.step
    return {
        "reading": series.name,
        "unit": series.unit,
        "warn_limit": series.warn,
        "error_limit": series.error,
        "values": [
            dict(zip(_POINT, point, strict=True))
            for point in zip(*(getattr(series, column).tolist() for column in _POINT.values()), strict=True)
        ],
        "change": change and change.as_dict(),
        "slope": slope and slope._asdict(),
        "step": step and step._asdict(),
    }


def rows(histories: Sequence[ReducerHistory]) -> Iterator[tuple[Any, ...]]:
    """Yield a row of `COLUMNS` for each value."""
    for history in histories:
        for entry in _reading_rows(history):
            yield (history.reducer.serial, history.joint, *entry)


def _reading_rows(history: ReducerHistory) -> Iterator[tuple[Any, ...]]:
    for reading in history.readings:
        series = reading.series
        for place in range(series.values.size):
            yield (
                float(series.times[place]),
                float(series.revolutions[place]),
                series.name,
                series.unit,
                float(series.values[place]),
                float(series.stds[place]),
                bool(series.is_baseline[place]),
                float(series.temperatures[place]),
            )


def as_csv(histories: Sequence[ReducerHistory]) -> str:
    """Write a row for each value as CSV with a header."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([COLUMNS, *rows(histories)])
    return text.getvalue()


def table(histories: Sequence[ReducerHistory]) -> str:
    """Write the state of every reducer in a line, and below it what changed."""
    lines = []
    for history in histories:
        verdict = history.verdict
        shown = f"{verdict.level.name}, {verdict.component.value}" if verdict else "no verdict"
        turns = sum(entry.revolutions for entry in history.entries)
        place = f", {history.joint}" if history.reducer.serial and history.joint else ""
        lines.append(f"{history.reducer}{place}: {shown} ({history.seen})")
        lines.append(f"  {len(history.entries)} entries over {turns:.0f} revolutions of the wave generator")
        lines += [f"  {reading.series.name}: {reading.newest}" for reading in history.readings]
        lines += [f"  {remark}" for remark in history.remarks]
    return "\n".join(lines)


def date(time: float) -> str:
    """Write a time [s since 1970] to the minute, in UTC."""
    return datetime.fromtimestamp(time, UTC).strftime("%Y-%m-%d %H:%M")


def _duration(interval: tuple[float, float]) -> str:
    low, high = interval
    size, unit = next(((size, unit) for size, unit in _DECADES if high >= 2.0 * size), _DECADES[-1])
    return f"{low / size:.2g} to {high / size:.2g} {unit}"

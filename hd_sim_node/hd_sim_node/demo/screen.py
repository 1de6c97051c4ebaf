"""What the demo shows: a small picture redrawn in place on a terminal, plain lines anywhere else."""

import os
import shutil
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TextIO

from hd_monitor.diagnosis.uncertain import with_std
from hd_monitor.diagnosis.verdict import Level

_COLOURS = {Level.OK: "\x1b[32m", Level.WARN: "\x1b[33m", Level.ERROR: "\x1b[31m"}
_PLAIN_STEP = 0.1  # of the programme, between two plain lines that say nothing new
_BAR = 30
_SPLINES = ("flexspline", "circular spline")


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A status as it came from the topic."""

    name: str
    level: Level
    message: str
    values: Mapping[str, str]

    def number(self, key: str) -> float | None:
        """Return the value of a key as a number; None if it is not one."""
        try:
            return float(self.values[key])
        except (KeyError, ValueError):
            return None

    @property
    def reading(self) -> str:
        """What is shown of a spline: its index, or its share where the sizes mean nothing."""
        return "share" if self.values.get("index kind") == "relative" else "index"

    def index(self, spline: str) -> str:
        """Write a spline's index, or share, with its standard deviation."""
        value, std = (self.number(f"{spline} {self.reading}{word} (%)") for word in ("", " std"))
        if value is None or std is None:
            return "unknown"
        return f"{with_std(value, std)} %"


class Screen:
    """Where progress and the evolving verdict are shown; `plain` asks for lines even on a terminal."""

    def __init__(self, out: TextIO, *, plain: bool = False) -> None:
        self._out = out
        self._redraws = out.isatty() and not plain and os.environ.get("TERM") != "dumb"
        self._coloured = self._redraws and "NO_COLOR" not in os.environ
        self._drawn = 0
        self._shown: tuple[str, str] | None = None
        self._next_line = 0.0
        unicode = (out.encoding or "").lower().startswith("utf")
        self._full, self._empty = ("█", "░") if unicode else ("#", ".")

    def line(self, text: str = "") -> None:
        """Print a line that stays."""
        self._clear()
        print(text, file=self._out, flush=True)

    def table(self, heading: str, rows: Mapping[str, str]) -> None:
        """Print named texts that stay, folded to the terminal's width."""
        self.line(heading)
        width = max(60, shutil.get_terminal_size((120, 24)).columns)
        for name, text in rows.items():
            self.line(textwrap.fill(text, width, initial_indent=f"  {name:18}", subsequent_indent=" " * 20))

    def update(self, view: View, progress: float) -> None:
        """Show a status; `progress` runs from 0 to 1."""
        progress = min(max(progress, 0.0), 1.0)
        if self._redraws:
            self._clear()
            lines = self._picture(view, progress)
            print("\n".join(lines), file=self._out, flush=True)
            self._drawn = len(lines)
            return
        component = view.values.get("component", "?")
        key = (component, view.level.name)
        if key != self._shown or progress >= self._next_line:
            self._next_line = progress + _PLAIN_STEP
            line = f"{progress:4.0%}  {self._speed(view)}  {view.level.name:5}  {component:15}  "
            indexes = [f"{spline} {view.index(spline)}" for spline in _SPLINES]
            if key != self._shown and component == "undetermined":
                indexes = [view.message]
            print(line + ", ".join(indexes), file=self._out, flush=True)
            self._shown = key

    def colour(self, level: Level) -> str:
        """Write a level's name in its colour, where there are colours."""
        return f"{_COLOURS[level]}{level.name}\x1b[0m" if self._coloured else level.name

    def _clear(self) -> None:
        if self._drawn:
            print(f"\x1b[{self._drawn}A\x1b[J", end="", file=self._out)
            self._drawn = 0

    @staticmethod
    def _speed(view: View) -> str:
        rpm = view.number("speed (rpm)")
        return "   - rpm" if rpm is None else f"{rpm:4.0f} rpm"

    def _bar(self, part: float) -> str:
        full = round(min(max(part, 0.0), 1.0) * _BAR)
        return self._full * full + self._empty * (_BAR - full)

    def _picture(self, view: View, progress: float) -> list[str]:
        width = max(40, shutil.get_terminal_size().columns) - 1
        warn, error = view.number("warn limit (%)"), view.number("error limit (%)")
        top = 2.0 * (error or 8.0)
        rms = view.number("rms (m/s^2)")
        lines = [
            f"  programme        {self._bar(progress)}  {progress:4.0%}   {self._speed(view)}"
            + ("" if rms is None else f"   rms {rms:.2f} m/s²")
        ]
        for spline in _SPLINES:
            index = view.number(f"{spline} {view.reading} (%)") or 0.0
            lines.append(f"  {spline:15}  {self._bar(index / top)}  {view.index(spline)}")
        if warn is not None and error is not None:
            # The mark of the lower limit has its label on the left, that of the higher one on the right.
            place = round(warn / top * _BAR)
            scale = f"warn {warn:.0f} % ^".rjust(place + 1)
            gap = round(error / top * _BAR) - len(scale)
            scale += " " * gap + f"^ error {error:.0f} %" if gap >= 0 else ""
            lines.append(f"  {'':15}  {scale}")
        lines = [line[:width] for line in lines]
        text = textwrap.wrap(view.message, width - 11)[:4] or [""]
        lines.append(f"  {self.colour(view.level)}{'':{6 - len(view.level.name)}} {text[0]}")
        lines += [f"         {more}" for more in text[1:]]
        return lines

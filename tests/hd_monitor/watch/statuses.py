"""Statuses as the pages of the contract describe them, and what stands on the screen."""

import asyncio
import html
import re
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import replace
from typing import Any

from hd_monitor.cdr import Diagnostics, ReceivedStatus
from hd_monitor.watch.app import WatchApp
from hd_monitor.watch.state import View

NODE = "/arm/hd_monitor_node"
SECOND = 1_000_000_000
_CHARACTER = 12.2  # width in the exported picture


def reducer(
    joint: str = "elbow",
    level: int = 0,
    component: str = "none",
    code: str = "HD_OK",
    reason: str = "Both splines are sound",
    **readings: tuple[float, float],
) -> ReceivedStatus:
    """Write a reducer's status; readings by ``flexspline_index`` and the like, each a value and its deviation."""
    values = {"joint": joint, "component": component, "cause": "none", "fault_code": code, "reason": reason}
    for name, (value, std) in readings.items():
        quantity = name.replace("_", " ")
        unit = "arcmin" if name.endswith("error") else "%"
        values |= {f"{quantity} ({unit})": f"{value:.3f}", f"{quantity} std ({unit})": f"{std:.3f}"}
    values |= {"warn limit (%)": "5.000", "error limit (%)": "8.000"}
    values |= {"warn limit (arcmin)": "1.500", "error limit (arcmin)": "3.000"}
    return ReceivedStatus(f"{NODE}: {joint} reducer", level, reason, f"SN-{joint}", values)


def inputs(
    joint: str = "elbow", level: int = 0, code: str = "HD_INPUT_OK", reason: str = "All inputs arrive"
) -> ReceivedStatus:
    """Write the status of a joint's inputs."""
    return ReceivedStatus(f"{NODE}: {joint} input", level, reason, "", {"joint": joint, "fault_code": code})


def sound(joint: str = "elbow") -> ReceivedStatus:
    return reducer(joint, flexspline_index=(1.5, 0.1), circular_spline_index=(2.1, 0.2))


def defective(joint: str = "elbow", level: int = 2, index: float = 10.3) -> ReceivedStatus:
    reason = "The flexspline is defective" if level == 2 else "The flexspline is suspect"
    readings = {"flexspline_index": (index, 0.4), "circular_spline_index": (1.5, 0.3)}
    return reducer(joint, level, "flexspline", "HD_FLEXSPLINE", reason, **readings)


def seen(*statuses: ReceivedStatus, at: int = 1, now: float = 0.0, view: View | None = None) -> View:
    """Show statuses of this second, heard at the time `now` [s]."""
    view = view or View(source="a test", awaiting="Start the node", live=True)
    return replace(view, now=now).with_diagnostics(Diagnostics(at * SECOND, statuses))


class Fixed:
    """A source that shows the views it was given, one a look, then the last one on."""

    pause = 1000.0

    def __init__(self, *views: View) -> None:
        self._views = list(views)

    def begin(self) -> View:
        return View(source="a test", awaiting="Start the node", live=True)

    def update(self, view: View, now: float) -> View:
        return self._views.pop(0) if self._views else view

    def close(self) -> None:
        pass


def use(app: WatchApp, act: Callable[[Any], Awaitable[None]], size: tuple[int, int] = (80, 24)) -> None:
    """Run an app without a terminal, and act on it by its pilot."""

    async def run() -> None:
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await act(pilot)

    asyncio.run(run())
    if app.failure is not None:
        raise app.failure


def screen_after(app: WatchApp, *keys: str, size: tuple[int, int] = (80, 24)) -> str:
    """What stands on the screen after these keys."""
    found: list[str] = []

    async def act(pilot: Any) -> None:
        await pilot.press(*keys)
        await pilot.pause()
        found.append(screen(app))

    use(app, act, size)
    return found[0]


def screen(app: WatchApp) -> str:
    """Read the letters of the screen off its picture."""
    rows: dict[int, list[tuple[int, str]]] = {}
    for x, row, text in re.findall(
        r'<text [^>]*\bx="([\d.]+)"[^>]*-line-(\d+)\)">([^<]*)</text>', app.export_screenshot()
    ):
        rows.setdefault(int(row), []).append((round(float(x) / _CHARACTER), html.unescape(text).replace("\xa0", " ")))
    return "\n".join(_joined(rows.get(row, [])) for row in range(max(rows, default=0) + 1))


def _joined(pieces: Sequence[tuple[int, str]]) -> str:
    line = ""
    for column, text in sorted(pieces):
        line = line.ljust(column) + text
    return line.rstrip()

import io
import re

import pytest

from hd_monitor.diagnosis.verdict import Level
from hd_sim_node.demo.screen import Screen, View


class Terminal(io.StringIO):
    encoding = "utf-8"

    def isatty(self) -> bool:
        return True


def view(
    component: str = "flexspline", level: Level = Level.ERROR, message: str = "The flexspline is defective"
) -> View:
    values = {
        "component": component,
        "speed (rpm)": "850.0",
        "rms (m/s^2)": "1.2345",
        "flexspline index (%)": "10.310",
        "flexspline index std (%)": "0.120",
        "circular spline index (%)": "1.500",
        "circular spline index std (%)": "0.001",
        "warn limit (%)": "5.000",
        "error limit (%)": "8.000",
    }
    return View(name="/n: joint reducer", level=level, message=message, values=values)


def test_plain_lines_come_on_news_and_every_tenth() -> None:
    out = io.StringIO()
    screen = Screen(out)
    for percent in range(101):
        screen.update(view("none", Level.OK) if percent < 55 else view(), percent / 100)
    lines = out.getvalue().splitlines()
    assert 10 <= len(lines) <= 13
    assert lines[0].startswith("  0%   850 rpm  OK     none")
    changed = next(line for line in lines if "ERROR" in line)
    assert changed.startswith(" 55%")
    assert "flexspline 10.31 ± 0.12 %, circular spline 1.5000 ± 0.0010 %" in changed
    assert "\x1b" not in out.getvalue()


def test_plain_lines_give_the_reason_of_an_undetermined_verdict() -> None:
    out = io.StringIO()
    Screen(out).update(view("undetermined", Level.WARN, "The joint has not turned enough yet"), 0.0)
    assert "The joint has not turned enough yet" in out.getvalue()


def test_relative_readings_are_shown_as_shares() -> None:
    values = {"index kind": "relative", "flexspline share (%)": "98.900", "flexspline share std (%)": "0.300"}
    shown = View(name="", level=Level.OK, message="", values=values)
    assert (shown.reading, shown.index("flexspline")) == ("share", "98.90 ± 0.30 %")


def test_unknown_numbers_are_shown_as_such() -> None:
    out = io.StringIO()
    empty = View(name="", level=Level.WARN, message="waiting", values={})
    Screen(out).update(empty, 0.0)
    assert "- rpm" in out.getvalue()
    assert empty.index("flexspline") == "unknown"


def screen_after(text: str) -> list[str]:
    """Apply what a terminal would: "up n lines, clear to the end"."""
    shown: list[str] = []
    for part in re.split(r"(\x1b\[\d+A\x1b\[J)", text):
        if match := re.fullmatch(r"\x1b\[(\d+)A\x1b\[J", part):
            del shown[len(shown) - int(match[1]) :]
        else:
            shown += part.splitlines()
    return shown


def test_a_terminal_shows_one_picture_that_is_redrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    out = Terminal()
    screen = Screen(out)
    screen.line("heading")
    for percent in (0, 50, 100):
        screen.update(view(), percent / 100)
    shown = screen_after(out.getvalue())
    assert shown[0] == "heading"
    assert sum("programme" in line for line in shown) == 1
    assert "100%" in shown[1]
    assert all(len(re.sub(r"\x1b\[\d+m", "", line)) < 100 for line in shown)
    assert "\x1b[31mERROR\x1b[0m" in out.getvalue()
    screen.line("the end")
    assert screen_after(out.getvalue()) == ["heading", "the end"]


def test_marks_of_the_limits_stand_below_their_places(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    out = Terminal()
    Screen(out).update(view(), 1.0)
    lines = out.getvalue().splitlines()
    bar = next(line for line in lines if line.startswith("  flexspline"))
    marks = next(line for line in lines if "warn 5 % ^" in line)
    start = bar.index("█")
    assert marks.index("^ error") - start == 15  # 8 % of the 16 % that the bar of 30 shows
    assert marks.index("^") - start == 9  # and 5 %
    assert bar[marks.index("^ error")] == "█"  # 10.31 % lies beyond it


def test_no_colour_where_it_is_not_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    assert Screen(Terminal()).colour(Level.ERROR) == "ERROR"


def test_plain_prints_lines_on_a_terminal_too() -> None:
    out = Terminal()
    Screen(out, plain=True).update(view(), 0.5)
    assert "\x1b" not in out.getvalue()

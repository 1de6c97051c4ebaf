"""The screen: a list of joints, all about the one selected, and a line of keys."""

import time
from typing import ClassVar

from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.events import Click
from textual.screen import ModalScreen
from textual.widgets import Static

from . import panels
from .lines import Line, cut, line, plain
from .source import Source
from .state import Joint, Key

_STYLES = {
    "ok": "green", "warn": "yellow", "error": "bold red", "quiet": "dim", "strong": "bold",
    "selected": "on grey30", "heading": "on grey19", "curve": "cyan",
}  # fmt: skip
_WIDE = 120
"""Columns from which the curves stand beside the answers instead of below them."""

_ROOM_FOR_LETTERS = 8
"""Columns that a line may grow by where letters stand for other signs."""

_KEYS = " up/down: joint   PgUp/PgDn: scroll   w: worst joint   ?: help   q: quit"
_HELP = """\
 up, down, click  select a joint; until then the worst one is shown
 w                show the worst one again, and follow it
 PgUp, PgDn       scroll what is said about it: reason and curves
 ?, Esc           open and close this help
 q                quit

 LEVEL     OK, WARN, ERROR as published; WAITING: no verdict yet;
           UNRATED: no limit applies; GONE: its node is silent for 5 s
 HOW BAD   the reading that decides, over its warn or error limit
 SINCE     how long the verdict has stood; >: longer than this view
 Bars      solid: at least so much; shaded: the 95 % interval;
           strokes: the limits"""


class Help(ModalScreen[None]):
    """What keys and signs mean."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,question_mark,q", "dismiss", "close")]

    def compose(self) -> ComposeResult:
        """Show the text."""
        yield Static(_HELP, id="help", markup=False)


class WatchApp(App[None]):
    """Shows what a source knows.

    Parameters
    ----------
    source : Source
    ascii_only : bool
        Whether the terminal has no other signs.

    Attributes
    ----------
    view : View
    failure : Exception or None
        What the source raised, which ended the app.
    """

    CSS = """
    #title { height: 1; background: $primary; color: $text; }
    #joints { height: auto; }
    #about { height: 1fr; scrollbar-size-vertical: 1; }
    #about Static { width: 100%; height: auto; }
    #about.wide { layout: horizontal; }
    #about.wide Static { width: 50%; }
    #keys { height: 1; dock: bottom; background: $panel; }
    Help { align: center middle; }
    #help { width: 74; height: auto; padding: 1; background: $panel; }
    """
    TITLE = "hd-monitor watch"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("q,ctrl+c", "quit", "quit", priority=True),
        Binding("question_mark", "help", "help"),
        Binding("w", "follow_worst", "worst joint"),
        Binding("down", "move(1)", "next joint"),
        Binding("up", "move(-1)", "joint before"),
        Binding("pagedown", "scroll(1)", "scroll"),
        Binding("pageup", "scroll(-1)", "scroll"),
    ]

    def __init__(self, source: Source, *, ascii_only: bool = False) -> None:
        super().__init__()
        self._source = source
        self._ascii_only = ascii_only
        self._chosen: Key | None = None  # by the user; None: follow the worst
        self._shown: dict[str, list[Line]] = {}
        self.view = source.begin()
        self.failure: Exception | None = None

    def compose(self) -> ComposeResult:
        """Lay the screen out."""
        yield Static(id="title")
        yield Static(id="joints")
        with VerticalScroll(id="about", can_focus=False):
            yield Static(id="answers")
            yield Static(id="curves")
        yield Static(id="keys")

    def on_mount(self) -> None:
        """Begin to look."""
        if self._ascii_only:  # its ends are drawn with other signs
            self.query_one("#about").styles.scrollbar_size_vertical = 0
        self.look()
        self.set_interval(self._source.pause, self.look)

    def on_resize(self) -> None:
        """Lay out for the new size."""
        self.query_one("#about").set_class(self.size.width >= _WIDE, "wide")
        self._draw()

    def look(self) -> None:
        """Take what is new from the source, and show it."""
        try:
            self.view = self._source.update(self.view, time.monotonic())
            self._draw()
        except Exception as error:  # whatever it is, the terminal must be given back before it is told
            self.failure = error
            self.exit()

    @property
    def selected(self) -> Joint | None:
        """The joint that is shown: the one chosen, or the worst; None while none is known."""
        if self._chosen is not None:
            return self.view.joints[self._chosen]
        return next(iter(self.view.ranked), None)

    def _draw(self) -> None:
        width = self.size.width
        self._show("title", [panels.title(self.view, width)])
        self._show("keys", [line(cut(_KEYS, width))])
        joint = self.selected
        if joint is None:
            self._show("answers", panels.waiting(self.view, width))
            return
        half = width // 2 if width >= _WIDE else width - 1
        half -= _ROOM_FOR_LETTERS if self._ascii_only else 0
        listing = panels.listing(self.view, joint, width, self._rows)
        self._show("joints", listing)
        self._show("answers", panels.detail(joint, self.view, half))
        self._show("curves", panels.curves(joint, half, self.size.height - 2 - len(listing)))

    @property
    def _rows(self) -> int:
        """Joints that the list shows: the answers have more than half of the screen."""
        return max(self.size.height * 2 // 5 - 2, 1)

    def _show(self, place: str, lines: list[Line]) -> None:
        if self._shown.get(place) == lines:
            return
        self._shown[place] = lines
        lines = [plain(row) for row in lines] if self._ascii_only else lines
        text = Text(no_wrap=True, overflow="crop")
        for number, row in enumerate(lines):
            text.append("\n" if number else "")
            for span in row:
                text.append(span.text, " ".join(_STYLES[role] for role in span.role.split()))
        self.query_one(f"#{place}", Static).update(text)

    # Keys and mouse -------------------------------------------------------------------------------------------------

    def action_move(self, steps: int) -> None:
        """Select the joint so many rows below."""
        if (selected := self.selected) is not None:
            ranked = self.view.ranked
            place = min(max(ranked.index(selected) + steps, 0), len(ranked) - 1)
            self._choose(ranked[place])

    def on_click(self, event: Click) -> None:
        """Select the joint in whose row the mouse is."""
        if event.widget is self.query_one("#joints") and self.selected is not None:
            place = panels.first_shown(self.view, self.selected, self._rows) + event.y - 1
            if event.y > 0 and place < len(self.view.ranked):
                self._choose(self.view.ranked[place])

    def _choose(self, joint: Joint) -> None:
        self._chosen = joint.key
        self.query_one("#about", VerticalScroll).scroll_home(animate=False)
        self._draw()

    def action_follow_worst(self) -> None:
        """Show the worst joint from now on."""
        self._chosen = None
        self._draw()

    def action_scroll(self, pages: int) -> None:
        """Scroll what is said about the joint."""
        about = self.query_one("#about", VerticalScroll)
        about.scroll_relative(y=pages * max(about.size.height - 1, 1), animate=False)

    def action_help(self) -> None:
        """Say what keys and signs mean."""
        self.push_screen(Help())

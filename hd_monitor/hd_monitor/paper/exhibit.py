"""The result of a figure's module: data to draw and claims to print. Nothing here knows how to draw."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from ..arrays import FloatArray

Style = Literal["line", "fine", "dashed", "points", "stems", "dotted points"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Curve:
    """One curve: x and y of equal shape (points,), NaN where it breaks."""

    x: FloatArray
    y: FloatArray
    label: str = ""
    style: Style = "line"


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A labelled place on the x axis, or a level on the y axis with its label at one place along it."""

    at: float
    label: str
    axis: Literal["x", "y"] = "x"
    place: Literal["left", "center", "right"] = "left"
    below: bool = False


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Surface:
    """Values over a grid, shape (y, x), drawn with the contour of 0."""

    x: FloatArray
    y: FloatArray
    values: FloatArray
    label: str


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Panel:
    """One pair of axes; labels carry the units."""

    title: str
    x_label: str
    y_label: str
    curves: tuple[Curve, ...] = ()
    marks: tuple[Mark, ...] = ()
    surface: Surface | None = None
    log_y: bool = False
    x_step: float | None = None
    """Distance of the ticks where round numbers do not suit, as with degrees."""
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    equal: bool = False
    """Whether the panel is drawn as a square, as a phase trace is."""


class Outcome(StrEnum):
    """Result of holding a claim against our number."""

    PASS = "pass"
    FAIL = "FAIL"
    CONTRADICTION = "paper contradicts itself"
    """The printed numbers exclude each other; ours confirms that, and the note names the convention chosen."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One statement of the paper, checked."""

    statement: str
    paper: str
    """The printed value, with its unit."""
    ours: str
    passed: bool
    """Whether ours agrees; for a contradiction, whether it confirms that the printed ones exclude each other."""
    note: str = ""
    """Why it differs, or which convention was chosen."""
    contradiction: bool = False
    """Whether the paper contradicts itself here."""

    @property
    def outcome(self) -> Outcome:
        """Pass, fail, or a contradiction within the paper that our numbers confirm."""
        if not self.passed:
            return Outcome.FAIL
        return Outcome.CONTRADICTION if self.contradiction else Outcome.PASS


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Exhibit:
    """A figure, table or equation of the paper, recomputed."""

    title: str
    """The paper's own caption in short."""
    caption: str
    """What is drawn and with which parameters."""
    panels: tuple[Panel, ...] = ()
    claims: tuple[Claim, ...] = ()
    facts: tuple[tuple[str, str], ...] = ()
    """Results to print that no claim is held against: (name, value with unit)."""

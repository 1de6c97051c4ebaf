"""The list of what is reproduced, and the loop that computes it."""

import time
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from ..errors import ParameterError
from . import (
    group_figures,
    line_figures,
    phase_figure,
    property_figures,
    reassembly_figures,
    rig_figures,
    stability_figure,
    stiffness_figures,
    sweep_figures,
    table_1,
)
from .cases import Cases
from .claim import Claim, Outcome
from .exhibit import Exhibit


class Entry(NamedTuple):
    """A figure, table or equation: its name, a few words, and the function that computes it."""

    id: str
    about: str
    compute: Callable[[Cases], Exhibit]


EXHIBITS = (
    Entry("F4", "stiffness over the wave-generator angle", stiffness_figures.figure_4),
    Entry("F7", "static stiffness every 30°", stiffness_figures.figure_7),
    Entry("T1", "Table 1 recovered from vibration", table_1.table_1),
    Entry("F8", "bi-spectra", line_figures.figure_8),
    Entry("E5", "distance of the two lines", line_figures.equation_5),
    Entry("F9", "combined harmonic groups", group_figures.figure_9),
    Entry("F10a", "sweep, single stiffness, ζ = 0.023", sweep_figures.figure_10a),
    Entry("F10b", "sweep, single stiffness, ζ = 0.027", sweep_figures.figure_10b),
    Entry("F11a", "sweep, double stiffness, ζ = 0.023", sweep_figures.figure_11a),
    Entry("F11b", "sweep, double stiffness, ζ = 0.027", sweep_figures.figure_11b),
    Entry("SR", "the sweep rate behind figures 10 and 11", sweep_figures.sweep_rates),
    Entry("F13a", "beat at 850 rpm", rig_figures.figure_13a),
    Entry("F13b", "spectrum at 850 rpm", rig_figures.figure_13b),
    Entry("F13c", "zoom spectrum at 850 rpm", rig_figures.figure_13c),
    Entry("F14", "combined group on the rig", group_figures.figure_14),
    Entry("F15", "spectrum at 1700 rpm", rig_figures.figure_15),
    Entry("F16", "property curve of the rig", property_figures.figure_16),
    Entry("F17", "phase trace at 850 rpm", phase_figure.figure_17),
    Entry("F18a", "property curve and verdict before", reassembly_figures.figure_18a),
    Entry("F18b", "property curve and verdict after", reassembly_figures.figure_18b),
    Entry("F19", "pitch errors before and after", reassembly_figures.figure_19),
    Entry("F20", "stiffness fluctuation before and after", reassembly_figures.figure_20),
    Entry("ST", "stability chart", stability_figure.stability),
)


def select[EntryLike: tuple[object, ...]](names: Iterable[str], entries: Sequence[EntryLike]) -> tuple[EntryLike, ...]:
    """Choose entries by name, whatever the case; ``F10`` means ``F10a`` and ``F10b``. No names choose all.

    Raises
    ------
    ParameterError
        If a name matches none; the message lists them all.
    """
    wanted = [name.strip().casefold() for given in names for name in given.split(",") if name.strip()]
    if not wanted:
        return tuple(entries)
    keys = [str(entry[0]).casefold() for entry in entries]
    for name in wanted:
        if not any(_matches(key, name) for key in keys):
            raise ParameterError(
                f"there is no figure {name!r}; choose from {', '.join(str(entry[0]) for entry in entries)}"
            )
    return tuple(entry for entry, key in zip(entries, keys, strict=True) if any(_matches(key, name) for name in wanted))


def _matches(key: str, name: str) -> bool:
    return key == name or (key[:-1] == name and key[-1:].isalpha() and name[-1:].isdigit())


def compute(
    entries: Iterable[tuple[str, str, Callable[[], Exhibit]]], progress: Callable[[str], None] = lambda line: None
) -> tuple[Exhibit, ...]:
    """Compute one exhibit after another and say so.

    Parameters
    ----------
    entries : iterable of (id, a few words, function)
    progress : callable
        Gets one line per exhibit when it is done.
    """
    listed = list(entries)
    done = []
    for number, (name, about, function) in enumerate(listed, start=1):
        start = time.perf_counter()
        exhibit = function()
        done.append(exhibit)
        failed = sum(claim.outcome is Outcome.FAIL for claim in exhibit.claims)
        state = f"{failed} of {len(exhibit.claims)} claims FAIL" if failed else "ok"
        progress(f"[{number:2d}/{len(listed)}] {name:5s} {about}: {state}, {time.perf_counter() - start:.1f} s")
    return tuple(done)


def reproduce(
    cases: Cases, only: Iterable[str] = (), progress: Callable[[str], None] = lambda line: None
) -> tuple[Exhibit, ...]:
    """Compute the paper's exhibits, all or some of them."""
    chosen = select(only, EXHIBITS)
    return compute(((entry.id, entry.about, _bound(entry, cases)) for entry in chosen), progress)


def _bound(entry: Entry, cases: Cases) -> Callable[[], Exhibit]:
    return lambda: entry.compute(cases)


def all_claims(exhibits: Iterable[Exhibit]) -> tuple[Claim, ...]:
    """Every claim of the exhibits, in their order."""
    return tuple(claim for exhibit in exhibits for claim in exhibit.claims)

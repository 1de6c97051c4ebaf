"""The lists of exhibits, of the paper and of a user's own reducer, and the loop that computes them."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

from ..errors import ParameterError
from . import (
    group_figures,
    line_figures,
    reassembly_figures,
    rig_figures,
    speed_figures,
    stiffness_figures,
    sweep_figures,
)
from .cases import Case, Cases
from .exhibit import Exhibit, Outcome


class Entry[Given](NamedTuple):
    """A figure, table or equation: its name, a few words, and the function that computes it from its input."""

    id: str
    about: str
    compute: Callable[[Given], Exhibit]


EXHIBITS: tuple[Entry[Cases], ...] = (
    Entry("F4", "stiffness over the wave-generator angle", stiffness_figures.figure_4),
    Entry("F7", "static stiffness every 30°", stiffness_figures.figure_7),
    Entry("T1", "Table 1 recovered from vibration", line_figures.table_1),
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
    Entry("F16", "property curve of the rig", speed_figures.figure_16),
    Entry("F17", "phase trace at 850 rpm", rig_figures.figure_17),
    Entry("F18a", "property curve and verdict before", reassembly_figures.figure_18a),
    Entry("F18b", "property curve and verdict after", reassembly_figures.figure_18b),
    Entry("F19", "pitch errors before and after", reassembly_figures.figure_19),
    Entry("F20", "stiffness fluctuation before and after", reassembly_figures.figure_20),
    Entry("ST", "stability chart", speed_figures.stability),
)


def _own_chart(case: Case) -> Exhibit:
    """Chart stability at 80 steps of the speeds, whatever their step: a property curve's is too coarse."""
    fine = case.speeds._replace(step=(case.speeds.stop - case.speeds.start) / 80.0)
    return speed_figures.stability_over_speed(replace(case, speeds=fine))


OWN_EXHIBITS: tuple[Entry[Case], ...] = (
    Entry("F4", "stiffness and characteristic numbers", stiffness_figures.stiffness_over_angle),
    Entry("F7", "static stiffness", stiffness_figures.static_stiffness),
    Entry("F8", "bi-spectra", line_figures.bispectra),
    Entry("F10", "sweep", sweep_figures.envelope),
    Entry("F13", "time history", rig_figures.time_history),
    Entry("F16", "property curve", speed_figures.vibration_over_speed),
    Entry("F17", "phase trace", rig_figures.phase_trace),
    Entry("ST", "stability chart", _own_chart),
)
"""What the paper draws, for one reducer and without claims."""


def select[Given](names: Iterable[str], entries: Sequence[Entry[Given]]) -> tuple[Entry[Given], ...]:
    """Choose entries by name, whatever the case; ``F10`` means ``F10a`` and ``F10b``. No names choose all.

    Raises
    ------
    ParameterError
        If a name matches none; the message lists them all.
    """
    wanted = [name.strip().casefold() for given in names for name in given.split(",") if name.strip()]
    for name in wanted:
        if not any(_matches(entry.id, name) for entry in entries):
            raise ParameterError(f"there is no figure {name!r}; choose from {', '.join(entry.id for entry in entries)}")
    return tuple(entry for entry in entries if not wanted or any(_matches(entry.id, name) for name in wanted))


def _matches(key: str, name: str) -> bool:
    key = key.casefold()
    return key == name or (key[:-1] == name and key[-1:].isalpha() and name[-1:].isdigit())


def compute[Given](
    entries: Sequence[Entry[Given]],
    given: Given,
    only: Iterable[str] = (),
    progress: Callable[[str], None] = lambda line: None,
) -> dict[str, Exhibit]:
    """Compute the exhibits chosen by `only` (see :func:`select`) one after another; return them by their names.

    `progress` gets one line per exhibit when it is done.
    """
    chosen = select(only, entries)
    done = {}
    for number, entry in enumerate(chosen, start=1):
        start = time.perf_counter()
        done[entry.id] = exhibit = entry.compute(given)
        failed = sum(claim.outcome is Outcome.FAIL for claim in exhibit.claims)
        state = f"{failed} of {len(exhibit.claims)} claims FAIL" if failed else "ok"
        seconds = time.perf_counter() - start
        progress(f"[{number:2d}/{len(chosen)}] {entry.id:5s} {entry.about}: {state}, {seconds:.1f} s")
    return done

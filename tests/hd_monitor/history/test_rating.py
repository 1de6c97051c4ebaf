import math
from dataclasses import replace

import numpy as np
import pytest
from tests.hd_monitor.history.entries import direction, entry

from hd_monitor.diagnosis.verdict import Cause, Component, FaultCode, Level, Verdict
from hd_monitor.history.entry import Kind
from hd_monitor.history.rating import Baseline, baseline_of, growth_of, rated
from hd_monitor.history.trend import Mean
from hd_monitor.identification.result import Identification
from hd_monitor.limitation import LimitationCode, blocker
from hd_monitor.reducer import LinePair
from hd_monitor.settings.groups import DiagnosisSettings

LIMITS = DiagnosisSettings()
LINES = {
    Component.CIRCULAR_SPLINE: Mean(value=2.0, std=0.02, widened=1.0),
    Component.FLEXSPLINE: Mean(value=1.0, std=0.02, widened=1.0),
}
BASE = Baseline(LINES)
NAMED = Verdict.naming(Component.CIRCULAR_SPLINE, Level.OK, "The circular spline dominates", Cause.RELATIVE)


def found(cs=2.0, fs=1.0, std=0.05, floor=1.0, travel=3.0, **more):
    own = {"std": LinePair(std, std), "floor": floor, "travel": travel}
    pieces = (replace(direction(name, (cs, fs)), **own) for name in ("forward", "reverse"))
    plain = Identification(
        circular_spline=np.zeros(1, dtype=complex),
        flexspline=np.zeros(1, dtype=complex),
        index=LinePair(0.9, 0.3),
        index_std=LinePair(0.01, 0.01),
        relative=True,
        evidence=tuple(pieces),
    )
    return replace(plain, **more)


def test_without_a_baseline_a_relative_verdict_is_unrated():
    assert (NAMED.level, NAMED.fault_code) == (Level.OK, FaultCode.UNRATED)
    assert rated(NAMED, found(), None, LIMITS) is NAMED


@pytest.mark.parametrize(
    ("cs", "fs", "component", "level", "code"),
    [
        (2.0, 1.0, Component.NONE, Level.OK, FaultCode.OK),
        (2.0, 1.5, Component.FLEXSPLINE, Level.WARN, FaultCode.FLEXSPLINE),
        (4.7, 1.2, Component.CIRCULAR_SPLINE, Level.ERROR, FaultCode.CIRCULAR_SPLINE),
        (3.0, 1.5, Component.BOTH, Level.WARN, FaultCode.BOTH_SPLINES),
        (1.0, 0.5, Component.NONE, Level.OK, FaultCode.OK),
    ],
)
def test_the_growth_of_the_lines_gives_part_and_level(cs, fs, component, level, code):
    verdict = rated(NAMED, found(cs, fs), BASE, LIMITS)
    assert (verdict.component, verdict.level, verdict.fault_code) == (component, level, code)
    assert verdict.cause is Cause.RELATIVE


def test_the_reason_says_how_much_and_how_surely():
    verdict = rated(NAMED, found(2.0, 1.5), BASE, LIMITS)
    assert verdict.reason == (
        "The flexspline's line has grown (circular spline +0.0 ± 2.0 %, flexspline +50.0 ± 4.1 % against the baseline, "
        "warn limit 30 %)"
    )
    assert "Neither spline's line has grown" in rated(NAMED, found(), BASE, LIMITS).reason


@pytest.mark.parametrize(
    ("cs", "fs", "said"),
    [
        (2.0, 1.25, "The flexspline's line has grown, by less than the warn limit ("),
        (2.4, 1.0, "The circular spline's line has grown, by less than the warn limit ("),
        (2.4, 1.25, "Both splines' lines have grown, by less than the warn limit ("),
        (2.0, 1.05, "Neither spline's line has grown ("),
    ],
)
def test_growth_below_the_limit_is_said_where_it_is_significant(cs, fs, said):
    verdict = rated(NAMED, found(cs, fs), BASE, LIMITS)
    assert (verdict.component, verdict.level, verdict.fault_code) == (Component.NONE, Level.OK, FaultCode.OK)
    assert verdict.reason.startswith(said)


def test_the_growth_is_known_as_a_number_where_it_is_rated():
    growth = growth_of(found(2.0, 1.5), BASE)
    assert growth[Component.FLEXSPLINE].value == pytest.approx(0.5)
    assert growth[Component.FLEXSPLINE].std == pytest.approx(math.hypot(0.05 / math.sqrt(2.0), 0.02))
    assert growth_of(found(relative=False), BASE) == growth_of(None, BASE) == growth_of(found(), None) == {}


def test_growth_within_the_repeatability_is_none():
    loose = Baseline(LINES | {Component.FLEXSPLINE: Mean(value=1.0, std=0.2, widened=5.0)})
    assert rated(NAMED, found(2.0, 1.4), loose, LIMITS) is NAMED  # neither grown nor surely not
    assert rated(NAMED, found(2.0, 1.4), BASE, LIMITS).level is Level.WARN


def test_the_baselines_own_motion_again_shows_growth_that_its_skirts_hide_from_another():
    again, other = (found(2.0, 1.5, std=0.4, floor=16.0, travel=travel) for travel in (3.0, 2.0))
    base = Baseline(LINES, again.evidence)
    assert rated(NAMED, again, base, LIMITS).component is Component.FLEXSPLINE
    assert rated(NAMED, other, base, LIMITS) is NAMED


def test_growth_of_next_to_nothing_is_related_to_the_larger_line():
    tiny = Baseline(LINES | {Component.FLEXSPLINE: Mean(value=0.01, std=0.02, widened=1.0)})
    assert rated(NAMED, found(2.0, 0.1), tiny, LIMITS).component is Component.NONE
    assert rated(NAMED, found(2.0, 0.6), tiny, LIMITS).component is Component.FLEXSPLINE


def test_growth_counts_where_only_the_larger_line_is_open():
    undetermined = Verdict.naming(Component.UNDETERMINED, Level.WARN, "…")
    open_lines = found(2.0, 1.5, limitations=(blocker(LimitationCode.LINES_TOO_SIMILAR),))
    for unnamed in (undetermined, Verdict.waiting("more motion may show it")):
        assert rated(unnamed, open_lines, BASE, LIMITS).component is Component.FLEXSPLINE
    wrong_teeth = found(2.0, 1.5, limitations=(blocker(LimitationCode.TEETH_AMBIGUOUS),))
    assert rated(undetermined, wrong_teeth, BASE, LIMITS) is undetermined


def test_absolute_and_waiting_verdicts_stay_as_they_are():
    absolute = Verdict.naming(Component.FLEXSPLINE, Level.ERROR, "…", Cause.STIFFNESS)
    assert rated(absolute, found(2.0, 1.5, relative=False), BASE, LIMITS) is absolute
    waiting = Verdict.waiting("motion is awaited")
    assert rated(waiting, found(2.0, 1.5), BASE, LIMITS) is waiting
    assert rated(waiting, None, BASE, LIMITS) is waiting


def test_a_baseline_is_complete_after_an_hour_or_once_it_is_set():
    entries = [entry(time=float(t), seconds=1200.0, lines=(3.0, 1.0)) for t in range(3)]
    assert baseline_of(entries) is None
    mark = replace(entry(time=3.0, kind=Kind.BASELINE), verdict=None)
    for whole in ([*entries, mark], [*entries, entry(time=4.0, lines=(3.0, 2.0), seconds=1200.0)]):
        base = baseline_of(whole)
        assert base is not None
        assert base.lines[Component.FLEXSPLINE].value == pytest.approx(1.0)
    assert baseline_of([]) is None


def test_a_baseline_of_one_motion_again_and_again_keeps_it():
    both = (direction(), direction("reverse"))
    entries = [entry(time=float(t), seconds=1200.0, evidence=both) for t in range(3)]
    mark = replace(entry(time=3.0, kind=Kind.BASELINE), verdict=None)
    differing = [entries[0], replace(entries[1], evidence=both[:1]), entries[2]]
    for moves, motion in ((entries, both), (differing, ())):
        base = baseline_of([*moves, mark])
        assert base is not None
        assert base.motion == motion

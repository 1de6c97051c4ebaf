import math
from dataclasses import replace

import numpy as np
import pytest
from tests.hd_monitor.history.entries import direction, entry

from hd_monitor.history.entry import Kind
from hd_monitor.history.series import series_of
from hd_monitor.reducer import LinePair


def named(entries):
    return {series.name: series for series in series_of(entries)}


def test_every_reading_is_a_series_with_its_limits():
    error = {"transmission_error": LinePair(0.5, 1.0), "transmission_error_std": LinePair(0.1, 0.1)}
    found = named([entry(time=t, index_limits=(0.05, 0.08), **error) for t in (1.0, 2.0)])
    assert set(found) == {
        "flexspline index",
        "circular spline index",
        "flexspline transmission error",
        "circular spline transmission error",
        "flexspline line 1",
        "circular spline line 1",
        "log of the ratio, flexspline over circular spline",
    }
    index = found["flexspline index"]
    assert index.values.tolist() == [0.06, 0.06]
    assert (index.warn, index.error) == (0.05, 0.08)
    assert index.times.tolist() == [1.0, 2.0]
    assert index.revolutions.tolist() == [2000.0, 4000.0]
    assert found["flexspline transmission error"].unit == "arcmin"
    assert found["log of the ratio, flexspline over circular spline"].values == pytest.approx([math.log(2.0)] * 2)


def test_relative_indexes_are_no_series_but_their_lines_are():
    names = set(named([entry(relative=True)]))
    assert not any("index" in name for name in names)
    assert "flexspline line 1" in names


def test_revolutions_of_transitions_count_but_their_values_do_not():
    found = named([entry(time=1.0), entry(time=2.0, kind=Kind.TRANSITION), entry(time=3.0)])["flexspline index"]
    assert found.times.tolist() == [1.0, 3.0]
    assert found.revolutions.tolist() == [2000.0, 6000.0]


def test_lines_of_another_signal_are_left_out():
    entries = [entry(time=1.0, source="joint_effort"), entry(time=2.0)]
    assert named(entries)["flexspline line 1"].times.tolist() == [2.0]


def test_lines_from_joint_states_are_those_of_the_entrys_own_motion():
    found = named([entry(lines=(9.0, 9.0), evidence=(direction(), direction("reverse", (5.0, 1.0))), relative=True)])
    assert found["circular spline line 1"].values == pytest.approx([4.0])
    assert found["circular spline line 1"].stds == pytest.approx([0.1 / math.sqrt(2.0)])


def test_skirts_do_not_count_where_the_baselines_motion_is_repeated():
    one = (replace(direction(), floor=9.0), replace(direction("reverse"), floor=9.0))
    other = tuple(replace(piece, speed=0.52) for piece in one)
    motions = [one, one, one, one, other]
    entries = [entry(time=float(t), seconds=1000.0, evidence=motion) for t, motion in enumerate(motions)]
    wide = 0.1 / math.sqrt(2.0)
    assert named(entries)["flexspline line 1"].stds == pytest.approx([wide / 3.0] * 4 + [wide])
    # Where the baseline's motions differ, or are too few to show how well they repeat
    assert named([entries[4], *entries[:3]])["flexspline line 1"].stds == pytest.approx([wide] * 4)
    assert named(entries[:2])["flexspline line 1"].stds == pytest.approx([wide] * 2)


def test_the_first_hour_of_motion_is_the_baseline():
    entries = [entry(time=float(t), seconds=1000.0) for t in range(6)]
    assert named(entries)["flexspline index"].is_baseline.tolist() == [True] * 3 + [False] * 3
    (long,) = [s for s in series_of([entry(seconds=9000.0), entry(time=2.0)]) if s.name == "flexspline index"]
    assert long.is_baseline.tolist() == [True, False]


def test_the_hour_of_motion_before_the_last_mark_is_the_baseline():
    entries = [entry(time=float(t), seconds=1500.0) for t in range(6)]
    entries.insert(1, entry(time=0.5, kind=Kind.BASELINE, verdict=None, lines=(0.0, 0.0)))
    entries.insert(5, entry(time=3.5, kind=Kind.BASELINE, verdict=None, lines=(0.0, 0.0)))
    assert named(entries)["flexspline index"].is_baseline.tolist() == [False, False, True, True, False, False]


def test_no_entries_no_series():
    assert series_of([]) == []
    assert series_of([entry(kind=Kind.TRANSITION)]) == []
    assert np.isfinite([s.values for s in series_of([entry(lines=(0.0, 1.0))])]).all()

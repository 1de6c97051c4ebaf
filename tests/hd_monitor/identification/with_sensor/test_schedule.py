"""Looks for other solutions: soon at first, ever more rarely where nothing helps, at once where a fit turns bad."""

import numpy as np

from hd_monitor.identification.with_sensor.schedule import POOR, SECOND_LOOK, Schedule


def looks(inflation_at, seconds=400.0, step=1.0):
    """Times [s] of all looks, for an inflation as a function of time."""
    schedule, times = Schedule(), []
    for now in np.arange(step, seconds, step):
        schedule = schedule.after(inflation_at(now), now)
        if schedule.is_due(inflation_at(now), now):
            schedule = schedule.with_look(now)
            times.append(float(now))
    return times


def test_a_good_fit_needs_no_look():
    assert looks(lambda now: 1.0) == []


def test_a_doubtful_first_multistart_is_repeated_once():
    times = looks(lambda now: 0.5 * (1.0 + POOR))
    assert len(times) == 1
    assert times[0] >= SECOND_LOOK


def test_looks_that_do_not_help_become_rarer():
    times = looks(lambda now: 10.0 * POOR)
    assert 2 <= len(times) <= 6
    assert times[1] <= 12.0
    gaps = np.diff(times)
    assert (gaps[1:] > gaps[:-1]).all()


def test_a_fit_that_turns_bad_late_is_soon_looked_at():
    times = looks(lambda now: 10.0 * POOR if now >= 200.0 else 1.0)
    assert 200.0 <= times[0] <= 205.0
    assert len([time for time in times if time < 230.0]) >= 2

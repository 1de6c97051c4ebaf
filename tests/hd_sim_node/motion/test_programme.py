"""Speed programmes: their angle is the exact integral of their speed, whatever the corners, cycles and ripple."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, trapezoid

from hd_monitor.errors import ParameterError
from hd_sim_node.motion.programme import RPM, Ripple, SpeedProgramme

SPEEDS = st.floats(-3000.0, 3000.0)


@st.composite
def programmes(draw, *, ripple=False):
    lengths = draw(st.lists(st.floats(0.05, 3.0), min_size=1, max_size=6))
    times = np.concatenate([[0.0], np.cumsum(lengths)])
    speeds = np.array(draw(st.lists(SPEEDS, min_size=times.size, max_size=times.size)))
    cycles = draw(st.integers(0, 3))
    if cycles != 1:
        speeds[-1] = speeds[0]
    shape = Ripple(draw(st.floats(0.0, 0.5)), draw(st.floats(0.1, 4.0)), draw(st.floats(-3.0, 3.0)))
    return SpeedProgramme(times=times, speeds=speeds, cycles=cycles, ripple=shape if ripple else Ripple())


@given(programmes(), st.floats(0.0, 1.0))
def test_angle_is_the_integral_of_the_speed(programme, fraction):
    """Between corners the speed is linear, so the trapezoid rule over the corners is exact."""
    span = programme.duration if math.isfinite(programme.duration) else 4.0 * programme.cycle_duration
    end = fraction * span
    corners = np.concatenate([n * programme.cycle_duration + programme.times for n in range(5)])
    grid = np.unique(np.append(corners[corners < end], [0.0, end]))
    integral = trapezoid(programme.speed(grid), grid)
    assert programme.angle(end) == pytest.approx(integral, rel=1e-9, abs=1e-6)


@given(programmes(ripple=True), st.floats(0.0, 1.0))
def test_speed_is_the_slope_of_the_angle_and_acceleration_that_of_the_speed(programme, fraction):
    t = fraction * programme.cycle_duration
    step = 1e-5
    if np.abs(programme.times - t).min() < 2 * step:
        return  # the acceleration jumps at a corner
    around = np.array([t - step, t + step])
    slope = np.diff(programme.angle(around))[0] / (2 * step)
    assert slope == pytest.approx(float(programme.speed(t)), rel=1e-5, abs=1e-3)
    bend = np.diff(programme.speed(around))[0] / (2 * step)
    assert bend == pytest.approx(float(programme.acceleration(t)), rel=1e-4, abs=0.5)


def test_angle_with_ripple_is_the_integral():
    programme = SpeedProgramme(
        times=[0.0, 1.0, 2.0], speeds=[100.0, 300.0, 300.0], cycles=1, ripple=Ripple(0.1, 2.0, 0.4)
    )
    integral, _ = quad(lambda t: float(programme.speed(t)), 0.0, 1.7, points=[1.0], limit=500, epsabs=1e-10)
    assert programme.angle(1.7) == pytest.approx(integral, abs=1e-8)


def test_ripple_of_order_zero_is_a_factor():
    programme = SpeedProgramme(times=[0.0, 1.0], speeds=[60.0, 60.0], ripple=Ripple(0.1, 0.0, 0.0))
    assert programme.angle(2.0) == pytest.approx(1.1 * 2.0 * math.tau)


@given(programmes(ripple=True))
def test_a_scalar_and_any_shape_give_the_same(programme):
    times = np.linspace(0.0, 2.5 * programme.cycle_duration, 12).reshape(3, 4)
    for quantity in (programme.angle, programme.speed, programme.acceleration):
        values = quantity(times)
        assert values.shape == (3, 4)
        assert values[1, 2] == quantity(times[1, 2])


@given(programmes())
def test_the_angle_has_no_jump_where_cycles_join(programme):
    fastest = np.abs(programme.speeds).max() * (1.0 + programme.ripple.amplitude)
    for n in (1, 2, 3):
        t = n * programme.cycle_duration
        before, after = programme.angle([t * (1 - 1e-9), t * (1 + 1e-9)])
        assert after - before == pytest.approx(0.0, abs=fastest * RPM * t * 1e-8 + 1e-9)


def test_cycles_repeat():
    programme = SpeedProgramme(times=[0.0, 1.0, 3.0], speeds=[0.0, 600.0, 0.0], cycles=0)
    assert programme.duration == math.inf
    one = programme.angle(3.0)
    assert one == pytest.approx(600.0 * RPM * 1.5)
    t = np.linspace(0.0, 3.0, 50)
    np.testing.assert_allclose(programme.angle(t + 6.0), programme.angle(t) + 2 * one, rtol=1e-12)


def test_a_finite_programme_holds_its_last_speed_behind_its_end():
    programme = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 60.0], cycles=1)
    assert programme.duration == 1.0
    assert programme.speed(1.5) == pytest.approx(math.tau)
    assert programme.angle(1.5) == pytest.approx(math.tau * (0.5 + 0.5))


def test_a_second_cycle_ends_the_programme():
    programme = SpeedProgramme(times=[0.0, 1.0, 2.0], speeds=[0.0, 60.0, 0.0], cycles=2)
    assert programme.duration == 4.0
    assert programme.angle(10.0) == pytest.approx(2 * math.tau)


def test_after_a_week_the_angle_is_still_exact():
    programme = SpeedProgramme(times=[0.0, 10.0], speeds=[3000.0, 3000.0])
    week = 7 * 86_400.0
    turned = programme.angle(week + 1.0) - programme.angle(week)
    assert turned == pytest.approx(50 * math.tau, abs=1e-6)


@given(programmes(), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_corners_are_where_the_pieces_meet(programme, begin, length):
    start, end = (part * programme.cycle_duration for part in (begin, begin + 2.0 * length))
    last = programme.cycles or math.inf
    expected = [
        n * programme.cycle_duration + t
        for n in range(4)
        if n < last
        for t in programme.times[0 if n == 0 else 1 :]
        if start + 1e-9 < n * programme.cycle_duration + t < end - 1e-9
    ]
    corners = programme.corners(start, end)
    inside = corners[(corners > start + 1e-9) & (corners < end - 1e-9)]
    np.testing.assert_allclose(np.unique(inside.round(9)), np.unique(np.round(expected, 9)), atol=1e-8)
    assert np.all((corners > start - 1e-9) & (corners <= end))


@given(programmes())
def test_within_a_stroke_the_sense_never_changes(programme):
    times = np.linspace(0.0, 2.0 * programme.cycle_duration, 1001)
    strokes = programme.strokes(times)
    senses = np.sign(programme.speed(times).round(12))  # at a turn the speed is 0 but for rounding
    assert np.all(np.diff(strokes) >= 0)
    for stroke in np.unique(strokes):
        assert not {-1.0, 1.0} <= set(senses[strokes == stroke])


def test_strokes_begin_where_the_drive_starts_or_turns():
    programme = SpeedProgramme(
        times=[0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 7.0], speeds=[0.0, 0.0, 60.0, 60.0, 0.0, -60.0, 0.0]
    )
    times = [0.0, 0.99, 1.0, 3.99, 4.0, 7.99, 8.0, 11.0, 15.0]
    assert programme.strokes(times).tolist() == [0, 0, 1, 1, 2, 2, 3, 4, 5]


def test_a_reversal_begins_a_stroke_at_standstill():
    programme = SpeedProgramme(times=[0.0, 4.0, 8.0], speeds=[100.0, -300.0, 100.0], cycles=2)
    assert programme.strokes([0.99, 1.01, 6.99, 7.01, 8.5, 9.01, 100.0]).tolist() == [0, 1, 1, 2, 2, 3, 4]


def test_a_programme_that_never_stops_has_no_strokes():
    programme = SpeedProgramme(times=[0.0, 1.0, 2.0], speeds=[100.0, 300.0, 100.0])
    assert not programme.strokes(np.linspace(0.0, 100.0, 50)).any()


def test_the_payload_passes_from_corner_to_corner_as_half_a_cosine_wave():
    programme = SpeedProgramme(times=[0.0, 2.0, 3.0, 5.0], speeds=[0.0] * 4, carried=[0.0, 1.0, 1.0, 0.0])
    times = np.array([0.0, 0.5, 1.0, 2.0, 2.5, 4.5, 5.5])
    expected = [0.0, 0.5 - 0.5**1.5, 0.5, 1.0, 1.0, 0.5 - 0.5**1.5, 0.5 - 0.5**1.5]
    np.testing.assert_allclose(programme.course(times).carried, expected, atol=1e-12)


def test_the_payload_stays_as_it_is_behind_the_end():
    programme = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 0.0], cycles=1, carried=[0.0, 0.5])
    assert programme.course(9.0).carried == 0.5


def test_visited_speeds_are_the_held_ones_and_a_grid_between():
    programme = SpeedProgramme(times=[0.0, 1.0, 2.0, 3.0], speeds=[210.0, 210.0, -290.0, -290.0], cycles=1)
    visited = programme.visited_speeds(spacing=100.0).tolist()
    assert visited == [0.0, 100.0, 200.0, 210.0, 290.0]


def test_visited_speeds_do_not_reach_below_the_slowest():
    programme = SpeedProgramme(times=[0.0, 1.0], speeds=[500.0, 620.0], cycles=1)
    assert programme.visited_speeds(spacing=50.0).tolist() == [500.0, 550.0, 600.0, 620.0]


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"times": [0.0], "speeds": [1.0]}, "at least two"),
        ({"speeds": [1.0, 2.0, 3.0]}, "2 times and 3 speeds"),
        ({"times": [0.0, 0.0]}, "do not rise"),
        ({"times": [1.0, 2.0]}, "do not rise from 0"),
        ({"times": [0.0, math.inf]}, "do not rise"),
        ({"speeds": [1.0, math.nan]}, "not all finite"),
        ({"cycles": -1}, "negative"),
        ({"cycles": 0}, "a drive cannot jump"),
        ({"cycles": 2}, "a drive cannot jump"),
        ({"carried": [0.0]}, "1 fractions of the payload for 2 corners"),
        ({"carried": [0.0, 1.5]}, "from 0 to 1.5; give one from 0 to 1"),
        ({"cycles": 0, "speeds": [1.0, 1.0], "carried": [0.0, 1.0]}, "ends with 1 of the payload"),
        ({"ripple": Ripple(1.0)}, "stop or reverse"),
        ({"ripple": Ripple(-0.1)}, "stop or reverse"),
        ({"ripple": Ripple(math.nan)}, "stop or reverse"),
    ],
)
def test_impossible_programmes_are_refused(changes, match):
    given_values = {"times": [0.0, 1.0], "speeds": [100.0, 200.0], "cycles": 1} | changes
    with pytest.raises(ParameterError, match=match):
        SpeedProgramme(**given_values)

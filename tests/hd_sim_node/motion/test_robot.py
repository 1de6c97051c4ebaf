"""The programmes of a robot's joint stay within their limits, come back to their start and carry what they promise."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import trapezoid

from hd_monitor.errors import ParameterError
from hd_monitor.reducer import Reducer
from hd_sim_node.motion.programmes import build_programme
from hd_sim_node.motion.robot import GRIP_TIME, ROBOT_PROGRAMMES
from hd_sim_node.settings import RigSettings

REDUCER = Reducer()


def build(name, *, cycles=0, seed=0, **values):
    return build_programme(
        name, {f"{name}.{key}": value for key, value in values.items()}, REDUCER, cycles=cycles, seed=seed
    )


def corner_angles(programme):
    """Output angles [deg] at the corners; between them the output goes no further if it rests at every turn."""
    return np.degrees(programme.angle(programme.times[:-1]) / REDUCER.reduction)


def slopes(programme):
    return np.abs(np.diff(programme.speeds) / np.diff(programme.times))


@st.composite
def robot_programmes(draw):
    """Any of them with limits drawn at random, and the output angles [deg] between which it has to stay."""
    name = draw(st.sampled_from(sorted(ROBOT_PROGRAMMES)))
    arc, speed = draw(st.floats(5.0, 180.0)), draw(st.floats(300.0, 4000.0))
    acceleration, pause = draw(st.floats(500.0, 20_000.0)), draw(st.floats(GRIP_TIME, 1.0))
    values, limits = {
        "pick_and_place": (
            {"angle": arc, "loaded_speed": 0.4 * speed, "empty_speed": speed, "pick_pause": pause},
            (0.0, arc),
        ),
        "short_strokes": (
            {"smallest": 0.2 * arc, "largest": arc, "travel": 2.0 * arc, "count": 25, "speed": speed, "pause": pause},
            (-arc, arc),
        ),
        "commissioning": (
            {"angle": arc, "first": 0.1 * speed, "last": speed, "step": 0.3 * speed, "pause": pause},
            (-arc, arc),
        ),
        "day": ({"hours": 0.5, "section": 2.0, "travel": 2.0 * arc, "speed": speed}, (-arc, arc)),
    }[name]
    programme = build(name, seed=draw(st.integers(0, 100)), acceleration=acceleration, **values)
    return programme, limits, speed, acceleration


@settings(max_examples=60)
@given(robot_programmes(), st.floats(0.0, 1.0))
def test_it_moves_within_its_limits_and_comes_back(drawn, fraction):
    programme, (lowest, highest), speed, acceleration = drawn
    angles = corner_angles(programme)
    assert angles.min() >= lowest - 1e-6
    assert angles.max() <= highest + 1e-6
    assert np.abs(programme.speeds).max() <= speed * (1.0 + 1e-12)
    assert slopes(programme).max() <= acceleration * (1.0 + 1e-3)  # times of a day are rounded to 1e-11 s
    assert (programme.speeds[0], programme.speeds[-1]) == (0.0, 0.0)
    assert programme.angle(programme.cycle_duration) == pytest.approx(0.0, abs=1e-6)
    # The angle is the integral of the speed, from any time to the end of the piece it lies in.
    t = fraction * programme.cycle_duration
    corners = programme.times[programme.times < t]
    grid = np.append(corners, t)
    assert programme.angle(t) == pytest.approx(trapezoid(programme.speed(grid), grid), abs=1e-6)


@pytest.mark.parametrize("name", ROBOT_PROGRAMMES)
def test_it_rests_before_each_stroke(name):
    """So that no stroke begins in a reversal, and each begins where strokes() counts it."""
    programme = build(name, **({"hours": 0.5} if name == "day" else {}))
    assert not np.any(programme.speeds[1:] * programme.speeds[:-1] < 0.0)
    starts = (programme.speeds[:-1] == 0.0) & (programme.speeds[1:] != 0.0)
    before, after = (programme.strokes(programme.times[:-1][starts] + shift) for shift in (-1e-6, 1e-6))
    np.testing.assert_array_equal(after, 1 + np.arange(starts.sum()))
    np.testing.assert_array_equal(before, after - 1)


def test_every_second_stroke_of_pick_and_place_carries_the_payload():
    programme = build("pick_and_place", angle=90.0, pick_pause=0.5, place_pause=0.4)
    times = np.linspace(0.0, 3.0 * programme.cycle_duration, 20_001)
    course = programme.course(times)
    moving = np.abs(course.speed) > 1e-9
    assert set(np.unique(course.carried[moving])) == {0.0, 1.0}
    assert np.all((course.carried == 1.0)[moving] == (course.speed > 0.0)[moving])
    assert set(programme.strokes(times[moving & (course.carried == 1.0)]) % 2) == {1}
    assert set(programme.strokes(times[moving & (course.carried == 0.0)]) % 2) == {0}


def test_the_payload_is_gripped_smoothly():
    programme = build("pick_and_place")
    t = np.linspace(0.0, GRIP_TIME, 11)
    expected = np.sin(0.5 * np.pi * t / GRIP_TIME) ** 2
    np.testing.assert_allclose(programme.course(t).carried, expected, atol=1e-12)
    place = programme.times[np.flatnonzero(np.diff(programme.carried) < 0.0)[0]]
    np.testing.assert_allclose(programme.course(place + t).carried, 1.0 - expected, atol=1e-9)
    assert np.all(programme.speed(np.concatenate([t, place + t])) == 0.0)


def test_pick_and_place_goes_and_returns_at_its_own_speeds():
    programme = build("pick_and_place", angle=360.0, loaded_speed=700.0, empty_speed=1500.0)
    assert (programme.speeds.max(), programme.speeds.min()) == (700.0, -1500.0)
    angles = corner_angles(programme)
    assert angles.max() == pytest.approx(360.0)
    assert angles.min() == pytest.approx(0.0, abs=1e-9)


def test_short_strokes_are_as_long_as_they_should_be():
    programme = build("short_strokes", smallest=20.0, largest=60.0, count=200, seed=3)
    rests = programme.speeds == 0.0
    angles = np.degrees(programme.angle(programme.times) / REDUCER.reduction)[rests]
    arcs = np.abs(np.diff(angles))
    arcs = arcs[arcs > 1e-6]
    assert arcs.size == 400
    assert programme.strokes(programme.cycle_duration) == 401  # the next cycle's first begins there
    assert 20.0 - 1e-6 <= arcs.min() < 25.0
    assert 55.0 < arcs.max() <= 60.0 + 1e-6


@pytest.mark.parametrize("name", ["short_strokes", "day"])
def test_random_programmes_follow_the_seed(name):
    values = {"hours": 0.5, "section": 2.0} if name == "day" else {}
    first, same, other = (build(name, seed=seed, **values) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.times, same.times)
    np.testing.assert_array_equal(first.speeds, same.speeds)
    assert first.speeds.tolist() != other.speeds.tolist()


def test_the_rig_gives_its_seed_to_the_programme():
    first, other = (
        RigSettings.from_mapping({"programme": "short_strokes", "seed": seed}).programme.times for seed in (1, 2)
    )
    assert first.tolist() != other.tolist()


def test_commissioning_passes_the_whole_range_both_ways_at_each_speed():
    programme = build("commissioning", angle=120.0, first=200.0, last=1000.0, step=200.0)
    middle = np.degrees(programme.angle(programme.times) / REDUCER.reduction)
    held = [
        (v, math.copysign(1.0, v) * (b - a))
        for v, w, a, b in zip(programme.speeds, programme.speeds[1:], middle, middle[1:], strict=False)
        if v == w != 0.0
    ]
    speeds = [v for v, _ in held]
    assert speeds == [-200.0, *(s * v for v in (200.0, 400.0, 600.0, 800.0, 1000.0) for s in (1.0, -1.0)), 200.0]
    peaks = [np.abs(v) for v in speeds[1:-1]]
    assert all(a <= b for a, b in pairwise(peaks))
    assert all(arc > 150.0 for _, arc in held[1:-1])


class TestDay:
    def test_lasts_as_long_as_given_and_mixes_the_work(self):
        programme = build("day")
        assert programme.cycle_duration == pytest.approx(86_400.0, abs=1e-6)
        course = programme.course(np.arange(0.0, 86_400.0, 0.5))
        speeds = np.abs(course.speed) * 60.0 / math.tau
        moving = speeds > 0.0
        assert 0.3 < moving.mean() < 0.95
        assert 0.05 < course.carried.mean() < 0.5
        assert np.mean((speeds > 50.0) & (speeds < 210.0)) > 0.02  # slow moves
        hours = moving.reshape(24, -1).mean(axis=1)
        assert np.ptp(hours) > 0.1

    def test_begins_with_work(self):
        assert build("day").strokes(60.0) > 5

    def test_works_to_the_end_however_short_its_sections(self):
        programme = build("day", hours=2.0, section=0.1)
        assert programme.strokes(7200.0 - 300.0) < programme.strokes(7200.0) - 1

    def test_holds_few_speeds_however_long_it_is(self):
        """Each is searched for instability at the start."""
        assert build("day", hours=240.0).visited_speeds().size < 150

    def test_takes_little_memory(self):
        assert build("day").times.size < 400_000

    def test_shorter_than_any_work_it_rests(self):
        programme = build("day", hours=0.01, travel=1e5, speed=1.0)
        assert not programme.speeds.any()
        assert programme.cycle_duration == pytest.approx(36.0)


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"smallest": 70.0}, "give the smaller one first"),
        ({"travel": 100.0}, r"up to 60 deg do not fit into a travel of 100 deg"),
    ],
)
def test_arcs_that_do_not_fit_are_refused(changes, match):
    with pytest.raises(ParameterError, match=match):
        build("short_strokes", **changes)

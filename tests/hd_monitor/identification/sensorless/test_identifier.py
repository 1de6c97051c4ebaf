import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.hd_monitor.identification.sensorless.runs import (
    identify,
    named,
    part,
    settings_of,
)

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.sensorless.identifier import SensorlessIdentifier
from hd_monitor.limitation import LimitationCode


def swinging(cs=0.3, fs=0.0, noise=0.1, seconds=60.0, rate=100.0, seed=1, teeth=(160, 162)):
    """A joint swinging with friction and gravity; 160/162 teeth unless other ones are given."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 1.0 / rate)
    angle = 1.4 * np.sin(0.55 * times) + 0.2 * np.sin(1.3 * times)
    speed = 0.77 * np.cos(0.55 * times) + 0.26 * np.cos(1.3 * times)
    effort = 4.0 * np.sin(angle) + 2.0 * np.tanh(speed / 0.02) + noise * rng.standard_normal(times.size)
    effort += cs * np.cos(teeth[0] * angle + 0.5) + fs * np.cos(teeth[1] * angle - 1.0)
    return JointSamples(times=times, angle=angle, speed=speed, effort=effort)


# Synthetic joints ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("cs", "fs", "component"),
    [
        (0.3, 0.1, Component.CIRCULAR_SPLINE),
        (0.1, 0.3, Component.FLEXSPLINE),
        (0.3, 0.3, Component.BOTH),
        (0.0, 0.0, Component.UNDETERMINED),
    ],
)
def test_names_the_larger_line(cs, fs, component):
    parameters = settings_of()
    identifier = identify(swinging(cs, fs), parameters)
    found = identifier.estimate()
    assert named(identifier, parameters) is component
    assert found.relative
    assert math.hypot(*found.index) == pytest.approx(1.0)
    if cs or fs:
        for amplitude, std, truth in zip(found.lines[0].amplitude, found.lines[0].std, (cs, fs), strict=True):
            assert amplitude == pytest.approx(truth, abs=4.0 * std)
            assert std < 0.02
        assert abs(np.abs(found.circular_spline[0]) - found.index.circular_spline) < 1e-12


def test_directions_are_reported_separately():
    whole = swinging()
    strong = whole.speed > 0.0
    whole.effort[strong] += 0.3 * np.cos(162 * whole.angle[strong])
    forward, reverse = identify(whole, settings_of()).directions
    assert (forward.name, reverse.name) == ("forward", "reverse")
    assert forward.chance.flexspline < 1e-9
    assert reverse.chance.flexspline > 1e-3
    assert forward.amplitude.flexspline == pytest.approx(0.3, abs=0.06)


def test_directions_that_contradict_each_other_leave_it_undetermined():
    whole, other = swinging(0.3, 0.1), swinging(0.1, 0.3)
    effort = np.where(whole.speed > 0.0, whole.effort, other.effort)
    mixed = JointSamples(times=whole.times, angle=whole.angle, speed=whole.speed, effort=effort)
    identifier = identify(mixed, settings_of())
    assert named(identifier, settings_of()) is Component.UNDETERMINED
    assert "do not agree on the larger line" in describe_limitation(identifier.estimate().blockers[0])


@settings(max_examples=10)
@given(st.lists(st.integers(0, 3000), max_size=10), st.integers(0, 2**16))
def test_the_result_does_not_depend_on_how_the_messages_are_chunked(cuts, seed):
    whole = swinging(seconds=30.0, seed=seed)
    expected = identify(whole, settings_of()).estimate()
    chunked = SensorlessIdentifier(settings_of())
    for chosen in np.split(np.arange(len(whole)), sorted(min(c, len(whole)) for c in cuts)):
        chunked.add(part(whole, chosen))
        chunked.estimate()
    found = chunked.estimate()
    assert found is not None
    assert expected is not None
    assert found.index == expected.index
    assert found.blockers == expected.blockers
    assert chunked.directions == identify(whole, settings_of()).directions


@settings(max_examples=10)
@given(st.floats(1e-4, 1e4), st.sampled_from([1.0, -1.0]), st.integers(-3, 3))
def test_units_signs_and_whole_turns_do_not_matter(unit, sign, turns):
    whole = swinging(0.3, 0.15, seconds=40.0)
    other = JointSamples(
        times=whole.times + 1e4,
        angle=sign * whole.angle + math.tau * turns,
        speed=sign * whole.speed,
        effort=sign * unit * whole.effort,
    )
    one, two = identify(whole, settings_of()), identify(other, settings_of())
    assert two.estimate().index == pytest.approx(one.estimate().index, rel=1e-5)
    sides = two.directions if sign > 0.0 else two.directions[::-1]
    for mine, its in zip(one.directions, sides, strict=True):
        assert its.amplitude == pytest.approx([unit * a for a in mine.amplitude], rel=1e-5)
        assert its.dominance == pytest.approx(mine.dominance, abs=1e-6)


def test_stamps_hardly_matter():
    whole = swinging(0.3, 0.15)
    rng = np.random.default_rng(3)
    late = JointSamples(
        times=np.maximum.accumulate(np.floor(1e3 * (whole.times + 0.004 * rng.random(len(whole)))) / 1e3),
        angle=whole.angle,
        speed=whole.speed,
        effort=whole.effort,
    )
    one, two = identify(whole, settings_of()).estimate(), identify(late, settings_of()).estimate()
    assert two.index == pytest.approx(one.index, abs=0.03)


@pytest.mark.parametrize("mount", ["circular_spline_fixed", "flexspline_fixed"])
@pytest.mark.parametrize(("cs", "fs"), [(0.3, 0.1), (0.1, 0.3)])
def test_both_mounts_and_the_motor_is_mentioned_where_it_shares_the_line(mount, cs, fs):
    parameters = settings_of(reducer__mount=mount)
    identifier = identify(swinging(cs, fs), parameters)
    assert named(identifier, parameters) is (Component.CIRCULAR_SPLINE if cs > fs else Component.FLEXSPLINE)
    shared = (mount == "circular_spline_fixed") == (cs > fs)
    assert any("check the motor" in describe_limitation(doubt) for doubt in identifier.estimate().doubts) is shared


def test_one_direction_is_split_in_time():
    times = np.arange(0.0, 90.0, 0.01)
    speed = 0.6 + 0.2 * np.sin(0.2 * times)
    angle = 0.6 * times - 1.0 * np.cos(0.2 * times)
    effort = 0.2 * np.cos(160 * angle) + 0.1 * np.random.default_rng(1).standard_normal(times.size)
    identifier = identify(JointSamples(times=times, angle=angle, speed=speed, effort=effort), settings_of())
    assert [side.name for side in identifier.directions] == ["forward, first half", "forward, second half"]
    assert named(identifier, settings_of()) is Component.CIRCULAR_SPLINE


def test_a_single_speed_is_doubted():
    times = np.arange(0.0, 60.0, 0.01)
    angle = 0.5 * times
    effort = 0.2 * np.cos(160 * angle) + 0.1 * np.random.default_rng(1).standard_normal(times.size)
    samples = JointSamples(times=times, angle=angle, speed=np.full(times.size, 0.5), effort=effort)
    steady, varied = (identify(motion, settings_of()).estimate() for motion in (samples, swinging()))
    assert any("one speed" in describe_limitation(doubt) for doubt in steady.doubts)
    assert not any("one speed" in describe_limitation(doubt) for doubt in varied.doubts)


def test_velocity_as_the_signal():
    whole = swinging(0.0, 0.0)
    speed = (
        whole.speed + 0.004 * np.cos(162 * whole.angle) + 0.002 * np.random.default_rng(2).standard_normal(len(whole))
    )
    samples = JointSamples(times=whole.times, angle=whole.angle, speed=speed, effort=np.full(len(whole), np.nan))
    parameters = settings_of(input__source="joint_velocity")
    identifier = identify(samples, parameters)
    assert named(identifier, parameters) is Component.FLEXSPLINE
    assert identifier.estimate().lines[0].amplitude.flexspline == pytest.approx(0.004, rel=0.1)


def test_higher_pairs_are_reported():
    whole = swinging(0.3, 0.1, rate=250.0)
    whole.effort[:] += 0.2 * np.cos(324 * whole.angle)
    lines = {line.k: line for line in identify(whole, settings_of()).estimate().lines}
    assert lines[2].amplitude.flexspline == pytest.approx(0.2, abs=0.03)
    assert lines[2].amplitude.circular_spline < 4.0 * lines[2].std.circular_spline


def test_old_evidence_fades_after_a_repair():
    before, after = swinging(0.3, 0.1, seconds=80.0), swinging(0.1, 0.3, seconds=80.0, seed=2)
    identifier = SensorlessIdentifier(settings_of(analysis__memory=60.0))
    identifier.add(before)
    assert named(identifier, settings_of()) is Component.CIRCULAR_SPLINE
    identifier.add(JointSamples(times=after.times + 80.0, angle=after.angle, speed=after.speed, effort=after.effort))
    assert named(identifier, settings_of()) is Component.FLEXSPLINE


def later(samples, seconds):
    return JointSamples(times=samples.times + seconds, angle=samples.angle, speed=samples.speed, effort=samples.effort)


def test_weak_recordings_add_up_as_evidence_though_their_phases_differ():
    def recording(seed):
        return swinging(0.025, 0.0, noise=0.25, seconds=40.0, seed=seed)

    parameters = settings_of(analysis__memory=3600.0)
    alone = [named(identify(recording(seed), parameters), parameters) for seed in range(12)]
    identifier = SensorlessIdentifier(parameters)
    for seed in range(12):
        identifier.add(later(recording(seed), 100.0 * seed))
        identifier.cut()
    assert named(identifier, parameters) is Component.CIRCULAR_SPLINE
    assert alone.count(Component.UNDETERMINED) >= 6
    assert Component.FLEXSPLINE not in alone


def test_a_long_run_is_kept_as_evidence_once_it_is_older_than_what_adds_up_coherently():
    parameters = settings_of(analysis__memory=3600.0)
    identifier = identify(swinging(seconds=400.0), parameters)
    assert named(identifier, parameters) is Component.CIRCULAR_SPLINE
    assert sum(side.seconds for side in identifier.directions) == pytest.approx(360.0, abs=40.0)
    forgetful = identify(swinging(seconds=400.0), settings_of(analysis__memory=60.0))
    assert sum(side.seconds for side in forgetful.directions) < 80.0


# What cannot be known -------------------------------------------------------------------------------------------------


def test_says_nothing_before_anything_came():
    identifier = SensorlessIdentifier(settings_of())
    assert identifier.estimate() is None
    assert identifier.directions == ()
    identifier.add(part(swinging(), slice(0, 20)))
    assert identifier.estimate() is None


def test_one_stroke_is_not_enough():
    found = identify(part(swinging(), slice(0, 500)), settings_of()).estimate()
    assert "One stroke only" in describe_limitation(found.blockers[0])


def test_a_missing_field_is_named_with_its_remedy():
    whole = swinging()
    blind = JointSamples(times=whole.times, angle=whole.angle, speed=whole.speed, effort=np.full(len(whole), np.nan))
    (reason,) = map(describe_limitation, identify(blind, settings_of()).estimate().blockers)
    assert "no effort" in reason
    assert "joint_velocity" in reason


def test_a_constant_signal_is_named():
    whole = swinging()
    dead = JointSamples(times=whole.times, angle=whole.angle, speed=whole.speed, effort=np.zeros(len(whole)))
    assert "does not change at all" in describe_limitation(identify(dead, settings_of()).estimate().blockers[0])


def test_no_signal_yet_is_not_a_constant_one():
    parameters = settings_of()
    identifier = identify(part(swinging(), slice(0, 20)), parameters)
    identifier.change(parameters)  # which asks for the result anew
    assert identifier.estimate() is None


def test_too_fast_for_the_rate_is_named():
    times = np.arange(0.0, 30.0, 0.01)
    samples = JointSamples(times=times, angle=3.0 * times, speed=np.full(times.size, 3.0), effort=np.sin(times))
    (reason,) = map(describe_limitation, identify(samples, settings_of()).estimate().blockers)
    assert "too fast" in reason


def test_a_standing_joint_has_no_result():
    times = np.arange(0.0, 30.0, 0.01)
    noise = 1e-5 * np.random.default_rng(1).standard_normal(times.size)
    samples = JointSamples(times=times, angle=noise, speed=100.0 * noise, effort=noise)
    assert identify(samples, settings_of()).estimate() is None


def test_wrong_teeth_are_noticed():
    identifier = identify(
        swinging(0.5, 0.2, teeth=(160, 162)),
        settings_of(reducer__flexspline_teeth=150, reducer__circular_spline_teeth=152),
    )
    assert any(
        "check reducer.flexspline_teeth" in text for text in map(describe_limitation, identifier.estimate().blockers)
    )


@pytest.mark.parametrize("given", [198, 199, 201, 202])
def test_teeth_near_the_right_ones_name_no_part(given):
    rng = np.random.default_rng(4)
    times = np.arange(0.0, 60.0, 0.01)
    angle = 1.6 * np.sin(0.5 * times)
    effort = 5.0 * np.sin(angle) + 0.3 * np.cos(200 * angle) + 0.15 * np.cos(202 * angle + 1.0)
    effort += 0.1 * rng.standard_normal(times.size)
    samples = JointSamples(times=times, angle=angle, speed=0.8 * np.cos(0.5 * times), effort=effort)
    wrong = settings_of(reducer__flexspline_teeth=given, reducer__circular_spline_teeth=given + 2)
    (first, *_) = map(describe_limitation, identify(samples, wrong).estimate().blockers)
    assert "200/202 teeth" in first
    right = settings_of(reducer__flexspline_teeth=200, reducer__circular_spline_teeth=202)
    assert identify(samples, right).estimate().blockers == ()


def test_a_real_line_of_few_teeth_is_not_taken_for_the_motors():
    whole = swinging(0.3, 0.0, teeth=(100, 102), rate=200.0)
    whole.effort[:] += 0.2 * np.cos(200 * whole.angle)
    parameters = settings_of(reducer__flexspline_teeth=100, reducer__circular_spline_teeth=102)
    identifier = identify(whole, parameters)
    assert named(identifier, parameters) is Component.CIRCULAR_SPLINE
    whole.effort[:] += 0.2 * np.cos(202 * whole.angle)  # a line that 100/102 teeth cannot make
    (reason,) = identify(whole, parameters).estimate().blockers
    assert reason.code is LimitationCode.MOTOR_LINE
    assert reason.values["other"] == "200/202"

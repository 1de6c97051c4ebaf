import math

import numpy as np
import pytest

from hd_monitor.acquisition.record import JointSamples, Record
from hd_monitor.identification.teeth.candidates import ToothPair, every_pair
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque
from hd_monitor.model.simulation import linear_sweep, simulate
from hd_monitor.offline.identify_teeth import rank_tooth_pairs
from hd_monitor.orders.joint_segment import samples_of_records
from hd_monitor.reducer import Reducer


def swinging(lines, noise=0.1, seconds=60.0, seed=1, span=1.4):
    """A joint swinging with friction and gravity and lines {order: amplitude}."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 0.01)
    angle = span * np.sin(0.55 * times) + 0.2 * np.sin(1.3 * times)
    speed = span * 0.55 * np.cos(0.55 * times) + 0.26 * np.cos(1.3 * times)
    effort = 4.0 * np.sin(angle) + 2.0 * np.tanh(speed / 0.02) + noise * rng.standard_normal(times.size)
    for order, amplitude in lines.items():
        effort += amplitude * np.cos(order * angle + order)
    return JointSamples(times=times, angle=angle, speed=speed, effort=effort)


@pytest.mark.parametrize("teeth", [(100, 102), (160, 162), (161, 163), (200, 202), (240, 242)])
def test_two_lines_determine_the_teeth_among_all_pairs(teeth):
    ranking = rank_tooth_pairs(swinging(dict.fromkeys(teeth, 0.2)))
    assert ranking.ranked[0].teeth == ToothPair(*teeth)
    assert ranking.conclusive
    assert ranking.margin > math.log(1000.0)
    assert f"{teeth[0]}/{teeth[1]} teeth fit best, by odds of" in ranking.statement
    assert "mount" in ranking.statement
    assert len(ranking.ranked) == len(every_pair())
    evidence = [found.log_evidence for found in ranking.ranked]
    assert evidence == sorted(evidence, reverse=True)


def test_one_line_alone_is_not_conclusive():
    ranking = rank_tooth_pairs(swinging({200: 0.3}))
    assert {found.teeth for found in ranking.ranked[:3]} >= {(198, 200), (200, 202)}
    assert not ranking.conclusive
    assert "not conclusive" in ranking.statement


def test_a_strong_line_with_a_companion_lost_in_noise_is_not_conclusive():
    ranking = rank_tooth_pairs(swinging({200: 0.5, 202: 0.002}))
    assert ranking.ranked[0].lines_found < 2
    assert not ranking.conclusive


def test_noise_alone_is_not_conclusive():
    for seed in range(4):
        ranking = rank_tooth_pairs(swinging({}, seed=seed))
        assert not ranking.conclusive
        assert ranking.ranked[0].lines_found == 0
        assert "stand out of the noise" in ranking.statement


def test_little_travel_is_not_conclusive():
    ranking = rank_tooth_pairs(swinging({200: 0.1, 202: 0.1}, span=0.1))
    assert math.degrees(ranking.travel) < 40.0
    assert not ranking.conclusive


def test_one_speed_is_not_conclusive_because_any_fixed_frequency_would_fit():
    times = np.arange(0.0, 60.0, 0.01)
    angle = 0.5 * times
    effort = 0.3 * np.cos(160 * angle) + 0.3 * np.cos(162 * angle)
    effort += 0.1 * np.random.default_rng(1).standard_normal(times.size)
    ranking = rank_tooth_pairs(JointSamples(times=times, angle=angle, speed=np.full(times.size, 0.5), effort=effort))
    assert ranking.ranked[0].teeth == ToothPair(160, 162)
    assert not ranking.conclusive
    assert "vary the speed" in ranking.statement


def test_an_encoder_s_orders_are_not_taken_for_teeth():
    ranking = rank_tooth_pairs(swinging({255: 0.2, 257: 0.2}))
    assert ranking.ranked[0].teeth == ToothPair(255, 257)
    assert not ranking.conclusive
    assert "encoder" in ranking.statement


def test_multiples_belong_to_their_pair():
    """The second pair's lines at 240 and 244 do not suggest 240/242 teeth, nor does the motor's at 60 suggest 60/62."""
    ranking = rank_tooth_pairs(swinging({60: 0.4, 120: 0.15, 122: 0.15, 240: 0.3, 244: 0.3}))
    assert ranking.ranked[0].teeth == ToothPair(120, 122)
    assert ranking.conclusive


def test_velocity_can_be_the_signal():
    whole = swinging({})
    speed = whole.speed + 0.003 * (np.cos(160 * whole.angle) + np.cos(162 * whole.angle))
    speed += 0.002 * np.random.default_rng(1).standard_normal(speed.size)
    samples = JointSamples(times=whole.times, angle=whole.angle, speed=speed, effort=np.full(speed.size, np.nan))
    ranking = rank_tooth_pairs(samples, source="joint_velocity")
    assert ranking.ranked[0].teeth == ToothPair(160, 162)
    assert ranking.conclusive
    assert "No motion in which lines could show" in rank_tooth_pairs(samples).statement


def accelerations(teeth, from_hz, rate_hz, seconds, noise=0.05):
    """Records of the rig on a slow run-up, a second each, with both splines worn."""
    reducer = Reducer(flexspline_teeth=teeth[0], circular_spline_teeth=teeth[1])
    model = ParametricModel(
        reducer=reducer,
        dynamics=Dynamics(),
        circular_spline=StiffnessSeries((0.04, 0.02), (0.3, 1.0)),
        flexspline=StiffnessSeries((0.05, 0.02), (0.0, 2.0)),
        torque=Torque(mean=10.0),
    )
    motion = linear_sweep(reducer, from_hz, rate_hz)
    response = simulate(model, motion, duration=seconds, rate=1000.0)
    rng = np.random.default_rng(1)
    values = response.acceleration + noise * rng.standard_normal(response.times.size)
    speed = np.gradient(response.output_angle, response.times)
    return [
        Record(
            start=float(second),
            period=0.001,
            acceleration=values[part],
            angle=response.output_angle[part],
            speed=speed[part],
            torque=np.full(1000, np.nan),
            continues=second > 0,
        )
        for second in range(int(seconds))
        for part in [slice(1000 * second, 1000 * second + 1000)]
    ]


@pytest.mark.parametrize("teeth", [(160, 162), (120, 122)])
def test_accelerations_determine_the_teeth_too(teeth):
    ranking = rank_tooth_pairs(samples_of_records(accelerations(teeth, 6.0, 0.4, 40.0)))
    assert ranking.ranked[0].teeth == ToothPair(*teeth)
    assert ranking.conclusive


@pytest.mark.shared_data
@pytest.mark.parametrize("joint", [4, 5, 6])
def test_a_real_arm_s_teeth_come_out_where_both_lines_show(ur10e, joint):
    ranking = rank_tooth_pairs(ur10e("ur-20_02_12-50sec_12harm", joint))
    assert ranking.ranked[0].teeth == ToothPair(200, 202)
    assert ranking.conclusive


@pytest.mark.shared_data
@pytest.mark.slow
@pytest.mark.parametrize("source", ["joint_effort", "joint_velocity"])
def test_a_real_arm_s_teeth_never_come_out_wrong(ur10e, source):
    joints = [("ur-20_01_22-joint_1", 1), ("ur-20_01_22-joint_5", 5)]
    joints += [(f"ur-20_02_{run}", joint) for run in ("06-20sec_10harm", "12-50sec_12harm") for joint in range(1, 7)]
    for file, joint in joints:
        ranking = rank_tooth_pairs(ur10e(file, joint), source=source)
        assert not ranking.conclusive or ranking.ranked[0].teeth == ToothPair(200, 202)


def test_a_tone_beside_one_line_of_a_listed_pair_makes_no_other_pair():
    ranking = rank_tooth_pairs(swinging({162: 0.2, 164: 0.2}))
    assert ranking.ranked[0].teeth == ToothPair(162, 164)
    assert not ranking.conclusive
    assert "catalogues list 160/162" in ranking.statement


def test_the_second_group_of_lines_makes_no_pair_of_its_own():
    ranking = rank_tooth_pairs(swinging({120: 0.05, 122: 0.05, 240: 0.3, 242: 0.3}))
    assert ranking.ranked[0].teeth == ToothPair(240, 242)
    assert not ranking.conclusive
    assert "second group of 120/122" in ranking.statement

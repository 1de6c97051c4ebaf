"""A health-check move keeps the joint's limits and carries the lines where they tell most."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
import yaml

from hd_monitor.cli.main import main
from hd_monitor.errors import ParameterError
from hd_monitor.offline.move import MoveLimits, plan_move, top_speeds
from hd_monitor.settings import JointSettings


def limits_of(lower=-1.5, upper=1.5, speed=3.0, acceleration=8.0):
    return MoveLimits(lower=lower, upper=upper, speed=speed, acceleration=acceleration)


@pytest.mark.parametrize("source", ["block", "joint_effort"])
@pytest.mark.parametrize("limits", [limits_of(), limits_of(upper=0.0, acceleration=1.0), limits_of(-6.0, 6.0)])
def test_the_limits_are_kept_and_the_time_is_filled(source, limits):
    settings = JointSettings.from_mapping({"input.source": source, "input.expected_rate": 500.0})
    move = plan_move(settings, limits, 60.0)
    assert move.times[0] == 0.0
    assert move.times[-1] == pytest.approx(60.0)
    steps, change = np.diff(move.times), np.diff(move.velocities)
    assert (steps > 0.0).all()
    assert move.positions.min() >= limits.lower - 1e-9
    assert move.positions.max() <= limits.upper + 1e-9
    assert np.abs(move.velocities).max() <= limits.speed + 1e-9
    assert np.abs(change / steps).max() <= limits.acceleration + 1e-9
    assert move.positions[-1] == pytest.approx(move.positions[0])
    assert move.velocities[0] == move.velocities[-1] == 0.0
    # What a controller interpolates between the corners is what was planned: constant acceleration
    middle = 0.5 * (move.velocities[1:] + move.velocities[:-1])
    assert np.diff(move.positions) == pytest.approx(middle * steps)


def test_both_directions_have_the_same_speeds_and_these_differ():
    move = plan_move(JointSettings.from_mapping(), limits_of(), 60.0)
    tops = {sign: {round(v, 6) for v in sign * move.velocities if v > 0.0} for sign in (1.0, -1.0)}
    assert tops[1.0] == tops[-1.0]
    assert len(tops[1.0]) >= 3


@pytest.mark.parametrize("limits", [limits_of(), limits_of(upper=0.0), limits_of(-3.0, 3.0)])
def test_the_strokes_rise_from_the_slowest_and_come_down_again(limits):
    move = plan_move(JointSettings.from_mapping(), limits, 60.0)
    tops = [top for top, _ in itertools.groupby(np.abs(move.velocities).round(6)) if top > 0.0]
    fastest = tops.index(max(tops))
    assert 0 < fastest < len(tops) - 1
    assert tops == sorted(tops[:fastest]) + sorted(tops[fastest:], reverse=True)
    assert tops[0] == min(tops)


@pytest.mark.parametrize("source", ["block", "joint_effort"])
def test_the_first_pair_passes_the_resonance(source):
    settings = JointSettings.from_mapping({"dynamics.natural_frequency": 40.0, "input.source": source})
    slowest, fastest = top_speeds(settings, limits_of())
    assert slowest * 160 / math.tau == pytest.approx(20.0)
    assert fastest * 162 / math.tau == pytest.approx(52.0)
    assert top_speeds(settings, limits_of(speed=1.0))[1] == 1.0


def test_the_lines_stay_below_half_of_the_rate_without_one():
    settings = JointSettings.from_mapping({"input.source": "joint_effort", "input.expected_rate": 100.0})
    assert top_speeds(settings, limits_of())[1] * 162 / math.tau <= 45.0


def test_what_cannot_be_done_is_named():
    with pytest.raises(ParameterError, match="too slow to tell anything; allow more speed"):
        plan_move(JointSettings.from_mapping(), limits_of(speed=0.01), 60.0)
    with pytest.raises(ParameterError, match=r"0\.05 s are too short"):
        plan_move(JointSettings.from_mapping(), limits_of(), 0.05)
    with pytest.raises(ParameterError, match="is no motion; the upper end must lie above"):
        limits_of(upper=-2.0)


def test_the_command_writes_a_trajectory(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "move.yaml"
    given = ["-p", "joints:=[arm, wrist]", "-p", "arm.input.joint_name:=shoulder_pan_joint"]
    assert main(["move", "--joint", "arm", *given, "--out", str(out)]) == 0
    trajectory = yaml.safe_load(out.read_text(encoding="utf-8"))
    assert trajectory["joint_names"] == ["shoulder_pan_joint"]
    last = trajectory["points"][-1]
    assert set(last) == {"positions", "velocities", "time_from_start"}
    assert last["time_from_start"] == {"sec": 60, "nanosec": 0}
    assert "Bring the joint to -90.0° first." in out.read_text(encoding="utf-8")
    assert main(["move", *given]) == 2
    assert "is none of the parameters' joints: arm, wrist" in capsys.readouterr().err

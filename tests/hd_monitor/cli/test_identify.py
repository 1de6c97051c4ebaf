"""The identify command: truth within its intervals, JSON and parameter file, one line for what it cannot use."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.cli.main import main
from hd_monitor.offline.parameters import load_parameters
from hd_monitor.settings import split_joints

SWEEP: dict[str, Any] = {
    "programme": "sweep",
    "sweep.first": 600.0,
    "sweep.last": 2200.0,
    "sweep.rate": 100.0,
    "duration": 16.0,
    "defect": "flexspline",
    "sensor.noise": 2.0,
}
FLEXSPLINE, CIRCULAR_SPLINE = (0.085, 0.050, 0.030), (0.012, 0.008, 0.004)
"""The simulator's bad spline and its sound one."""


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    events = rec.simulated(**(SWEEP | {"seed": 11}))
    return rec.write(tmp_path_factory.mktemp("sweep") / "bag", events)


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Joint states of a joint whose effort has the circular spline's line, in both directions, under gravity."""
    rng, events = np.random.default_rng(3), []
    for number in range(9000):
        t, stamp = 0.01 * number, rec.START + 10_000_000 * number
        angle, speed = 1.5 * math.sin(0.6 * t), 0.9 * math.cos(0.6 * t)
        effort = 5.0 * math.sin(angle) + 2.0 * math.copysign(1.0, speed) + 0.3 * math.cos(200.0 * angle)
        effort += 0.1 * float(rng.standard_normal())
        events.append(rec.Event(stamp, "/joint_states", rec.joint_state(stamp, elbow=(angle, speed, effort))))
    return rec.write(tmp_path_factory.mktemp("arm") / "bag", events)


ARM: tuple[str, ...] = ("-p", "input.source:=joint_effort", "-p", "reducer.flexspline_teeth:=200")
ARM += ("-p", "reducer.circular_spline_teeth:=202", "-p", "reducer.mount:=flexspline_fixed", "--joint", "elbow")


def identified(tmp_path: Path, *arguments: str) -> dict[str, Any]:
    out = tmp_path / "out.json"
    assert main(["identify", *arguments, "--json", str(out)]) == 0
    return dict(json.loads(out.read_text(encoding="utf-8")))


def holds(interval: dict[str, float], truth: float, widths: float = 2.0) -> bool:
    """Whether the truth lies within the interval, made wider so that it fails once in 10 000."""
    assert interval["low"] <= interval["value"] <= interval["high"]
    assert interval["std"] > 0.0
    return abs(interval["value"] - truth) <= widths * 1.96 * interval["std"]


@pytest.mark.parametrize("error", [0.92, 1.08])
def test_a_wrong_natural_frequency_is_corrected_with_all_betas(sweep: Path, tmp_path: Path, error: float) -> None:
    wrong = ["-p", f"dynamics.natural_frequency:={55.0 * error}", "-p", "dynamics.damping_ratio:=0.03"]
    (joint,) = identified(tmp_path, str(sweep), *wrong)["joints"]
    frequency, damping = joint["natural_frequency"], joint["damping_ratio"]
    assert frequency["identified"]
    assert damping["identified"]
    assert frequency["given"] == pytest.approx(55.0 * error)
    assert holds(frequency, 55.0)
    assert holds(damping, 0.023)
    assert frequency["std"] < 0.2  # [Hz]: fn is taken to wander by 1 % a minute, 0.3 Hz in these 16 s
    for name, betas in (("flexspline", FLEXSPLINE), ("circular_spline", CIRCULAR_SPLINE)):
        assert holds(joint[name]["index"], math.hypot(*betas))
        for harmonic, truth in zip(joint[name]["harmonics"], betas, strict=True):
            assert holds(harmonic["beta"], truth), (name, harmonic)
    assert "correct dynamics.natural_frequency" in " ".join(joint["doubts"])
    assert joint["teeth"]["ranked"][0]["flexspline_teeth"] == 160


def test_json_holds_everything_that_is_printed(sweep: Path, tmp_path: Path) -> None:
    content = identified(tmp_path, str(sweep))
    assert {"joints", "bags", "notes", "confidence", "generator"} == set(content)
    assert content["confidence"] == 0.95
    (joint,) = content["joints"]
    assert {
        "joint", "bags", "source", "relative", "torque_source", "circular_spline", "flexspline", "index_correlation",
        "natural_frequency", "damping_ratio", "load_fluctuation", "instability_speed_rpm", "never_unstable", "lines",
        "directions", "travel_deg", "samples", "signal_to_noise_db", "misfit", "fit_status", "doubts", "blockers",
        "teeth", "quality", "parameters", "notes",
    } == set(joint)  # fmt: skip
    assert joint["relative"] is False
    assert joint["torque_source"] == "effort"
    assert [harmonic["k"] for harmonic in joint["flexspline"]["harmonics"]] == [1, 2, 3]
    # The simulator's phases of the bad spline; the joint starts where its stiffness phases are counted from.
    phases = [harmonic["phase_rad"] for harmonic in joint["flexspline"]["harmonics"]]
    assert np.allclose(np.exp(1j * np.array(phases)), np.exp(1j * np.array([0.3, 1.7, 5.1])), atol=0.05)
    assert (joint["never_unstable"], joint["instability_speed_rpm"]) == (True, None)
    assert joint["quality"]["gaps"] == 0
    assert joint["directions"] == []


def test_the_monitor_accepts_the_parameter_file(sweep: Path, tmp_path: Path) -> None:
    file = tmp_path / "found.yaml"
    identified(tmp_path, str(sweep), "-p", "dynamics.natural_frequency:=51.0", "--yaml", str(file))
    assert set(yaml.safe_load(file.read_text(encoding="utf-8"))) == {"hd_monitor_node"}
    (settings,) = split_joints(load_parameters(file)).values()
    assert settings.dynamics.natural_frequency == pytest.approx(55.0, abs=0.1)
    assert settings.dynamics.damping_ratio == pytest.approx(0.023, rel=0.05)


def test_two_recordings_say_more_than_one(sweep: Path, tmp_path: Path) -> None:
    again = rec.write(tmp_path / "again", rec.simulated(**(SWEEP | {"seed": 12})))  # the same stamps once more
    (one,) = identified(tmp_path, str(sweep))["joints"]
    (both,) = identified(tmp_path, str(sweep), str(again))["joints"]
    assert both["bags"] == [str(sweep), str(again)]
    assert both["samples"] > 1.9 * one["samples"]
    assert both["quality"]["clock_jumps"] == 0
    shares = [
        after["beta"]["std"] / before["beta"]["std"]
        for spline in ("circular_spline", "flexspline")
        for before, after in zip(one[spline]["harmonics"], both[spline]["harmonics"], strict=True)
    ]
    # The largest β also depends on fn, ζ and what the model leaves, so only most deviations shrink as the noise does.
    assert max(shares) < 0.9
    assert np.median(shares) == pytest.approx(math.sqrt(0.5), rel=0.1)
    assert holds(both["flexspline"]["index"], math.hypot(*FLEXSPLINE))


def test_one_speed_tells_the_dynamics_by_how_the_lines_couple(tmp_path: Path) -> None:
    events = rec.simulated(programme="fixed", fixed__speed=1200.0, duration=8.0, defect="flexspline")
    (joint,) = identified(tmp_path, str(rec.write(tmp_path / "fixed", events)))["joints"]
    assert joint["natural_frequency"]["identified"]
    assert holds(joint["natural_frequency"], 55.0)
    assert holds(joint["damping_ratio"], 0.023)
    for harmonic, truth in zip(joint["flexspline"]["harmonics"], FLEXSPLINE, strict=True):
        assert holds(harmonic["beta"], truth), harmonic


def test_where_no_lines_are_heard_nothing_is_claimed_of_the_dynamics(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    events = rec.simulated(programme="fixed", fixed__speed=400.0, duration=4.0, defect="none", sensor__noise=50.0)
    bag, file = rec.write(tmp_path / "fixed", events), tmp_path / "found.yaml"
    (joint,) = identified(tmp_path, str(bag), "--yaml", str(file))["joints"]
    assert not joint["natural_frequency"]["identified"]
    assert not joint["damping_ratio"]["identified"]
    assert not joint["teeth"]["conclusive"]
    captured = capsys.readouterr()
    assert "as given: the motion does not tell it better" in captured.out
    assert "hears nothing" in captured.err
    assert not file.exists()


def test_without_an_accelerometer_each_direction_is_shown(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (joint,) = identified(tmp_path, str(arm), *ARM)["joints"]
    assert joint["relative"] is True
    assert joint["natural_frequency"] is None
    assert [entry["direction"] for entry in joint["directions"]] == ["forward", "reverse"]
    for entry in joint["directions"]:
        assert entry["amplitude"]["circular_spline"] == pytest.approx(0.3, abs=4.0 * entry["std"]["circular_spline"])
        assert entry["chance"]["circular_spline"] < 1e-6 < entry["chance"]["flexspline"]
        assert entry["dominance"]["circular_spline"] > 0.99
    best = joint["teeth"]["ranked"][0]
    assert 200 in (best["flexspline_teeth"], best["circular_spline_teeth"])
    assert not joint["teeth"]["conclusive"]  # one line is not a pair
    out = capsys.readouterr().out
    assert "forward: " in out
    assert "reverse: " in out


def test_json_to_standard_output_is_nothing_but_json(arm: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", str(arm), *ARM, "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["joints"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["{none}"], "does not exist"),
        (["{text}"], "not a rosbag2 recording"),
        (["{bag}", "{none}", *ARM], "does not exist"),
        (["{bag}"], "input.source"),
        (["{bag}", *ARM[:-1], "wrist"], "'wrist' is not in joint_states, which carries elbow"),
        (["{bag}", *ARM, "-p", "reducer.flexspline_teeth:=201"], "201"),
        (["{bag}", *ARM, "--remap", "joint_states:=/nowhere"], "no /nowhere (sensor_msgs/JointState) was recorded"),
        (["{bag}", *ARM, "--namespace", "/other"], "no /other/joint_states"),
        (["{bag}", *ARM, "--params", "{none}"], "cannot be read"),
        (["{still}", *ARM], "nothing to identify"),
    ],
)
def test_unusable_input_is_reported_in_one_line_with_status_2(
    arm: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    text = tmp_path / "text"
    text.write_text("hello")
    places = {"bag": str(arm), "none": str(tmp_path / "none"), "text": str(text), "still": str(tmp_path / "still")}
    if "{still}" in arguments:
        stamps = [rec.START + 10_000_000 * number for number in range(1000)]
        events = [rec.Event(s, "/joint_states", rec.joint_state(s, elbow=(1.0, 0.0, 2.0))) for s in stamps]
        rec.write(tmp_path / "still", events)
    assert main(["identify", *(argument.format(**places) for argument in arguments)]) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1, lines
    assert words in lines[0]

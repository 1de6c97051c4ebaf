"""The replay command: its JSON, its exit statuses, and one clear line for what it cannot use."""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.cli.main import main
from hd_monitor.history.entry import Kind
from hd_monitor.history.ledger import Ledger


def result_of(recording: Path, tmp_path: Path, *more: str) -> dict[str, Any]:
    out = tmp_path / "out.json"
    assert main(["replay", str(recording), "--json", str(out), *more]) == 0
    return dict(json.loads(out.read_text(encoding="utf-8")))


def test_json_follows_the_contract(recording: Path, tmp_path: Path) -> None:
    (joint,) = result_of(recording, tmp_path)["joints"]
    assert joint["joint"] == "joint"
    verdict = joint["verdict"]
    assert (verdict["component"], verdict["fault_code"], verdict["level"]) == ("flexspline", "HD_FLEXSPLINE", 2)
    # The simulator's flexspline defect, √(0.09² + 0.04² + 0.03²), and its sound spline, √(0.01² + 0.01² + 0.005²).
    assert verdict["flexspline_index"] == pytest.approx(math.hypot(0.09, 0.04, 0.03), abs=0.002)
    assert verdict["circular_spline_index"] == pytest.approx(0.015, abs=0.002)
    assert verdict["flexspline_index_std"] > 0.0
    assert 600.0 < verdict["travel_deg"] <= 12.0 * 1200 * 6 / 80
    assert verdict["samples"] > 10_900
    assert verdict["gaps"] == 0
    assert verdict["reason"]
    assert {"k", "circular_spline", "flexspline"} <= set(joint["lines"][0])
    assert [line["k"] for line in joint["lines"]] == [1, 2, 3]
    (speed,) = joint["rms_curve"]
    assert speed["rpm"] == pytest.approx(1200.0, abs=1.0)
    assert speed["samples"] > 10_900
    stamps = [entry["stamp"] for entry in joint["timeline"]]
    assert stamps == sorted(set(stamps))
    assert joint["timeline"][-1]["component"] == "flexspline"


def test_json_to_standard_output_is_nothing_but_json(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", str(recording), "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["joints"]


def test_the_terminal_names_part_and_indexes(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", str(recording)]) == 0
    out = capsys.readouterr().out
    assert "joint: ERROR, flexspline (HD_FLEXSPLINE)" in out
    assert "no faults in the data" in out


def test_parameters_come_from_the_nodes_file_and_from_the_command_line(recording: Path, tmp_path: Path) -> None:
    params = tmp_path / "p.yaml"
    params.write_text(
        "/**:\n  ros__parameters:\n    joints: [elbow]\n    elbow: {input: {joint_name: joint}}\n"
        "    diagnosis: {warn_index: 0.2, error_index: 0.3}\n    reducer: {serial: HD-7}\n"
    )
    (joint,) = result_of(recording, tmp_path, "--params", str(params))["joints"]
    assert (joint["joint"], joint["verdict"]["component"], joint["verdict"]["level"]) == ("elbow", "none", 0)
    assert joint["parameters"]["reducer.serial"] == "HD-7"
    (joint,) = result_of(recording, tmp_path, "--params", str(params), "-p", "diagnosis.warn_index:=5e-2")["joints"]
    assert joint["verdict"]["component"] == "flexspline"


@pytest.mark.parametrize(("level", "status"), [("warn", 1), ("error", 1)])
def test_fail_on_makes_a_bad_verdict_fail(recording: Path, level: str, status: int) -> None:
    assert main(["replay", str(recording), "--fail-on", level]) == status
    sound = ["-p", "diagnosis.warn_index:=0.2", "-p", "diagnosis.error_index:=0.3"]
    assert main(["replay", str(recording), "--fail-on", level, *sound]) == 0


def test_fail_on_error_lets_a_warning_pass(recording: Path) -> None:
    suspect = ["-p", "diagnosis.error_index:=0.3"]
    assert main(["replay", str(recording), "--fail-on", "error", *suspect]) == 0
    assert main(["replay", str(recording), "--fail-on", "warn", *suspect]) == 1


def test_an_input_that_ends_before_the_recording_is_said_beside_the_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    events = rec.simulated(programme="fixed", fixed__speed=1200.0, duration=14.0, defect="none")
    cut = [e for e in events if "block" not in e.topic or e.time < rec.START + 7 * 10**9]
    path = rec.write(tmp_path / "bag", cut)
    (joint,) = result_of(path, tmp_path)["joints"]
    assert (joint["verdict"]["fault_code"], joint["verdict"]["level"]) == ("HD_OK", 0)
    assert (joint["input"]["fault_code"], joint["input"]["level_name"]) == ("HD_INPUT_LOST", "ERROR")
    assert joint["input"]["reason"].startswith("No vibration signal: check the publisher")
    assert {entry["input"] for entry in joint["timeline"]} == {"HD_INPUT_OK"}
    out = capsys.readouterr().out
    assert "joint: OK, none (HD_OK)" in out
    assert "input: ERROR, HD_INPUT_LOST: No vibration signal" in out
    assert main(["replay", str(path), "--fail-on", "error"]) == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["{none}"], "does not exist"),
        (["{text}"], "not a rosbag2 recording"),
        (["{bag}", "--joint", "elbow"], "'elbow' is not in joint_states, which carries joint"),
        (["{bag}", "-p", "input.source:=imu"], "no imu/data_raw (sensor_msgs/Imu) was recorded"),
        (["{bag}", "--remap", "joint_states:=/nowhere"], "no /nowhere (sensor_msgs/JointState) was recorded"),
        (["{bag}", "--remap", "joint_states"], "maps nothing"),
        (["{bag}", "--namespace", "/other"], "no /other/joint_states"),
        (["{bag}", "--params", "{none}"], "cannot be read"),
        (["{bag}", "-p", "diagnosis.warn_indx:=1.0"], "diagnosis.warn_indx"),
        (["{bag}", "-p", "reducer.flexspline_teeth:=163"], "swapped"),
    ],
)
def test_unusable_input_is_reported_in_one_line_with_status_2(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    text = tmp_path / "text"
    text.write_text("hello")
    places = {"bag": str(recording), "none": str(tmp_path / "none"), "text": str(text)}
    assert main(["replay", *(argument.format(**places) for argument in arguments)]) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("hd-monitor replay: ")
    assert words in lines[0]


@pytest.mark.parametrize("command", ["replay", "identify"])
@pytest.mark.parametrize(
    "option", [["--json", "{none}/out.json"], ["--json", "{folder}"], ["--report", "{text}/report"]]
)
def test_an_output_that_cannot_be_written_is_one_line_and_status_3_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str, option: list[str]
) -> None:
    if command == "identify" and option[0] == "--report":
        option = ["--yaml", option[1]]
    (tmp_path / "text").write_text("hello")
    places = {"none": tmp_path / "none", "text": tmp_path / "text", "folder": tmp_path}
    no_bag = str(tmp_path / "no bag")  # which would be reported, had the work begun
    assert main([command, no_bag, *(word.format(**places) for word in option)]) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert re.match(f"hd-monitor {command}: .* cannot be written: ", line)
    assert [file.name for file in tmp_path.iterdir()] == ["text"]


def test_a_cut_off_recording_says_so_and_still_gives_a_verdict(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = rec.storage_file(recording).read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole[: int(0.9 * len(whole))])
    out = tmp_path / "out.json"
    assert main(["replay", str(cut), "--json", str(out)]) == 0
    assert "cut off" in capsys.readouterr().err
    content = json.loads(out.read_text())
    assert any("cut off" in note for note in content["notes"])
    assert content["joints"][0]["verdict"]["component"] == "flexspline"


def test_one_joint_of_several_can_be_selected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    stamps = [rec.START + number * 10_000_000 for number in range(500)]
    still = (0.0, 0.0, 0.0)
    events = [rec.Event(stamp, "/joint_states", rec.joint_state(stamp, a=still, b=still)) for stamp in stamps]
    bag = rec.write(tmp_path / "bag", events)
    assert main(["replay", str(bag), "-p", "input.source:=joint_effort"]) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert "joint_states carries a, b; set input.joint_name" in lines[0]


@pytest.mark.parametrize(
    ("source", "code"), [([], "HD_FLEXSPLINE"), (["-p", "input.source:=joint_velocity"], "HD_UNDETERMINED")]
)
def test_a_period_longer_than_the_recording_does_not_withhold_the_verdict(
    recording: Path, tmp_path: Path, source: list[str], code: str
) -> None:
    (joint,) = result_of(recording, tmp_path, "-p", "analysis.period:=60.0", *source)["joints"]
    assert joint["verdict"]["fault_code"] == code


def swinging_arm(folder: Path, seed: int, line: float = 0.025) -> Path:
    """Joint states with a line of the circular spline [N·m], by default too weak to be named in one recording."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, 30.0, 0.01)
    angle = 1.4 * np.sin(0.55 * times) + 0.2 * np.sin(1.3 * times)
    speed = 0.77 * np.cos(0.55 * times) + 0.26 * np.cos(1.3 * times)
    effort = 4.0 * np.sin(angle) + line * np.cos(160 * angle + seed) + 0.25 * rng.standard_normal(times.size)
    stamps = (rec.START + 3600 * seed * 10**9 + np.rint(1e9 * times)).astype(int).tolist()
    rows = zip(stamps, angle.tolist(), speed.tolist(), effort.tolist(), strict=True)
    events = [rec.Event(stamp, "/joint_states", rec.joint_state(stamp, joint=(a, v, e))) for stamp, a, v, e in rows]
    return rec.write(folder / f"arm{seed}", events)


def test_several_recordings_are_one_history(tmp_path: Path) -> None:
    bags = [str(swinging_arm(tmp_path, seed)) for seed in range(6)]
    given = ("-p", "input.source:=joint_effort", "-p", "analysis.memory:=3600.0")
    alone = [result_of(Path(bag), tmp_path, *given)["joints"][0]["verdict"]["component"] for bag in bags]
    out = tmp_path / "together.json"
    assert main(["replay", *bags, "--json", str(out), "--report", str(tmp_path), *given]) == 0
    together = json.loads(out.read_text(encoding="utf-8"))
    (joint,) = together["joints"]
    assert joint["verdict"]["component"] == "circular_spline"
    assert alone.count("undetermined") >= 4
    assert [row["spline"] for row in joint["torque_shares"]] == ["circular_spline", "flexspline"]
    assert all(0.0 <= row["low"] <= row["share"] <= row["high"] <= 1.0 for row in joint["torque_shares"])
    assert "that follows the torque" in (tmp_path / "index.html").read_text(encoding="utf-8")
    assert together["bag"] == ", ".join(bags)
    stamps = [entry["stamp"] for entry in joint["timeline"]]
    assert stamps == sorted(set(stamps))
    assert stamps[-1] - stamps[0] > 5 * 3600 * 10**9


def test_the_ledger_keeps_the_temperature_where_it_was_recorded(recording: Path, tmp_path: Path) -> None:
    warm = [
        rec.Event(rec.START + second * 10**9, "/gearbox", rec.temperature(rec.START + second * 10**9, 30.0 + second))
        for second in (0, 4)
    ]
    own = rec.write(tmp_path / "warm", [*rec.simulated(duration=6.0, programme="fixed"), *warm])
    file = tmp_path / "ledger.sqlite"
    for bag in (own, recording):
        given = ("-p", "input.temperature_topic:=gearbox", "-p", f"reducer.serial:={bag.name}")
        assert main(["replay", str(bag), "--history", str(file), *given]) == 0
    with Ledger(file) as ledger:
        (*_, last), (*_, other) = ledger.entries(own.name), ledger.entries(recording.name)
    assert 30.0 < last.temperature <= 34.0
    assert math.isnan(other.temperature)


def test_recordings_are_rated_against_the_ledgers_baseline(tmp_path: Path) -> None:
    history = ("--history", str(tmp_path / "ledger.sqlite"))
    given = (*history, "-p", "input.source:=joint_effort")

    def code_of(seed: int, line: float) -> str:
        (joint,) = result_of(swinging_arm(tmp_path, seed, line), tmp_path, *given)["joints"]
        return str(joint["verdict"]["fault_code"])

    assert [code_of(seed, 0.3) for seed in range(3)] == ["HD_UNRATED"] * 3
    assert main(["history", *history, "--set-baseline"]) == 0
    assert [code_of(3, 0.3), code_of(4, 0.45)] == ["HD_OK", "HD_CIRCULAR_SPLINE"]


def test_a_history_names_the_recording_that_cannot_be_used(
    tmp_path: Path, recording: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    still = rec.write(tmp_path / "still", [event for event in rec.small(3.0) if event.topic == "/joint_states"])
    assert main(["replay", str(recording), str(still)]) == 2
    assert str(still) in capsys.readouterr().err


def test_a_replay_writes_to_the_ledger(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "ledger.sqlite"
    given = ("--history", str(file), "-p", "reducer.serial:=S1", "-p", "history.interval:=5.0")
    for _ in range(2):  # a second time takes the place of the first
        assert main(["replay", str(recording), *given]) == 0
    with Ledger(file) as ledger:
        entries = ledger.entries("S1")
    assert {entry.recording for entry in entries} == {str(recording)}
    kinds = [entry.kind for entry in entries]
    assert kinds.count(Kind.EVIDENCE) == 2
    last = entries[-1]
    assert last.verdict is not None
    assert last.verdict.component.value == "flexspline"
    assert last.index is not None
    assert last.index.flexspline == pytest.approx(math.hypot(0.09, 0.04, 0.03), abs=0.002)
    assert [line.k for line in last.lines] == [1, 2, 3]
    assert sum(entry.revolutions for entry in entries) == pytest.approx(1200 / 60 * 12, abs=30.0)
    assert last.speed == pytest.approx(1200.0, abs=2.0)
    assert main(["replay", str(recording), "--history", str(tmp_path)]) == 3
    assert "cannot be opened" in capsys.readouterr().err

"""The command hd-sim-bag: what it writes, what it says, and its exit status."""

import json
import subprocess
import sys

import pytest

pytest.importorskip("rosbags", reason="writing and reading bags needs the extra 'offline'")

from rosbags.rosbag2 import Reader

from hd_sim_node.bag import COMPRESSIONS, STORAGES
from hd_sim_node.bag_command import build_parser, main
from hd_sim_node.motion.programmes import PROGRAMMES

SHORT = ["--programme", "fixed", "--duration", "0.5"]


def topics(path):
    with Reader(path) as reader:
        return {connection.topic: connection.msgcount for connection in reader.connections}


def test_writes_a_bag_and_says_so(tmp_path, capsys):
    assert main([*SHORT, "--out", str(tmp_path / "bag"), "--publish", "both"]) == 0
    assert topics(tmp_path / "bag") == {
        "/torsional_acceleration/block": 10,
        "/torsional_acceleration": 500,
        "/joint_states": 50,
    }
    said = capsys.readouterr().out
    assert "0.5 s simulated" in said
    assert "/torsional_acceleration: 500 messages" in said


@pytest.mark.parametrize("programme", PROGRAMMES)
def test_writes_every_programme(tmp_path, programme):
    command = ["--programme", programme, "--duration", "0.5", "--out", str(tmp_path / "bag")]
    assert main(command) == 0
    assert topics(tmp_path / "bag") == {"/torsional_acceleration/block": 10, "/joint_states": 50}


@pytest.mark.parametrize("storage", STORAGES)
def test_storage(tmp_path, storage):
    assert main([*SHORT, "--out", str(tmp_path / "bag"), "--storage", storage]) == 0
    suffix = {"mcap": ".mcap", "sqlite3": ".db3"}[storage]
    assert [file.suffix for file in (tmp_path / "bag").iterdir() if file.suffix != ".yaml"] == [suffix]


def test_offers_every_format_of_the_writer():
    choices = {action.dest: action.choices for action in build_parser()._actions}
    assert choices["storage"] == tuple(STORAGES)
    assert choices["compression"] == tuple(COMPRESSIONS)


def test_takes_the_nodes_parameter_file_and_overrides(tmp_path):
    file = tmp_path / "rig.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n    reducer: {flexspline_teeth: 160, serial: A7}\n    diagnosis.warn_index: 0.04\n"
        "hd_sim_node:\n  ros__parameters:\n    programme: fixed\n    duration: 1.0\n    time_scale: 5.0\n"
        "    sensor: {rate: 500.0}\n"
    )
    command = ["--params", str(file), "--out", str(tmp_path / "bag"), "--set", "joint_states.rate:=20.0"]
    assert main([*command, "--namespace", "/arm/"]) == 0
    assert topics(tmp_path / "bag") == {"/arm/torsional_acceleration/block": 10, "/arm/joint_states": 20}


def test_several_files_are_several_rigs(tmp_path):
    command = [*SHORT, "--out", str(tmp_path / "bag")]
    for name in ("a", "b"):
        file = tmp_path / f"{name}.yaml"
        file.write_text(json.dumps({"joint_states": {"name": name}}))
        command += ["--params", str(file)]
    assert main(command) == 0
    assert set(topics(tmp_path / "bag")) == {
        "/a/torsional_acceleration/block",
        "/b/torsional_acceleration/block",
        "/joint_states",
    }


def test_the_start_is_a_stamp(tmp_path):
    assert main([*SHORT, "--out", str(tmp_path / "bag"), "--start", "1000"]) == 0
    with Reader(tmp_path / "bag") as reader:
        assert reader.start_time // 1_000_000_000 == 1000


def test_the_same_command_writes_the_same_messages(tmp_path):
    for name in ("one", "two"):
        assert main([*SHORT, "--seed", "7", "--start", "0", "--out", str(tmp_path / name)]) == 0

    def messages(name):
        with Reader(tmp_path / name) as reader:
            return [(connection.topic, time, bytes(data)) for connection, time, data in reader.messages()]

    assert messages("one") == messages("two")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--set", "sensor.nose:=1.0"], "did you mean sensor.noise"),
        (["--set", "sensor.noise"], ":="),
        (["--set", "fixed.speed:=fast"], "wrong type"),
        (["--params", "missing.yaml"], "missing.yaml"),
        (["--start", "-5"], "--start -5"),
        (
            ["--defect", "custom", "--set", "circular_spline.beta:=[0.14]", "--set", "fixed.speed:=3300.0"],
            "unstable at 3300 rpm",
        ),
    ],
)
def test_refuses_with_one_line_and_status_2(tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    assert main([*SHORT, "--out", "bag", *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.startswith("hd-sim-bag: ")
    assert error.count("\n") == 1
    assert not (tmp_path / "bag").exists()


def test_an_existing_folder_is_refused(tmp_path, capsys):
    (tmp_path / "bag").mkdir()
    assert main([*SHORT, "--out", str(tmp_path / "bag")]) == 3
    assert "exists already" in capsys.readouterr().err


def test_ignored_lists_cause_a_remark(tmp_path, capsys):
    assert main([*SHORT, "--out", str(tmp_path / "bag"), "--set", "flexspline.beta:=[0.1]"]) == 0
    assert "set defect to 'custom'" in capsys.readouterr().err


def test_runs_without_ros(tmp_path):
    """In a process where rclpy cannot be imported, the bag is written all the same."""
    program = (
        "import sys; sys.modules['rclpy'] = None\n"
        "from hd_sim_node.bag_command import main\n"
        "raise SystemExit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", program, *SHORT, "--out", str(tmp_path / "bag")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr


def test_a_drive_from_the_catalogue(tmp_path, capsys):
    assert main([*SHORT, "--drive", "catalogue", "--out", str(tmp_path / "bag")]) == 0
    assert "give the monitor the same dynamics" in capsys.readouterr().err

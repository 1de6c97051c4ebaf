import os
import subprocess
import sys

import pytest

from hd_monitor.cli.main import COMMANDS, main


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["--help"])
    assert caught.value.code == 0
    output = capsys.readouterr().out
    assert all(name in output for name in COMMANDS)


@pytest.mark.parametrize("words", [[], ["dance"], ["demo", "--dance"]])
def test_wrong_words_are_status_2(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("rclpy")
    with pytest.raises(SystemExit) as caught:
        main(words)
    assert caught.value.code == 2
    assert "usage: hd-monitor" in capsys.readouterr().err


def run_without(package: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the command in an interpreter in which `package` cannot be imported."""
    block = f"import sys; sys.modules[{package!r}] = None"
    code = f"{block}; from hd_monitor.cli.main import main; sys.exit(main(sys.argv[1:]))"
    return subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.parametrize(
    ("package", "words", "advice"),
    [
        ("rclpy", ("demo",), "source your ROS installation"),
        ("diagnostic_msgs", ("demo", "--defect", "both"), "needs ROS 2 (diagnostic_msgs is missing)"),
        ("hd_sim_node", ("demo",), "build or install this repository as a whole"),
        ("rosbags", ("replay", "bag"), "'.[offline]'"),
    ],
)
def test_what_is_missing_is_one_clear_line(package: str, words: tuple[str, ...], advice: str) -> None:
    if package == "hd_sim_node":
        pytest.importorskip("rclpy")
    done = run_without(package, *words)
    assert done.returncode == 2
    assert advice in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not done.stdout


def test_a_command_needs_no_other_commands_packages() -> None:
    done = run_without("rclpy", "replay", "--help")
    assert done.returncode == 0, done.stderr


def test_a_reader_that_leaves_is_no_error_worth_a_traceback() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "hd_monitor.cli.main", "parameters"], stdout=writing, stderr=subprocess.PIPE, check=False
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, b"")

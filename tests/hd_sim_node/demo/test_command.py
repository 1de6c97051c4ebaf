"""The demo as a user runs it: real processes, real output, real exit status."""

import os
import re
import signal
import time
from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.ros

COMMAND = "hd_monitor.cli.main"
SHORT = ("--time-scale", "20", "--sim", "dwell.first:=400.0", "--sim", "dwell.last:=900.0")
Start = Callable[..., Any]


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def wait_until(condition: Callable[[], object], what: str, patience: float = 60.0) -> None:
    deadline = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < deadline, f"waited {patience:g} s for {what}"
        time.sleep(0.05)


def children_of(demo: Any) -> list[int]:
    return [int(pid) for pid in re.findall(r"\(process (\d+)\)", demo.output)]


def final_rows(output: str) -> dict[str, str]:
    """Name and value of the rows below "Final status" and "It came from"."""
    lines = output.partition("Final status")[2].splitlines()
    return {line[2:20].strip(): line[20:] for line in lines if line.startswith("  ") and line[2:20].strip()}


@pytest.mark.parametrize(
    ("defect", "code"),
    [
        ("flexspline", "HD_FLEXSPLINE"),
        ("circular_spline", "HD_CIRCULAR_SPLINE"),
        ("both", "HD_BOTH_SPLINES"),
        ("none", "HD_OK"),
    ],
)
def test_it_names_the_defect_and_says_where_that_came_from(start_module: Start, defect: str, code: str) -> None:
    demo = start_module(COMMAND, "demo", "--defect", defect, *SHORT)
    assert demo.wait() == 0, demo.output
    rows = final_rows(demo.output)
    assert (rows["component"], rows["fault_code"]) == (defect, code)
    for spline in ("flexspline", "circular spline"):
        assert re.match(r"\d+\.\d+ ± 0\.0*[1-9]\d % +\(simulated \d+\.\d\d %\)", rows[spline]), rows
    assert rows["limits"] == "warn 5.000 %, error 8.000 %"
    assert rows["topic"] == "/diagnostics (diagnostic_msgs/DiagnosticArray)"
    assert rows["node"] == "/hd_monitor_node"
    assert rows["status"] == "/hd_monitor_node: joint reducer"
    assert demo.output.rstrip().endswith(f"The monitor names what was simulated: {defect}.")
    assert "\x1b" not in demo.output  # no terminal, no control characters
    assert not any(map(is_running, children_of(demo)))


def test_a_verdict_that_differs_from_what_was_simulated_is_status_1(start_module: Start) -> None:
    # With limits this high the monitor rightly says none; that the demo expects the same shows it judges by them.
    limits = ("--monitor", "diagnosis.warn_index:=0.3", "--monitor", "diagnosis.error_index:=0.4")
    demo = start_module(COMMAND, "demo", *limits, *SHORT)
    assert demo.wait() == 0, demo.output
    assert final_rows(demo.output)["component"] == "none"
    # After a second at 200 rpm no honest monitor can name a part.
    demo = start_module(COMMAND, "demo", "--time-scale", "1", "--seconds", "1")
    assert demo.wait() == 1, demo.output
    assert "The monitor says undetermined, but flexspline was simulated." in demo.output


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 130)])
def test_an_interrupt_ends_both_nodes(start_module: Start, number: int, status: int) -> None:
    demo = start_module(COMMAND, "demo", "--time-scale", "1")
    wait_until(lambda: re.search(r"^ *\d+%", demo.output, re.MULTILINE) or not demo.running, "progress")
    nodes = children_of(demo)
    assert len(nodes) == 2
    assert all(map(is_running, nodes))
    demo.popen.send_signal(number)
    assert demo.wait() == status
    assert not any(map(is_running, nodes))
    assert "Traceback" not in demo.output


@pytest.mark.parametrize("which", [0, 1])
def test_a_node_that_dies_is_named(start_module: Start, which: int) -> None:
    demo = start_module(COMMAND, "demo", "--time-scale", "1")
    wait_until(lambda: re.search(r"^ *\d+%", demo.output, re.MULTILINE) or not demo.running, "progress")
    nodes = children_of(demo)
    os.kill(nodes[which], signal.SIGKILL)
    assert demo.wait() == 3
    assert f"hd-monitor demo: {('hd_sim_node', 'hd_monitor_node')[which]} ended with status -9" in demo.output
    assert not any(map(is_running, nodes))


def test_a_node_that_refuses_to_start_is_quoted(start_module: Start) -> None:
    unstable = ("programme:=fixed", "fixed.speed:=3300.0", "dynamics.damping_ratio:=0.001")
    demo = start_module(COMMAND, "demo", *(word for parameter in unstable for word in ("--sim", parameter)))
    assert demo.wait() == 3
    assert "hd_sim_node ended with status 2" in demo.output
    assert "parametrically unstable at 3300 rpm" in demo.output


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--domain", "233"), "--domain = 233 is not a ROS_DOMAIN_ID"),
        (("--time-scale", "0"), "--time-scale = 0 is not usable"),
        (("--time-scale", "nan"), "--time-scale = nan is not usable"),
        (("--sim", "sensor.noize:=1.0"), "did you mean sensor.noise"),
        (("--sim", "sensor.noise"), "write NAME:=VALUE"),
        (("--monitor", "reducer.mount:=ceiling"), "choose one of"),
        (("--monitor", "input.source:=imu", "--monitor", "input.sensor_radius:=0.0"), "give the distance of the IMU"),
        (("--seconds", "-1"), "--seconds = -1 is not usable"),
    ],
)
def test_unusable_arguments_are_one_clear_line_and_status_2(
    start_module: Start, words: tuple[str, ...], complaint: str
) -> None:
    demo = start_module(COMMAND, "demo", *words)
    assert demo.wait() == 2
    assert complaint in demo.output
    assert len(demo.output.strip().splitlines()) == 1, demo.output


def test_the_users_domain_is_used(start_module: Start) -> None:
    domain = os.environ["ROS_DOMAIN_ID"]
    demo = start_module(COMMAND, "demo", "--domain", domain, "--seconds", "5", "--time-scale", "10")
    demo.wait()
    assert f"ROS_DOMAIN_ID={domain}" in demo.output

"""The launch files start the installed nodes, where ROS's launch is to be had."""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import Bench
from .test_verdicts import settled

pytestmark = pytest.mark.ros

RUN = """
import sys
from pathlib import Path
from ament_index_python.packages import get_package_share_directory
from launch import LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource

file, *arguments = sys.argv[1:]
source = PythonLaunchDescriptionSource(str(Path(get_package_share_directory("hd_monitor"), "launch", file)))
pairs = [argument.split(":=", 1) for argument in arguments]
service = LaunchService(argv=arguments)
service.include_launch_description(IncludeLaunchDescription(source, launch_arguments=pairs))
sys.exit(service.run())
"""
"""``ros2 launch hd_monitor FILE ARGUMENTS``, without ros2cli."""


@pytest.fixture
def launch(start_module: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Launch a file of the installed package."""
    pytest.importorskip("launch_ros", reason="ROS's launch is not on this machine")
    packages = pytest.importorskip("ament_index_python.packages")
    known = [os.environ[name] for name in ("AMENT_PREFIX_PATH",) if name in os.environ]
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([*known, sys.prefix]))
    try:
        packages.get_package_prefix("hd_monitor")
    except packages.PackageNotFoundError:
        pytest.skip("hd_monitor is imported from the source tree: there is no install to launch")
    (tmp_path / "launch_it.py").write_text(RUN)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    return lambda *words: start_module("launch_it", *words)


def test_the_monitor_with_a_topic_a_name_and_a_file_of_its_own(
    bench: Bench, launch: Callable[..., Any], tmp_path: Path
) -> None:
    file = tmp_path / "elbow.yaml"
    file.write_text("/**:\n  ros__parameters:\n    reducer: {serial: E7}\n    input: {startup_timeout: 1.0}\n")
    process = launch(
        "monitor.launch.py", f"params_file:={file}", "namespace:=arm", "node_name:=watch", "input_topic:=accelerometer"
    )
    lost = bench.until_input(lambda s: s.fault_code == "HD_INPUT_LOST", "a lost input")
    assert (lost.name, lost.hardware_id) == ("/arm/watch: joint input", "E7")
    assert "nothing publishes /arm/accelerometer (std_msgs/msg/Float64MultiArray)" in lost.values["reason"]
    assert process.interrupt() == 0


def test_the_demo_names_the_part(bench: Bench, launch: Callable[..., Any]) -> None:
    process = launch("demo.launch.py", "defect:=circular_spline", "time_scale:=4.0", "namespace:=cell")
    assert bench.until_status(settled, "a settled verdict").component == "circular_spline"
    assert process.interrupt() == 0

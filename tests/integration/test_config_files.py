"""Every parameter file that is shipped for the node starts it."""

from pathlib import Path
from typing import Any

import pytest

from .conftest import MONITOR, Bench

pytestmark = pytest.mark.ros

CONFIG = Path(__file__).resolve().parents[2] / "config"
JOINTS = {"monitor.yaml": 1, "robot.yaml": 3, "ur10e.yaml": 6, "my_reducer.yaml": 1}


@pytest.mark.parametrize("name", JOINTS)
def test_a_shipped_file_starts_the_node(bench: Bench, start_module: Any, name: str) -> None:
    process = start_module(MONITOR, "--ros-args", "--params-file", str(CONFIG / name))
    bench.until(lambda: bench.statuses or not process.running, "a status")
    assert process.running, process.output
    assert len({status.name for status in bench.statuses}) == JOINTS[name]

"""What shows statuses needs no estimator: neither its modules nor the libraries that it computes with."""

import subprocess
import sys

import pytest

LOADED = """
import importlib, sys
for name in sys.argv[1:]:
    importlib.import_module(name)
print(*sys.modules)
"""


def loaded_by(*modules: str) -> set[str]:
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *modules], capture_output=True, text=True, timeout=60, check=True
    )
    return set(done.stdout.split())


@pytest.mark.ros
def test_watching_live_imports_no_estimator() -> None:
    found = loaded_by("hd_monitor.cli.watch", "hd_monitor.watch.app", "hd_monitor.watch.live")
    assert {"textual", "rclpy", "hd_monitor.watch.state"} <= found
    foreign = ("hd_monitor.identification", "hd_monitor.monitor", "hd_monitor.acquisition", "hd_monitor.offline")
    assert not [name for name in found if name.startswith(foreign)]
    assert not {"scipy", "mcap", "matplotlib", "rosbags"} & found


def test_the_state_and_its_words_need_neither_ros_nor_the_terminals_library() -> None:
    found = loaded_by("hd_monitor.watch.state", "hd_monitor.watch.panels")
    assert "hd_monitor.watch.answers" in found
    assert not {"textual", "rich", "rclpy", "scipy"} & found

"""What the running node remembers beside the lines: the property curve of the baseline, and the temperature."""

from pathlib import Path
from typing import Any

import pytest

from hd_monitor.history.entry import Kind
from hd_monitor.history.ledger import Ledger

from .conftest import QUICK, Bench
from .test_lifecycle import trigger

pytestmark = pytest.mark.ros


def test_the_vibration_is_shown_against_the_baselines(bench: Bench, peer: Any, tmp_path: Path) -> None:
    from sensor_msgs.msg import Temperature
    from std_msgs.msg import Float64MultiArray

    path = tmp_path / "ledger.sqlite"
    baselines = peer.collect(Float64MultiArray, "rms_curve/baseline", match=False)
    curves = peer.collect(Float64MultiArray, "rms_curve", match=False)
    bench.monitor(f"history.path:={path}", "history.interval:=5.0", "input.temperature_topic:=gearbox")
    warmth = peer.publisher(Temperature, "gearbox")
    bench.rig("defect:=none", "time_scale:=5.0", *QUICK[1:])

    def written() -> bool:
        measured = Temperature(temperature=31.0)
        measured.header.stamp = peer.node.get_clock().now().to_msg()
        warmth.publish(measured)
        with Ledger(path) as ledger:
            entries = ledger.entries("", "joint")
        return any(entry.kind is Kind.EVIDENCE and entry.temperature == 31.0 for entry in entries)

    bench.until(path.exists, "a ledger")
    bench.until(written, "an entry with its temperature")
    assert not baselines
    assert trigger(peer, "set_baseline").success
    bench.until(lambda: baselines, "the baseline's curve")
    assert baselines[-1].layout.dim[1].label == curves[-1].layout.dim[1].label
    shown = bench.until_status(lambda s: "rms growth (%)" in s.values, "a comparison with the baseline")
    assert abs(shown.number("rms growth (%)")) < 100.0

"""Settings that change while a joint is watched take effect without losing evidence."""

import pytest
from tests.hd_monitor.monitored import PAPER, Recording, latest

from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity


@pytest.mark.parametrize("corrected", [False, True])
def test_another_torque_counts_for_the_motion_to_come(corrected: bool) -> None:
    def given(torque: float) -> JointSettings:
        return JointSettings.from_mapping(PAPER | {"load.source": "parameter", "load.torque": torque})

    recording = Recording(seconds=24.0)  # under 10 N·m
    monitor = Monitor(given(40.0))
    if corrected:
        monitor.change(given(10.0))
    recording.feed_motion(monitor)
    for block in recording.blocks():
        monitor.add_block(block)
    monitor.finish()
    assert ("times the torque given" in latest(monitor).verdict.reason) is not corrected


def test_another_timeout_counts_for_the_input_that_is_waited_for() -> None:
    monitor = Monitor(JointSettings.from_mapping({"input.timeout": 60.0}))
    recording = Recording(seconds=12.0)
    recording.feed_motion(monitor)
    monitor.add_block(recording.blocks()[0])
    assert not [a for a in monitor.advance() if Quantity.VIBRATION.value in a.input.reason]
    monitor.change(JointSettings.from_mapping({"input.timeout": 2.0}))
    assert monitor.advance()

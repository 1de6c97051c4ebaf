"""Under simulated time silence counts by it, and its absence does not stop the statuses."""

from importlib import import_module
from typing import Any

import pytest

from .conftest import Bench

pytestmark = pytest.mark.ros


def test_statuses_come_before_there_is_a_clock(bench: Bench) -> None:
    bench.monitor("use_sim_time:=true", "input.timeout:=0.5")
    bench.until_status(lambda s: "no simulated time has arrived yet" in s.message, "a status that misses the clock")
    bench.forget()
    bench.until(lambda: len(bench.statuses) >= 2, "statuses without a clock")
    assert all(status.fault_code != "HD_INPUT_LOST" for status in bench.statuses)


def test_silence_counts_by_the_simulated_clock(bench: Bench, peer: Any) -> None:
    clock_type: Any = import_module("rosgraph_msgs.msg").Clock
    clock = peer.publisher(clock_type, "/clock", match=False)
    bench.monitor("use_sim_time:=true", "input.timeout:=30.0")
    message = clock_type()

    def stamped(seconds: int) -> bool:
        message.clock.sec = seconds
        clock.publish(message)
        return any(array.header.stamp.sec == seconds for array in bench.arrays)

    bench.until(lambda: stamped(1000), "a status stamped by the clock")
    bench.until(lambda: stamped(1020), "a status twenty simulated seconds later")
    assert all(status.fault_code != "HD_INPUT_LOST" for status in bench.statuses)
    bench.until(lambda: stamped(1051), "a status thirty more simulated seconds later")
    bench.until_status(lambda s: s.fault_code == "HD_INPUT_LOST", "simulated seconds of silence")

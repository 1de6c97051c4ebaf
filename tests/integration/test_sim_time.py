"""Under simulated time silence counts by it, and its absence does not stop the statuses."""

from importlib import import_module
from typing import Any

import pytest

from .conftest import WARN, Bench

pytestmark = pytest.mark.ros


def test_statuses_come_before_there_is_a_clock(bench: Bench) -> None:
    process = bench.monitor("use_sim_time:=true", "input.startup_warning:=2.0", "input.startup_timeout:=3.0")
    status = bench.until_input(lambda s: s.level == WARN, "a status that misses the clock")
    assert (status.fault_code, "no simulated time has arrived yet" in status.message) == ("HD_INPUT_WAITING", True)
    bench.until(lambda: "does anything publish /clock?" in process.output, "a line in the log")
    bench.forget()
    bench.until(lambda: len(bench.inputs) >= 2, "statuses without a clock")
    assert all(status.fault_code != "HD_INPUT_LOST" for status in bench.inputs)


def test_silence_counts_by_the_simulated_clock(bench: Bench, peer: Any) -> None:
    clock_type: Any = import_module("rosgraph_msgs.msg").Clock
    clock = peer.publisher(clock_type, "/clock", match=False)
    bench.monitor("use_sim_time:=true", "input.startup_timeout:=30.0")
    message = clock_type()

    def stamped(seconds: int) -> bool:
        message.clock.sec = seconds
        clock.publish(message)
        return any(array.header.stamp.sec == seconds for array in bench.arrays)

    bench.until(lambda: stamped(1000), "a status stamped by the clock")
    bench.until(lambda: stamped(1020), "a status twenty simulated seconds later")
    assert all(status.fault_code != "HD_INPUT_LOST" for status in bench.inputs)
    bench.until(lambda: stamped(1051), "a status thirty more simulated seconds later")
    bench.until_input(lambda s: s.fault_code == "HD_INPUT_LOST", "simulated seconds of silence")

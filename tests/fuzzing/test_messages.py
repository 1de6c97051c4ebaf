"""Messages of any content are decoded, or refused, and a monitor assesses what is left of them."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st
from tests.fuzzing.readers import Counter, put_into_words
from tests.fuzzing.survival import damaged, survive
from tests.hd_monitor.monitored import EPOCH, Recording
from tests.hd_monitor.offline import recordings

from hd_monitor.adapters import Inputs
from hd_monitor.contract import Block
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import INPUT_SOURCES, LOAD_SOURCES, Quantity

START = recordings.START


def serialised(message: Any) -> bytes:
    return bytes(recordings.STORE.serialize_cdr(message, message.__msgtype__))


WHOLE = {
    "std_msgs/Float64MultiArray": recordings.block(START, 1e-3, 7, [0.5, -0.25, math.nan]),
    "geometry_msgs/AccelStamped": recordings.accel(START, 3.0),
    "geometry_msgs/WrenchStamped": recordings.wrench(START, 3.0),
    "sensor_msgs/Temperature": recordings.temperature(START, 31.0),
    "sensor_msgs/Imu": recordings.imu(START, 3.0),
    "sensor_msgs/JointState": recordings.joint_state(START, joint=(0.1, 0.2, 0.3), other=(0.4, 0.5, 0.6)),
}
SOURCES: dict[str, dict[str, Any]] = {
    **{f"input.source: {word}": {"input.source": word, "input.sensor_radius": 0.5} for word in INPUT_SOURCES},
    **{f"load.source: {word}": {"load.source": word} for word, source in LOAD_SOURCES.items() if source},
    "input.temperature_topic": {"input.temperature_topic": "temperature"},
}


@pytest.mark.parametrize("setting", SOURCES)
def test_damaged_messages(setting: str) -> None:
    """What is whole in a batch is taken, whatever stands beside it."""
    settings = JointSettings.from_mapping(SOURCES[setting])
    extra = {"load": Quantity.TORQUE, "input.temperature_topic": Quantity.TEMPERATURE}
    quantity = extra.get(setting.partition(".source")[0], next(iter(settings.sources)))
    whole = serialised(WHOLE[settings.all_sources[quantity].type])

    def decode(messages: list[bytes]) -> None:
        counter = Counter()
        Inputs("joint", settings, counter).add(quantity, messages)
        assert counter.taken >= messages.count(whole)

    survive(decode, st.lists(st.just(whole) | damaged(whole), min_size=1, max_size=4), weight=4)


RECORDING = Recording(seconds=3.0)
treacherous = (
    st.sampled_from((0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, math.inf, -math.inf, math.nan)) | st.floats()
)
stamps = st.sampled_from((0, 1, EPOCH - 1, EPOCH, EPOCH + 10**9, EPOCH + 3 * 10**9)) | st.integers(0, 2**62)
odd_blocks = st.builds(
    Block,
    stamp=stamps,
    period=st.sampled_from((1e-3, 1e-4, 9.9)) | st.floats(1e-6, 10.0, exclude_max=True),
    sequence=st.integers(0, 40),
    samples=st.lists(treacherous, max_size=20).map(np.array),
)


def test_blocks_and_joint_states_into_a_monitor() -> None:
    """Some of an ordinary recording's blocks and joint states are odd: it is assessed all the same."""
    blocks = RECORDING.blocks()

    def run(odd: list[tuple[int, Block | tuple[int, float, float, float]]]) -> None:
        monitor = Monitor(JointSettings.from_mapping())
        chosen = dict(odd)
        for number, block in enumerate(blocks):
            RECORDING.feed_motion(monitor, slice(10 * number, 10 * number + 10))
            monitor.add_block(block)
            match chosen.get(number):
                case Block() as other:
                    monitor.add_block(other)
                case (stamp, *values):
                    monitor.add(Quantity.MOTION, [stamp], *([value] for value in values))
            for assessment in monitor.advance():
                put_into_words(assessment)
        if (last := monitor.finish()) is not None:
            put_into_words(last)

    joint = st.tuples(stamps, treacherous, treacherous, treacherous)
    survive(run, st.lists(st.tuples(st.integers(0, len(blocks) - 1), odd_blocks | joint), min_size=1, max_size=4))

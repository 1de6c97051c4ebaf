"""What a joint's status says between the monitor's own assessments, and that errors of the core end here."""

import math
from typing import Any

import pytest

from hd_monitor.monitor import Monitor
from hd_monitor.ros.joint_watch import JointWatch
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

pytestmark = pytest.mark.ros

SECOND = 1_000_000_000
START = 5 * SECOND
SPEED = 0.5  # rad/s of the output


def explain(name: Quantity) -> str:
    return f"because of the {name}"


def alone() -> str:
    return ""


def watch_of(**parameters: Any) -> JointWatch:
    settings = {name.replace("__", "."): value for name, value in parameters.items()}
    return JointWatch("elbow", JointSettings.from_mapping(settings), START, explain, alone)


def stamp_of(message: Any, time: float) -> Any:
    message.header.stamp.sec = int(time)
    message.header.stamp.nanosec = round(time % 1 * SECOND)
    return message


def joint_states(start: float, seconds: float, name: str = "elbow") -> list[bytes]:
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import JointState

    messages = []
    for step in range(round(100 * seconds)):
        time = start + step / 100
        message = JointState(name=[name], position=[SPEED * time], velocity=[SPEED], effort=[10.0])
        messages.append(serialize_message(stamp_of(message, time)))
    return messages


def accelerations(start: float, seconds: float) -> list[bytes]:
    from geometry_msgs.msg import AccelStamped
    from rclpy.serialization import serialize_message

    messages = []
    for step in range(round(500 * seconds)):
        time = start + step / 500
        message = AccelStamped()
        message.accel.angular.z = math.sin(math.tau * 13 * time)
        messages.append(serialize_message(stamp_of(message, time)))
    return messages


def inputs_of(vibration: list[bytes], motion: list[bytes]) -> dict[Quantity, list[bytes]]:
    return {Quantity.MOTION: motion, Quantity.VIBRATION: vibration}


def test_it_waits_before_it_complains() -> None:
    watch = watch_of(reducer__serial="A1")
    status = watch.status()
    assert (status.level, status.hardware_id) == (0, "A1")
    assert status.message.startswith("No verdict yet: nothing has been received")
    watch.check(START + SECOND)
    assert watch.status().value("fault_code") == "HD_WAITING"
    watch.check(START + 2 * SECOND)
    assert watch.status().value("fault_code") == "HD_INPUT_LOST"
    assert "because of the vibration" in watch.status().message
    assert "because of the motion" in watch.status().message


def test_good_data_is_assessed_and_the_transition_handed_out_once() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.check(START + 2 * SECOND)
    assert [s.value("fault_code") for s in watch.take_transitions()] == ["HD_INPUT_LOST"]
    assert watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    # The vibration is nothing but noise
    assert [s.value("fault_code") for s in watch.take_transitions()] == ["HD_WAITING", "HD_UNDETERMINED"]
    assert watch.take_transitions() == []
    assert float(watch.status().value("samples")) >= 500


def test_a_check_between_assessments_leaves_them_alone() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    before = watch.present
    watch.check(START + 4 * SECOND)
    watch.check(START + 4 * SECOND + 1)
    assert watch.present is before


def test_a_clock_that_is_set_back_restarts_the_silence() -> None:
    watch = watch_of()
    watch.check(START - 3 * SECOND)
    watch.check(START - 2 * SECOND)
    assert watch.status().value("fault_code") == "HD_WAITING"
    watch.check(START - SECOND)
    assert watch.status().value("fault_code") == "HD_INPUT_LOST"


def test_a_simulated_clock_that_has_not_begun_is_named() -> None:
    watch = JointWatch("elbow", JointSettings.from_mapping(), 0, explain, alone)
    watch.check(0)
    assert "/clock" in watch.status().message
    assert watch.status().value("fault_code") == "HD_UNDETERMINED"
    watch.check(1000 * SECOND)  # its first time is not a thousand seconds of silence
    assert watch.status().value("fault_code") == "HD_UNDETERMINED"


def test_an_error_of_the_core_is_shown_and_the_joint_restarts(monkeypatch: pytest.MonkeyPatch) -> None:
    watch = watch_of(input__source="accel_stamped")
    advance = Monitor.advance

    def fail(monitor: Monitor) -> Any:
        raise ZeroDivisionError("made for the test")

    monkeypatch.setattr(Monitor, "advance", fail)
    assert not watch.feed(inputs_of(accelerations(100, 1), joint_states(100, 1)), START + SECOND)
    status = watch.status()
    assert (status.level, status.value("fault_code")) == (2, "HD_INTERNAL_ERROR")
    assert "ZeroDivisionError: made for the test" in status.message
    assert "made for the test" in watch.last_error
    assert [s.value("fault_code") for s in watch.take_transitions()] == ["HD_INTERNAL_ERROR"]
    monkeypatch.setattr(Monitor, "advance", advance)
    assert watch.feed(inputs_of(accelerations(101, 2.5), joint_states(101, 2.5)), START + 3 * SECOND)
    assert watch.status().value("fault_code") == "HD_WAITING"
    assert watch.status().value("internal errors") == "1"


def test_several_publishers_are_named_beside_every_verdict() -> None:
    crowd = "two publishers on /a: /b, /c"
    watch = JointWatch(
        "elbow", JointSettings.from_mapping({"input.source": "accel_stamped"}), START, explain, lambda: crowd
    )
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    assert watch.status().message.endswith(f"; {crowd}")
    assert watch.status().value("reason").endswith(crowd)
    crowd = ""
    watch.feed(inputs_of(accelerations(102.5, 1), joint_states(102.5, 1)), START + 4 * SECOND)
    assert "publishers" not in watch.status().message


def test_new_limits_keep_the_evidence() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    samples = watch.status().value("samples")
    watch.change_limits(JointSettings.from_mapping({"input.source": "accel_stamped", "diagnosis.warn_index": 0.07}))
    watch.feed(inputs_of(accelerations(102.5, 1), joint_states(102.5, 1)), START + 4 * SECOND)
    assert watch.status().value("warn limit (%)") == "7.000"
    assert float(watch.status().value("samples")) > float(samples)


@pytest.mark.parametrize(
    ("source", "load", "inputs"),
    [
        ("joint_effort", "wrench", {Quantity.MOTION}),
        ("block", "auto", {Quantity.VIBRATION, Quantity.MOTION}),
        ("block", "wrench", {Quantity.VIBRATION, Quantity.MOTION, Quantity.TORQUE}),
    ],
)
def test_only_inputs_that_are_used_are_missed(source: str, load: str, inputs: set[Quantity]) -> None:
    asked: list[Quantity] = []

    def note(name: Quantity) -> str:
        asked.append(name)
        return "silence"

    settings = JointSettings.from_mapping({"input.source": source, "load.source": load})
    JointWatch("elbow", settings, START, note, alone).check(START + 10 * SECOND)
    assert set(asked) == inputs

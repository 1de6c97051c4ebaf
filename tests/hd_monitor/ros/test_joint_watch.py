"""What a joint's status says between the monitor's own assessments, and that errors of the core end here."""

import math
from typing import Any

import pytest

from hd_monitor.diagnosis.status import Status
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


def quiet(name: Quantity) -> str:
    return ""


def alone() -> str:
    return ""


def reducer(watch: JointWatch) -> Status:
    return watch.statuses()[0]


def inputs(watch: JointWatch) -> Status:
    return watch.statuses()[1]


def codes_of(transitions: list[tuple[Status, Status]]) -> list[tuple[str, ...]]:
    return [tuple(status.value("fault_code") for status in statuses) for statuses in transitions]


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


def test_it_waits_then_warns_then_complains_and_leaves_the_reducer_alone() -> None:
    watch = watch_of(reducer__serial="A1", input__startup_warning=2.0, input__startup_timeout=4.0)
    for seconds, level, code in ((1, 0, "WAITING"), (2, 1, "WAITING"), (3, 1, "WAITING"), (4, 2, "LOST")):
        watch.check(START + seconds * SECOND)
        assert (inputs(watch).level, inputs(watch).value("fault_code")) == (level, f"HD_INPUT_{code}")
        assert "because of the vibration" in inputs(watch).message
        assert "because of the motion" in inputs(watch).message
        assert (reducer(watch).level, reducer(watch).value("fault_code")) == (0, "HD_WAITING")
        assert reducer(watch).hardware_id == inputs(watch).hardware_id == "A1"
    assert codes_of(watch.take_transitions()) == [("HD_WAITING", "HD_INPUT_WAITING"), ("HD_WAITING", "HD_INPUT_LOST")]


def test_one_state_has_one_message() -> None:
    watch = watch_of()
    said = set()
    for seconds in (1, 5, 9, 31, 1000):
        watch.check(START + seconds * SECOND)
        said.add((inputs(watch).value("fault_code"), inputs(watch).message))
    assert len(said) == 2


def test_good_data_is_assessed_and_the_transition_handed_out_once() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.check(START + 30 * SECOND)
    assert codes_of(watch.take_transitions()) == [("HD_WAITING", "HD_INPUT_LOST")]
    assert watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 31 * SECOND)
    # Of so few samples nothing is said at first; then the vibration is nothing but noise
    codes = codes_of(watch.take_transitions())
    assert codes == [("HD_WAITING", "HD_INPUT_OK"), ("HD_UNDETERMINED", "HD_INPUT_OK")]
    assert watch.take_transitions() == []
    assert float(reducer(watch).value("samples")) >= 500


def test_what_has_come_is_no_longer_awaited_although_nothing_is_judged_yet() -> None:
    watch = JointWatch("elbow", JointSettings.from_mapping({"input.source": "accel_stamped"}), START, quiet, alone)
    assert inputs(watch).message == "No joint states and no vibration signal yet"
    watch.feed(inputs_of(accelerations(100, 0.5), joint_states(100, 0.5)), START + SECOND)
    watch.check(START + SECOND)
    assert inputs(watch).value("fault_code") == "HD_INPUT_OK"
    assert reducer(watch).value("fault_code") == "HD_WAITING"


def test_the_verdict_outlives_silence_with_its_age() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    before = reducer(watch)
    assert before.value("evidence age (s)") == "0"
    watch.check(START + 4 * SECOND)
    for seconds in (8, 60):
        watch.check(START + seconds * SECOND)
        after = reducer(watch)
        assert (after.level, after.message) == (before.level, before.message)
        assert after.value("fault_code") == "HD_UNDETERMINED"
        assert after.value("evidence age (s)") == str(seconds - 3)
        assert inputs(watch).value("fault_code") == "HD_INPUT_LOST"
    watch.feed(inputs_of(accelerations(160, 2.5), joint_states(160, 2.5)), START + 62 * SECOND)
    assert inputs(watch).value("fault_code") == "HD_INPUT_OK"
    assert reducer(watch).value("evidence age (s)") == "0"


def test_a_pause_shorter_than_the_timeout_goes_unnoticed() -> None:
    """A reliable topic pauses for 3 s where Fast DDS has to repeat a lost datagram."""
    watch = watch_of(input__source="accel_stamped")
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    watch.take_transitions()
    for seconds in (4, 5, 6):
        watch.check(START + seconds * SECOND)
    assert inputs(watch).value("fault_code") == "HD_INPUT_OK"
    assert watch.take_transitions() == []


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
    watch.check(START + 6 * SECOND)
    assert (inputs(watch).level, inputs(watch).value("fault_code")) == (0, "HD_INPUT_WAITING")
    watch.check(START + 7 * SECOND)
    assert inputs(watch).level == 1


def test_a_simulated_clock_that_has_not_begun_is_named_and_warned_of() -> None:
    settings = JointSettings.from_mapping({"input.startup_warning": 3.0})
    watch = JointWatch("elbow", settings, 0, explain, alone)
    for level in (0, 0, 1, 1):
        watch.check(0)
        assert "/clock" in inputs(watch).message
        assert (inputs(watch).level, inputs(watch).value("fault_code")) == (level, "HD_INPUT_WAITING")
    watch.check(1000 * SECOND)  # its first time is not a thousand seconds of silence
    assert (inputs(watch).level, inputs(watch).value("fault_code")) == (0, "HD_INPUT_WAITING")
    assert "because of the motion" in inputs(watch).message


def test_an_error_of_the_core_is_shown_and_the_joint_restarts(monkeypatch: pytest.MonkeyPatch) -> None:
    watch = watch_of(input__source="accel_stamped")
    advance = Monitor.advance

    def fail(monitor: Monitor) -> Any:
        raise ZeroDivisionError("made for the test")

    monkeypatch.setattr(Monitor, "advance", fail)
    assert not watch.feed(inputs_of(accelerations(100, 1), joint_states(100, 1)), START + SECOND)
    status = reducer(watch)
    assert (status.level, status.value("fault_code")) == (2, "HD_INTERNAL_ERROR")
    assert "ZeroDivisionError: made for the test" in status.message
    assert "made for the test" in watch.last_error
    assert [reducer for reducer, _ in codes_of(watch.take_transitions())] == ["HD_INTERNAL_ERROR"]
    monkeypatch.setattr(Monitor, "advance", advance)
    assert watch.feed(inputs_of(accelerations(101, 2.5), joint_states(101, 2.5)), START + 3 * SECOND)
    assert reducer(watch).value("fault_code") == "HD_WAITING"
    assert reducer(watch).value("internal errors") == "1"


def test_several_publishers_are_named_by_the_inputs_status() -> None:
    crowd = "two publishers on /a: /b, /c"
    watch = JointWatch(
        "elbow", JointSettings.from_mapping({"input.source": "accel_stamped"}), START, explain, lambda: crowd
    )
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    assert inputs(watch).message.endswith(f"; {crowd}")
    assert inputs(watch).value("reason").endswith(crowd)
    assert "publishers" not in reducer(watch).value("reason")
    crowd = ""
    watch.feed(inputs_of(accelerations(102.5, 1), joint_states(102.5, 1)), START + 4 * SECOND)
    assert "publishers" not in inputs(watch).message


def test_other_timeouts_count_for_what_is_missing_already() -> None:
    watch = watch_of(input__startup_timeout=60.0)
    watch.check(START + 40 * SECOND)
    assert inputs(watch).value("fault_code") == "HD_INPUT_WAITING"
    watch.change(JointSettings.from_mapping({"input.startup_timeout": 40.0}))
    watch.check(START + 41 * SECOND)
    assert inputs(watch).value("fault_code") == "HD_INPUT_LOST"


def test_an_input_on_another_topic_is_awaited_as_if_nothing_of_it_had_come() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    watch.await_anew(Quantity.VIBRATION, START + 4 * SECOND)
    watch.check(START + 4 * SECOND)
    watch.check(START + 5 * SECOND)
    assert inputs(watch).message == "No vibration signal yet: because of the vibration"


def test_new_limits_keep_the_evidence() -> None:
    watch = watch_of(input__source="accel_stamped")
    watch.feed(inputs_of(accelerations(100, 2.5), joint_states(100, 2.5)), START + 3 * SECOND)
    samples = reducer(watch).value("samples")
    watch.change(JointSettings.from_mapping({"input.source": "accel_stamped", "diagnosis.warn_index": 0.07}))
    assert reducer(watch).value("warn limit (%)") == "7.000"
    watch.feed(inputs_of(accelerations(102.5, 1), joint_states(102.5, 1)), START + 4 * SECOND)
    assert reducer(watch).value("warn limit (%)") == "7.000"
    assert float(reducer(watch).value("samples")) > float(samples)


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

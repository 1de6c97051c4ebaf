"""Topics are found by name, type and content, in any namespace; doubt is a question, not a guess."""

from collections.abc import Mapping

import pytest

from hd_monitor.offline.batches import RawTopic
from hd_monitor.offline.errors import BagError
from hd_monitor.offline.topics import TopicFinder
from hd_monitor.settings import JointSettings
from hd_monitor.sources import INPUT_SOURCES, Quantity, Source

ARRAY, ACCEL = "std_msgs/msg/Float64MultiArray", "geometry_msgs/msg/AccelStamped"
IMU, STATE = "sensor_msgs/msg/Imu", "sensor_msgs/msg/JointState"
BLOCK = "torsional_acceleration/block"


def finder(
    topics: Mapping[str, str],
    *,
    labels: Mapping[str, str] | None = None,
    namespace: str | None = None,
    remap: Mapping[str, str] | None = None,
    empty: tuple[str, ...] = (),
) -> TopicFinder:
    raw = [RawTopic(name, kind, 0 if name in empty else 5) for name, kind in topics.items()]
    return TopicFinder(raw, lambda name: ((labels or {}).get(name, ""),), namespace=namespace, remap=remap)


def found(vibration: str, motion: str) -> dict[Quantity, str]:
    return {Quantity.VIBRATION: vibration, Quantity.MOTION: motion}


def sources_of(name: str) -> dict[Quantity, Source]:
    return JointSettings.from_mapping({"input.source": name}).sources


def test_plain_names() -> None:
    find = finder({f"/{BLOCK}": ARRAY, "/joint_states": STATE, "/zoom_spectrum": ARRAY})
    assert find.joint_topics(sources_of("block")) == found(f"/{BLOCK}", "/joint_states")


@pytest.mark.parametrize(
    ("source", "kind", "topic"),
    [("accel_stamped", ACCEL, "torsional_acceleration"), ("imu", IMU, "imu/data_raw")],
)
def test_every_source_has_its_topic(source: str, kind: str, topic: str) -> None:
    find = finder({f"/arm/{topic}": kind, "/arm/joint_states": STATE})
    assert find.joint_topics(sources_of(source)) == {
        Quantity.VIBRATION: f"/arm/{topic}",
        Quantity.MOTION: "/arm/joint_states",
    }


def test_the_sensorless_mode_needs_joint_states_only() -> None:
    find = finder({"/joint_states": STATE})
    assert find.joint_topics(sources_of("joint_effort")) == {Quantity.MOTION: "/joint_states"}


def test_several_joints_have_their_topics_below_their_names() -> None:
    find = finder({f"/elbow/{BLOCK}": ARRAY, f"/wrist/{BLOCK}": ARRAY, "/joint_states": STATE})
    assert find.joint_topics(sources_of("block"), "wrist")[Quantity.VIBRATION] == f"/wrist/{BLOCK}"
    assert sorted(find.prefixes(INPUT_SOURCES["block"])) == ["elbow", "wrist"]


def test_several_candidates_are_listed_and_the_root_goes_first() -> None:
    topics = {f"/left/{BLOCK}": ARRAY, f"/right/{BLOCK}": ARRAY, "/joint_states": STATE}
    with pytest.raises(BagError, match=r"/left/.*/right/.*--namespace"):
        finder(topics).joint_topics(sources_of("block"))
    assert finder(topics | {f"/{BLOCK}": ARRAY}).joint_topics(sources_of("block"))[Quantity.VIBRATION] == f"/{BLOCK}"


def test_a_namespace_chooses() -> None:
    topics = {f"/{side}/{topic}": kind for side in "lr" for topic, kind in ((BLOCK, ARRAY), ("joint_states", STATE))}
    find = finder(topics, namespace="/r")
    assert find.joint_topics(sources_of("block")) == {
        Quantity.VIBRATION: f"/r/{BLOCK}",
        Quantity.MOTION: "/r/joint_states",
    }
    with pytest.raises(BagError, match="no /x/joint_states"):
        finder(topics, namespace="x").joint_topics(sources_of("block"))


def test_remapping_goes_before_everything() -> None:
    find = finder(
        {f"/{BLOCK}": ARRAY, "/my/blocks": ARRAY, "/js": STATE}, remap={BLOCK: "/my/blocks", "joint_states": "js"}
    )
    assert find.joint_topics(sources_of("block")) == found("/my/blocks", "/js")
    with pytest.raises(BagError, match="no /nowhere"):
        finder({"/js": STATE}, remap={"joint_states": "/nowhere"}).joint_topics(sources_of("joint_effort"))


def test_an_odd_name_is_found_by_its_type_or_by_its_label() -> None:
    find = finder(
        {"/rig/blocks": ARRAY, "/zoom": ARRAY, "/js": STATE, "/a": ACCEL},
        labels={"/rig/blocks": "torsional_acceleration", "/zoom": "bin"},
    )
    assert find.joint_topics(sources_of("block")) == found("/rig/blocks", "/js")
    assert find.joint_topics(sources_of("accel_stamped"))[Quantity.VIBRATION] == "/a"


@pytest.mark.parametrize(
    ("topics", "empty", "words"),
    [
        ({"/camera": "sensor_msgs/msg/Image"}, (), r"it holds /camera \(sensor_msgs/Image\)"),
        ({"/joint_states": "my_msgs/msg/JointState"}, (), "is there, but as my_msgs/JointState"),
        ({"/joint_states": STATE, "/x": STATE, "/y": STATE}, ("/joint_states", "/x", "/y"), "without a message"),
    ],
)
def test_missing_topics_are_reported_with_others(topics: dict[str, str], empty: tuple[str, ...], words: str) -> None:
    with pytest.raises(BagError, match=words) as caught:
        finder(topics, empty=empty).joint_topics(sources_of("joint_effort"))
    assert "\n" not in str(caught.value)


def test_the_vibration_is_found_by_the_name_that_the_parameters_give() -> None:
    settings = JointSettings.from_mapping({"input.source": "imu", "input.topic": "wrist_imu"})
    vibration = {Quantity.VIBRATION: settings.sources[Quantity.VIBRATION]}
    find = finder(dict.fromkeys(["/imu/data_raw", "/arm/wrist_imu"], "sensor_msgs/msg/Imu"))
    assert find.joint_topics(vibration) == {Quantity.VIBRATION: "/arm/wrist_imu"}


@pytest.mark.parametrize(
    ("given", "joint", "topics", "expected"),
    [
        ("", None, ["/arm/wrench", "/other"], "/arm/wrench"),
        ("", None, ["/some_sensor"], "/some_sensor"),
        ("", "wrist", ["/elbow/wrench", "/wrist/wrench"], "/wrist/wrench"),
        ("/ft/wrench", "wrist", ["/wrist/ft/wrench", "/ft/wrench"], "/ft/wrench"),
    ],
)
def test_a_wrench_is_found_by_the_name_that_the_parameters_give(
    given: str, joint: str | None, topics: list[str], expected: str
) -> None:
    settings = JointSettings.from_mapping({"load.source": "wrench", "load.topic": given})
    torque = {Quantity.TORQUE: settings.sources[Quantity.TORQUE]}
    find = finder(dict.fromkeys(topics, "geometry_msgs/msg/WrenchStamped"))
    assert find.joint_topics(torque, joint) == {Quantity.TORQUE: expected}

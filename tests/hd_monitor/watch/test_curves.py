"""Curves as the node publishes them come back; whose they are follows from the topic."""

from typing import Any

import numpy as np
import pytest

from hd_monitor.errors import LayoutError
from hd_monitor.watch.curves import Curve, curve_from, curve_of, topic_of

typesys = pytest.importorskip("rosbags.typesys")
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
T = STORE.types


def array(sizes: tuple[int, ...], data: Any) -> bytes:
    dimensions = [T["std_msgs/msg/MultiArrayDimension"]("d", size, size) for size in sizes]
    layout = T["std_msgs/msg/MultiArrayLayout"](dimensions, 0)
    message = T["std_msgs/msg/Float64MultiArray"](layout, np.asarray(data, dtype=np.float64))
    return bytes(STORE.serialize_cdr(message, "std_msgs/msg/Float64MultiArray"))


def test_planes_and_rows_of_points_are_read() -> None:
    x, y = np.arange(50.0), np.arange(50.0) ** 2
    expected = Curve(tuple(x.tolist()), tuple(y.tolist()))
    assert curve_from(array((2, 50), np.concatenate((x, y))), "zoom_spectrum") == expected
    assert curve_from(array((2, 3), [200.0, 1.5, 9.0, 300.0, 2.5, 9.0]), "rms_curve") == Curve(
        (200.0, 300.0), (1.5, 2.5)
    )


def test_points_that_are_not_finite_are_left_out() -> None:
    assert curve_of([1.0, 2.0, 3.0], [1.0, np.nan, 3.0]) == Curve((1.0, 3.0), (1.0, 3.0))
    assert curve_of([], []) == Curve((), ())


@pytest.mark.parametrize(("sizes", "count"), [((2, 50), 99), ((4,), 4), ((), 0), ((1, 50), 50), ((0, 2), 0)])
def test_another_layout_is_refused(sizes: tuple[int, ...], count: int) -> None:
    with pytest.raises(LayoutError, match=rf"announces .* carries {count} values"):
        curve_from(array(sizes, np.zeros(count)), "zoom_spectrum")


def test_one_of_several_joints_has_its_topics_below_its_name() -> None:
    topics = {"/arm/rms_curve", "/arm/elbow/rms_curve", "/rms_curve"}
    assert topic_of(topics, "/arm/hd_monitor_node", "elbow", "rms_curve") == "/arm/elbow/rms_curve"
    assert topic_of(topics, "/arm/hd_monitor_node", "wrist", "rms_curve") == "/arm/rms_curve"
    assert topic_of(topics, "/hd_monitor_node", "wrist", "rms_curve") == "/rms_curve"
    assert topic_of(topics, "/leg/hd_monitor_node", "wrist", "rms_curve") is None

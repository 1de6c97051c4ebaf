"""Whatever a status says, it fits the screen."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor.cdr import ReceivedStatus
from hd_monitor.diagnosis.verdict import Component, FaultCode
from hd_monitor.watch import panels
from hd_monitor.watch.curves import Curve
from hd_monitor.watch.lines import Line, text_of
from hd_monitor.watch.state import Key, View

from .statuses import NODE, inputs, reducer, seen, sound

ELBOW = Key(NODE, "elbow")
KEYS = [key for key in reducer(
    flexspline_index=(1.0, 0.1), circular_spline_index=(1.0, 0.1), flexspline_share=(1.0, 0.1),
    flexspline_line_growth=(1.0, 0.1), flexspline_transmission_error=(1.0, 0.1),
    circular_spline_transmission_error=(1.0, 0.1),
).values if key.endswith(")")] + ["evidence age (s)", "speed (rpm)", "travel (deg)", "misfit"]  # fmt: skip
numbers = st.one_of(
    st.floats(-1e3, 1e3).map("{:.3f}".format),
    st.floats().map(str),
    st.sampled_from(["0", "", "unknown", "1e-9", "1e300"]),
)
finite = st.floats(-1e11, 1e11)
curves = st.lists(st.tuples(finite, finite), max_size=60).map(
    lambda points: Curve(tuple(sorted(x for x, _ in points)), tuple(y for _, y in points))
)


def longest(rows: list[Line]) -> int:
    return max(len(row) for row in text_of(rows).splitlines())


@settings(max_examples=300)
@given(
    values=st.dictionaries(st.sampled_from(KEYS), numbers),
    component=st.sampled_from([*Component, "wave_generator"]),
    code=st.sampled_from([*FaultCode, "HD_NEW"]),
    level=st.integers(0, 3),
    text=st.text(max_size=200),
    width=st.integers(80, 220),
    found=st.lists(curves, min_size=3, max_size=3),
)
def test_no_status_and_no_curve_breaks_the_screen(
    values: dict[str, str], component: str, code: str, level: int, text: str, width: int, found: list[Curve]
) -> None:
    words = {"component": component, "fault_code": code, "reason": text, "joint": "elbow"}
    view = seen(ReceivedStatus(f"{NODE}: elbow reducer", level, text, text, words | values), inputs(reason=text))
    view = view.with_curves(zip([ELBOW] * 3, ("zoom_spectrum", "rms_curve", "rms_curve/baseline"), found, strict=True))
    joint = view.joints[ELBOW]
    assert longest(panels.listing(view, joint, width, 5)) <= width
    assert longest([panels.title(view, width)]) <= width
    assert longest(panels.curves(joint, width, 30)) <= width
    assert panels.detail(joint, view, width)


@pytest.mark.parametrize("width", [1, 10, 40])
def test_a_tiny_terminal_breaks_nothing(width: int) -> None:
    view = seen(sound(), inputs())
    joint = view.joints[ELBOW]
    for rows in (panels.detail(joint, view, width), panels.listing(view, joint, width, 1), panels.waiting(view, width)):
        assert rows


def test_joints_of_several_nodes_are_told_by_their_namespace() -> None:
    other = sound()
    view = seen(sound(), other._replace(name=other.name.replace("/arm", "/left")))
    text = text_of(panels.listing(view, view.ranked[0], 80, 5))
    assert "arm/elbow" in text
    assert "left/elbow" in text


def test_a_status_of_the_input_alone_is_shown_as_waiting() -> None:
    view = seen(inputs())
    text = text_of(panels.detail(view.joints[ELBOW], view, 80))
    assert "elbow: WAITING, no verdict yet" in text
    assert "the reducer's status" in text


def test_a_clock_that_is_set_back_gives_no_negative_duration() -> None:
    view = seen(sound(), at=100)
    view = seen(sound(), at=50, view=replace(view))
    text = text_of(panels.detail(view.joints[ELBOW], view, 80))
    assert "at least 0 s" in text


def test_programs_that_are_not_ours_are_left_out() -> None:
    foreign = ReceivedStatus("/camera: driver input", 2, "no frames", "", {})
    view: View = seen(foreign, foreign._replace(name="battery"))
    assert not view.joints

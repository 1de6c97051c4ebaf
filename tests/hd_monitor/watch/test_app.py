"""The screen, read as a technician would: by its letters, without a colour."""

import math
from dataclasses import replace
from typing import Any

import pytest

from hd_monitor import contract
from hd_monitor.watch.app import WatchApp
from hd_monitor.watch.curves import Curve
from hd_monitor.watch.state import Key, View

from .statuses import NODE, Fixed, defective, inputs, reducer, screen, screen_after, seen, sound, use

ELBOW = Key(NODE, "elbow")


def shown(*views: View, keys: tuple[str, ...] = (), size: tuple[int, int] = (80, 24), ascii_only: bool = False) -> str:
    return screen_after(WatchApp(Fixed(*views), ascii_only=ascii_only), *keys, size=size)


def line_with(text: str, screen: str) -> str:
    (found,) = [line for line in screen.splitlines() if text in line]
    return found


def test_without_data_it_says_what_to_check() -> None:
    text = shown()
    assert "0 joints" in text
    assert "No joint has been heard of yet" in text
    assert "To do    Start the node" in text


def test_a_sound_joint() -> None:
    text = shown(seen(sound(), inputs()))
    assert "1 joint: 1 OK" in text
    row = line_with(">OK", text).split()
    assert row == [">OK", "elbow", "none:", "sound", "0.4", "x", "warn", "1.7–2.5", "%", "ok", ">0", "s"]
    assert "How bad  Circular spline index 2.1 %: 0.4 times the warn limit of 5 %" in text
    assert "How sure 95 % sure of 1.7 to 2.5 %: below the warn limit" in text
    assert "To do    Nothing" in text


@pytest.mark.parametrize(
    ("level", "index", "bad", "sure", "advice"),
    [
        (1, 6.0, "1.2 times the warn limit of 5 %", "5.2 to 6.8 %: above the warn limit", "Plan an inspection"),
        (2, 10.3, "1.3 times the error limit of 8 %", "9.5 to 11.1 %: above the error limit", "Inspect the flexspline"),
    ],
)
def test_a_bad_part_with_its_interval(level: int, index: float, bad: str, sure: str, advice: str) -> None:
    name = ("OK", "WARN", "ERROR")[level]
    view = seen(sound(), inputs())
    for at in (100, 130):
        view = seen(defective(level=level, index=index), at=at, view=view)
    text = shown(view)
    assert f"elbow: {name}, flexspline" in text
    assert f"How bad  Flexspline index {index} %: {bad}" in text
    assert f"How sure 95 % sure of {sure}" in text
    assert f"To do    {advice}" in text
    assert "Since    second 100.0, for 30 s; before that OK, none" in text
    bar = line_with(" ± 0.40 ", text)
    assert "█" in bar
    assert "▒" in bar
    assert sure.partition(": ")[2].replace(" the", "").removesuffix(" limit") in bar
    assert f".{'W' if level == 1 else 'E'}" in text  # the history's letters


def test_waiting_is_no_warning_and_names_what_is_missing() -> None:
    reason = "No verdict yet: only 72° of travel seen, at least 157° are needed"
    text = shown(seen(reducer(component="undetermined", code="HD_WAITING", reason=reason), inputs()))
    assert "1 joint: 1 WAITING" in text
    assert "elbow: WAITING, no verdict yet" in text
    assert "How bad  Not known yet" in text
    assert "Missing  only 72° of travel seen, at least 157° are needed" in text


def test_a_lost_input_is_told_first_and_the_verdict_stays() -> None:
    reason = "No vibration signal: nothing publishes /elbow/torsional_acceleration/block"
    text = shown(seen(defective(), inputs(level=2, code="HD_INPUT_LOST", reason=reason)))
    assert " LOST " in line_with(">ERROR", text)
    assert "elbow: ERROR, flexspline" in text
    assert "To do    Restore the input: No vibration signal: nothing publishes" in text
    assert "Missing  input: No vibration signal" in text


def test_a_node_that_falls_silent_is_gone_but_its_verdict_stays() -> None:
    view = seen(defective(), inputs())
    assert "1 joint: 1 ERROR" in shown(replace(view, now=4.9))
    text = shown(replace(view, now=75.0))
    assert "elbow: GONE, flexspline" in text
    assert f"To do    Start {NODE} again" in text
    assert "Missing  the node: no status for 75 s" in text
    assert "Flexspline index 10.3 %" in text
    assert "GONE" not in shown(replace(view, now=75.0, live=False))  # a recording cannot fall silent


def test_parts_that_cannot_be_rated_are_compared_with_each_other() -> None:
    shares = {"flexspline_share": (83.1, 2.0), "circular_spline_share": (55.6, 2.0)}
    text = shown(seen(reducer("elbow", 0, "flexspline", "HD_UNRATED", "dominates", **shares), inputs()))
    assert "UNRATED" in text
    assert "How bad  Flexspline share 83.1 % of the pair; without a torque its size has no" in text
    assert "limit of nan" not in text


def test_against_a_baseline_the_growth_decides_and_not_the_share() -> None:
    growth = {"flexspline_line_growth": (43.0, 5.0), "circular_spline_line_growth": (-3.0, 4.0)}
    shares = {"flexspline_share": (83.1, 2.0), "circular_spline_share": (55.6, 2.0)}
    text = shown(seen(reducer("elbow", 1, "flexspline", "HD_FLEXSPLINE", "has grown", **growth, **shares), inputs()))
    assert "grown 43 %" in line_with(">WARN", text)
    assert "How bad  Flexspline line growth 43.0 % against the baseline" in text
    assert "How sure 95 % sure of 33.2 to 52.8 %" in text
    assert "-3.0 ± 4.0" in text  # less than nothing is possible here


def six() -> View:
    joints = ["base", "elbow", "shoulder", "wrist_1", "wrist_2", "wrist_3"]
    statuses = [status for joint in joints for status in (sound(joint), inputs(joint))]
    return seen(*statuses, defective("wrist_2", level=1, index=6.0), defective("wrist_3"), at=2, view=seen(*statuses))


def test_six_joints_fit_a_small_terminal_with_the_worst_first_and_shown() -> None:
    text = shown(six())
    rows = [" ".join(line.split()[:2]) for line in text.splitlines()[2:8]]
    assert rows == [">ERROR wrist_3", "WARN wrist_2", "OK base", "OK elbow", "OK shoulder", "OK wrist_1"]
    for answer in ("wrist_3: ERROR, flexspline", "How bad", "How sure", "To do", "Since", "circular spline", "History"):
        assert answer in text
    assert len(text.splitlines()) == 24
    assert "q: quit" in text.splitlines()[-1]


def test_keys_select_a_joint_and_return_to_the_worst() -> None:
    assert "wrist_2: WARN" in shown(six(), keys=("down",))
    assert "base: OK" in shown(six(), keys=("down", "down", "down", "up"))
    assert "wrist_1: OK" in shown(six(), keys=("down",) * 9)
    assert "wrist_3: ERROR" in shown(six(), keys=("down", "down", "w"))


def test_a_joint_that_was_chosen_stays_when_another_gets_worse() -> None:
    before = six()
    after = seen(defective("base"), at=3, view=before)
    app = WatchApp(Fixed(before, after))

    async def act(pilot: Any) -> None:
        await pilot.press("down")
        app.look()
        await pilot.pause()
        text = screen(app)
        assert "wrist_2: WARN" in text
        assert ">WARN" in text
        await pilot.press("w")
        await pilot.pause()
        assert "base: ERROR" in screen(app)

    use(app, act)


def test_a_click_selects_the_joint_of_the_row() -> None:
    app = WatchApp(Fixed(six()))

    async def act(pilot: Any) -> None:
        await pilot.click("#joints", offset=(10, 3))
        await pilot.pause()
        assert "base: OK" in screen(app)

    use(app, act)


def test_more_joints_than_rows_scroll_with_the_selection() -> None:
    statuses = [status for number in range(40) for status in (sound(f"axis_{number:02}"), inputs(f"axis_{number:02}"))]
    view = seen(*statuses)
    text = shown(view)
    assert "axis_00" in text
    assert "and 33 more" in text
    text = shown(view, keys=("down",) * 30)
    assert line_with(">OK", text).split()[1] == "axis_30"
    assert "axis_30: OK" in text


def test_help_opens_and_closes_and_q_quits() -> None:
    assert "follow it" in shown(six(), keys=("question_mark",))
    assert "follow it" not in shown(six(), keys=("question_mark", "escape"))
    app = WatchApp(Fixed(six()))

    async def act(pilot: Any) -> None:
        await pilot.press("q")
        await pilot.pause()
        assert app.return_code == 0

    use(app, act)


def with_curves() -> View:
    frequencies = tuple(56.0 + 0.07 * place for place in range(50))
    peak = Curve(frequencies, tuple(17.0 * math.exp(-(((f - 57.96) / 0.1) ** 2)) for f in frequencies))
    rms = Curve((200.0, 300.0, 900.0), (1.0, 2.0, 8.0))
    baseline = Curve((200.0, 300.0), (1.0, 2.0))
    names = (contract.ZOOM_SPECTRUM, contract.RMS_CURVE, contract.RMS_BASELINE)
    view = seen(defective(), inputs())
    return view.with_curves((ELBOW, name, curve) for name, curve in zip(names, (peak, rms, baseline), strict=True))


def test_curves_stand_beside_the_answers_where_there_is_room() -> None:
    text = shown(with_curves(), size=(200, 60))
    assert "elbow: ERROR, flexspline" in line_with("Zoom spectrum", text)
    assert "17 at 57.96 Hz" in text
    assert "56" in line_with("59.43 Hz", text)
    assert "200" in line_with("900 rpm", text)
    assert "o: the baseline" in text
    assert "Missing  nothing" in text
    assert "TO DO" in text


def test_curves_are_below_the_answers_where_there_is_not() -> None:
    assert "RMS by" not in shown(with_curves())
    text = shown(with_curves(), keys=("pagedown",))
    assert "RMS by" in text
    assert "How sure" not in text
    assert "How sure" in shown(with_curves(), keys=("pagedown", "pageup"))


@pytest.mark.parametrize("size", [(80, 24), (200, 60)])
def test_letters_suffice(size: tuple[int, int]) -> None:
    text = shown(with_curves(), size=size, ascii_only=True)
    assert text.isascii()
    assert "10.30 +- 0.40" in text
    assert "#####" in text


def test_what_comes_from_the_network_cannot_command_the_terminal() -> None:
    text = shown(seen(reducer("el\x1b[2Jbow\n", reason="fine \x07\x1b]0;title\x07")))
    assert "el [2Jbow" in text


def test_an_error_of_the_source_ends_the_screen_and_is_kept() -> None:
    class Failing(Fixed):
        def update(self, view: View, now: float) -> View:
            raise OSError("made for the test")

    with pytest.raises(OSError, match="made for the test"):
        screen_after(WatchApp(Failing()))

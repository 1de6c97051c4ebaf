"""What replay advises about the tooth numbers never contradicts what identify says of them, whatever hums along."""

import json
import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.arrays import FloatArray
from hd_monitor.cli.main import main

Tone = Callable[[FloatArray, FloatArray], FloatArray]
"""Of times [s] and output angles [rad], with an amplitude of 1."""

TONES: dict[str, Tone] = {
    "none": lambda times, _: np.zeros(times.size),
    "mains": lambda times, _: np.cos(math.tau * 50.0 * times),
    "order 2.05": lambda _, angles: np.cos(2.05 * 80.0 * angles + 0.3),
}
MOTIONS: dict[str, dict[str, Any]] = {
    "one speed": {"programme": "fixed", "fixed__speed": 1200.0, "duration": 10.0},
    "run-up": {"programme": "sweep", "sweep__first": 600.0, "sweep__last": 1800.0, "duration": 12.0},
}
SENSORLESS = ("-p", "input.source:=joint_effort")
TRUE = (160, 162)


def with_sensor(motion: str, tone: Tone) -> list[rec.Event]:
    """A rig whose flexspline is bad, with a tone of half the power of all of its vibration."""
    events = rec.simulated(**MOTIONS[motion], defect="flexspline")
    blocks = [event.message.data for event in events if event.topic.endswith("block")]
    states = [event.message for event in events if event.topic.endswith("joint_states")]
    known = [(state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec, state.position[0]) for state in states]
    times, angles = np.array(sorted(known)).T
    level = float(np.std(np.concatenate([data[4:] for data in blocks])))
    for data in blocks:
        at = data[0] + 1e-9 * data[1] + data[2] * np.arange(data.size - 4)
        data[4:] += level * tone(at - times[0], np.interp(at, times, np.unwrap(angles)))
    return events


def without_sensor(tone: Tone) -> list[rec.Event]:
    """A swinging joint in whose effort both lines stand, with a tone as strong as the larger one."""
    times = np.arange(0.0, 60.0, 0.008)
    angle = 1.4 * np.sin(0.45 * times) + 0.2 * np.sin(1.1 * times)
    speed = 0.63 * np.cos(0.45 * times) + 0.22 * np.cos(1.1 * times)
    effort = 4.0 * np.sin(angle) + 0.2 * np.cos(160.0 * angle) + 0.4 * np.cos(162.0 * angle + 1.0)
    effort += 0.4 * tone(times, angle) + 0.1 * np.random.default_rng(1).standard_normal(times.size)
    stamps = (rec.START + np.rint(1e9 * times)).astype(np.int64).tolist()
    rows = zip(stamps, angle.tolist(), speed.tolist(), effort.tolist(), strict=True)
    return [rec.Event(stamp, "/joint_states", rec.joint_state(stamp, joint=(a, v, e))) for stamp, a, v, e in rows]


class Said(NamedTuple):
    """What both commands say of one recording with the same teeth given."""

    component: str
    advice: frozenset[tuple[int, int]]
    """Teeth that explain it far better than those given, by either command."""
    table: tuple[int, int] | None
    """Teeth that identify's table is sure of."""

    @classmethod
    def of(cls, bag: Path, shift: int, options: Sequence[str] = ()) -> "Said":
        """Run both on a recording, with teeth that are wrong by `shift`."""
        names = ("reducer.flexspline_teeth", "reducer.circular_spline_teeth")
        given = [part for name, z in zip(names, TRUE, strict=True) for part in ("-p", f"{name}:={z + shift}")]
        replayed, identified = (_joint_of(command, bag, [*given, *options]) for command in ("replay", "identify"))
        sentences = [replayed["verdict"]["reason"], *identified["blockers"]]
        found = [re.search(r"(\d+)/(\d+) teeth.* far better than", sentence) for sentence in sentences]
        best = identified["teeth"]["ranked"][0]
        return cls(
            component=replayed["verdict"]["component"],
            advice=frozenset((int(match[1]), int(match[2])) for match in found if match),
            table=(best["flexspline_teeth"], best["circular_spline_teeth"])
            if identified["teeth"]["conclusive"]
            else None,
        )


def _joint_of(command: str, bag: Path, options: Sequence[str]) -> dict[str, Any]:
    out = bag.parent / f"{command}.json"
    assert main([command, str(bag), "--json", str(out), "-p", "reducer.transmission_error:=0.0", *options]) == 0
    (joint,) = json.loads(out.read_text(encoding="utf-8"))["joints"]
    return dict(joint)


def check(bag: Path, shifts: Sequence[int], options: Sequence[str] = ()) -> dict[int, Said]:
    """Hold both commands' words on a recording, by the error of the teeth given, against each other."""
    said = {shift: Said.of(bag, shift, options) for shift in shifts}
    for shift, words in said.items():
        given = (TRUE[0] + shift, TRUE[1] + shift)
        assert len(words.advice) <= 1, (shift, words)
        assert given not in words.advice, (shift, words)
        if words.table is not None:
            assert words.advice <= {words.table}, (shift, words)
        if shift or words.table not in (None, given):
            assert words.component in {"undetermined", "none"}, (shift, words)
    if 0 in said:
        assert not said[0].advice
        assert said[0].table in (None, TRUE)
    return said


@pytest.mark.slow
@pytest.mark.parametrize("shifts", [(2, 20), (-2, -20)], ids=str)
@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("motion", MOTIONS)
def test_wrong_teeth_with_a_sensor(tmp_path: Path, motion: str, tone: str, shifts: tuple[int, ...]) -> None:
    check(rec.write(tmp_path / "bag", with_sensor(motion, TONES[tone])), shifts)


@pytest.mark.parametrize("tone", ["mains", "order 2.05"])
@pytest.mark.parametrize("motion", MOTIONS)
def test_right_teeth_with_a_sensor(tmp_path: Path, motion: str, tone: str) -> None:
    check(rec.write(tmp_path / "bag", with_sensor(motion, TONES[tone])), (0,))


def test_wrong_teeth_are_corrected_by_both_commands(tmp_path: Path) -> None:
    said = check(rec.write(tmp_path / "bag", with_sensor("one speed", TONES["none"])), (2, 20))
    assert {words.advice for words in said.values()} == {frozenset({TRUE})}


@pytest.mark.parametrize("tone", TONES)
def test_from_joint_states_alone(tmp_path: Path, tone: str) -> None:
    bag = rec.write(tmp_path / "bag", without_sensor(TONES[tone]))
    said = check(bag, (0, -2, 2, -20, 20), SENSORLESS)
    if tone == "none":
        assert {words.table for words in said.values()} == {TRUE}

"""Joint states that are wrong cost what is wrong in them, and are named where they prevent a verdict."""

import numpy as np
import pytest
from tests.hd_monitor.monitored import PAPER, SETTINGS, Recording, latest

from hd_monitor.arrays import FloatArray
from hd_monitor.diagnosis.inputs import InputCode
from hd_monitor.diagnosis.verdict import Component, Level
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity


@pytest.fixture(scope="module")
def recording() -> Recording:
    return Recording()


def watched(
    recording: Recording,
    position: FloatArray,
    velocity: FloatArray,
    *,
    effort: FloatArray | None = None,
    settings: JointSettings = SETTINGS,
) -> Monitor:
    """Feed the recording's vibration with other joint states."""
    monitor = Monitor(settings)
    own = recording.effort if effort is None else effort
    monitor.add(Quantity.MOTION, recording.joint_stamps, position, velocity, own)
    for block in recording.blocks():
        monitor.add_block(block)
    monitor.finish()
    return monitor


@pytest.mark.parametrize("uncertainty", [0.1, 0.5])
def test_efforts_of_zero_do_not_count_as_measured(recording: Recording, uncertainty: float) -> None:
    """That load.torque stands in is said; how the lines couple with each other tells whether it is right."""
    settings = JointSettings.from_mapping(PAPER | {"load.assumed_uncertainty": uncertainty})
    said = latest(
        watched(recording, recording.position, recording.velocity, effort=0.0 * recording.effort, settings=settings)
    )
    assert said.identification is not None
    assert not said.identification.relative
    assert said.torque_source == "assumed"
    assert "taken to be 10 N·m" in said.verdict.reason
    assert said.verdict.component is Component.FLEXSPLINE
    assert said.verdict.level is Level.ERROR


def test_positions_in_degrees_are_suspected(recording: Recording) -> None:
    verdict = latest(watched(recording, np.degrees(recording.position), np.degrees(recording.velocity))).verdict
    assert verdict.component is Component.UNDETERMINED
    assert "in rad" in verdict.reason


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (2.0, "the positions change 0.5 times as much as the velocities say"),
        (-1.0, "velocities of the opposite sign"),
        (0.0, "The velocities in joint_states are zero while the positions move"),
        (180.0 / np.pi, "velocities in deg/s"),
    ],
)
def test_velocities_that_contradict_the_positions_are_named_as_the_cause(
    recording: Recording, factor: float, words: str
) -> None:
    verdict = latest(watched(recording, recording.position, factor * recording.velocity)).verdict
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.WARN)
    assert words in verdict.reason


def test_positions_that_jump_about_are_named_as_the_cause(recording: Recording) -> None:
    noise = np.random.default_rng(4).standard_normal(recording.position.size)
    verdict = latest(watched(recording, noise, recording.velocity)).verdict
    assert "Positions and velocities in joint_states contradict each other" in verdict.reason


def test_missing_velocities_are_taken_from_the_positions(recording: Recording) -> None:
    nothing = np.full(recording.position.size, np.nan)
    assert latest(watched(recording, recording.position, nothing)).verdict.component is Component.FLEXSPLINE


def test_contradictory_joint_states_are_named_without_a_sensor_too(recording: Recording) -> None:
    monitor = Monitor(JointSettings.from_mapping({"input.source": "joint_effort"}))
    monitor.add(Quantity.MOTION, recording.joint_stamps, recording.position, -recording.velocity, recording.effort)
    monitor.finish()
    assert "velocities of the opposite sign" in latest(monitor).verdict.reason


@pytest.mark.parametrize("column", ["position", "velocity"])
def test_a_number_that_no_joint_reaches_costs_its_message_alone(recording: Recording, column: str) -> None:
    position, velocity = recording.position.copy(), recording.velocity.copy()
    {"position": position, "velocity": velocity}[column][300] = 1e300
    said = latest(watched(recording, position, velocity))
    assert said.quality.motion_faults == 1
    assert said.quality.samples == latest(watched(recording, recording.position, recording.velocity)).quality.samples
    assert (said.verdict.component, said.verdict.level) == (Component.FLEXSPLINE, Level.ERROR)
    assert said.identification is not None
    assert said.identification.index_std.flexspline < 0.005


@pytest.mark.parametrize("wild", [1e13, 1e300, 1.7e308])
@pytest.mark.parametrize("velocity", [0.5, np.nan], ids=["velocities", "no velocities"])
def test_positions_that_no_joint_reaches_are_named_as_the_cause(
    recording: Recording, wild: float, velocity: float
) -> None:
    position = np.where(np.arange(recording.position.size) % 2, wild, -wild)
    state = latest(watched(recording, position, np.full(position.size, velocity))).input
    assert state.code is InputCode.INVALID
    assert "with numbers beyond 1e+12" in state.reason

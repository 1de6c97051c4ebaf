"""What forbids naming a part: a sensor that hears nothing, and a torque or inertia that cannot be right."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate
from tests.studies.false_alarms import assessed

from hd_monitor.identification.identifier import Identifier
from hd_monitor.identification.result import Identification
from hd_monitor.limitation import LimitationCode
from hd_monitor.model import ParametricModel, StiffnessSeries

DEAD = {
    "defect": "flexspline", "duration": 15.0, "joint_states.effort": "transmitted", "sensor.fault": "dead",
}  # fmt: skip


@pytest.mark.parametrize("programme", ["sweep", "strokes", "fixed"])
@pytest.mark.parametrize("seed", range(3))
def test_a_dead_sensor_is_never_taken_for_a_sound_reducer(programme: str, seed: int) -> None:
    said = list(assessed(DEAD | {"programme": programme, "seed": seed}, {}))
    assert {assessment.verdict.component.value for assessment in said} == {"undetermined"}
    assert "hears nothing" in said[-1].verdict.reason


WORN = Case(
    model=ParametricModel(flexspline=StiffnessSeries((0.08, 0.02)), circular_spline=StiffnessSeries((0.01,))),
    motion="run_up",
    measured=True,
)


def identified(torque: float, **settings: object) -> Identification:
    """What is found where the joint states tell so many times the torque that acts."""
    identifier = Identifier(WORN.settings(**settings))
    for record in simulate(WORN):
        identifier.add(replace(record, torque=torque * record.torque))
    found = identifier.finish()
    assert found is not None
    return found


def limits(found: Identification) -> dict[LimitationCode, bool]:
    return {limitation.code: limitation.blocks for limitation in found.limitations}


@pytest.mark.parametrize("wrong", [0.67, 1.5])
def test_a_torque_that_is_off_is_corrected_and_said(wrong: float) -> None:
    found = identified(wrong)
    assert limits(found)[LimitationCode.TORQUE_CORRECTED] is False
    assert not found.relative
    (said,) = [doubt for doubt in found.doubts if doubt.code is LimitationCode.TORQUE_CORRECTED]
    assert said.values["factor"] == pytest.approx(1.0 / wrong, rel=0.05)
    for value, std, truth in zip(found.index, found.index_std, WORN.index, strict=True):
        assert abs(value - truth) < 4.5 * std


@pytest.mark.parametrize("wrong", [0.2, 5.0])
def test_a_torque_further_off_than_it_can_be_forbids_a_name(wrong: float) -> None:
    assert abs(math.log(wrong)) > 4.0 * np.hypot(0.1, 0.2)  # torque and inertia, as their parameters have it
    assert limits(identified(wrong))[LimitationCode.TORQUE_CONTRADICTED] is True


def test_how_far_off_a_torque_can_be_is_what_the_parameters_say() -> None:
    found = identified(0.2, **{"load.torque_uncertainty": 0.7})
    assert limits(found).get(LimitationCode.TORQUE_CORRECTED) is False


@pytest.mark.parametrize(("duration", "blocked"), [(1.2, True), (6.0, False)])
def test_a_slow_sensor_has_to_listen_for_longer(duration: float, blocked: bool) -> None:
    rig = {"defect": "flexspline", "programme": "strokes", "duration": duration}
    slow = {"sensor.rate": 250.0, "sensor.bandwidth": 100.0}
    *_, last = assessed(rig | slow, {"input.expected_rate": 250.0})
    assert last.identification is not None
    assert limits(last.identification).get(LimitationCode.VALUES_TOO_FEW, False) is blocked

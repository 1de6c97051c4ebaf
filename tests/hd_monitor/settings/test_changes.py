"""What may change while a joint is watched."""

from typing import Any

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.settings import CHANGEABLE, PARAMETERS, JointSettings, check_change, is_changeable


@pytest.mark.parametrize(
    "change",
    [
        {"diagnosis.warn_index": 0.02, "diagnosis.latch": True},
        {"load.torque": -25.0},
        {"input.timeout": 2.0, "input.startup_timeout": 90.0, "input.startup_warning": 0.0},
        {"input.topic": "/imu", "input.temperature_topic": "warmth", "load.topic": "ft"},
        {"input.reliability": "best_effort", "input.queue_seconds": 1.0},
    ],
)
def test_what_needs_no_new_evidence_may_change(change: dict[str, Any]) -> None:
    check_change(JointSettings.from_mapping(), JointSettings.from_mapping(change))


@pytest.mark.parametrize(
    "change", [{"dynamics.inertia": 0.3}, {"input.source": "imu"}, {"load.torque": 0.0}, {"history.path": "x"}]
)
def test_what_needs_new_evidence_is_refused_with_what_to_do(change: dict[str, Any]) -> None:
    (name,) = change
    with pytest.raises(ParameterError, match=f"{name} cannot change while the node is active.* deactivate the node"):
        check_change(JointSettings.from_mapping(), JointSettings.from_mapping({"diagnosis.latch": True, **change}))


def test_every_changeable_name_is_that_of_a_parameter_or_a_group() -> None:
    names = [parameter.name for parameter in PARAMETERS if is_changeable(parameter.name)]
    assert {next(c for c in CHANGEABLE if name.startswith(c)) for name in names} == set(CHANGEABLE)

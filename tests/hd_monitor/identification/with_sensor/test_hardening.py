"""A stiffness that grows with the torque, as catalogues state it in three steps, is found beside the defect."""

import pytest
from tests.studies.false_alarms import assessed

from hd_monitor.identification.result import Identification

RIG = {
    "defect": "custom",
    "flexspline.beta": [0.08, 0.03],
    "circular_spline.beta": [0.015, 0.01],
    "flexspline.transmission_error": [0.4],
    "circular_spline.transmission_error": [0.6],
    "programme": "sweep",
    "sweep.first": 300.0,
    "sweep.last": 2700.0,
    "sweep.rate": 150.0,
    "torque.mean": 12.0,
    "torque.gravity": 14.0,
    "elasticity.ratios": [0.75, 1.0, 1.15],
    "elasticity.torques": [7.0, 20.0],
    "duration": 16.0,
}


def identified(**told: float) -> Identification:
    *_, last = assessed(RIG, told)
    assert last.identification is not None
    return last.identification


def test_it_is_estimated_along() -> None:
    found = identified()
    assert found.index.flexspline == pytest.approx((0.08**2 + 0.03**2) ** 0.5, abs=4.0 * found.index_std[1])
    assert found.index.circular_spline == pytest.approx((0.015**2 + 0.01**2) ** 0.5, abs=4.0 * found.index_std[0])
    assert max(found.index_std) < 0.002
    linear = identified(**{"dynamics.hardening_uncertainty": 0.0})
    assert linear.signal_to_noise < found.signal_to_noise - 20.0
    assert max(linear.index_std) > 10.0 * max(found.index_std)

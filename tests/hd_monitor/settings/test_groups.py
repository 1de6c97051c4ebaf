"""The table of parameters: described, bounded, and with the names and defaults that other files rely on."""

import math

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.settings import NODE_PARAMETERS, PARAMETERS
from hd_monitor.sources import INPUT_SOURCES

# What other files rely on: the public contract's names, with the defaults it gives.
CONTRACT = {
    "reducer.flexspline_teeth": 160,
    "reducer.circular_spline_teeth": 162,
    "reducer.mount": "circular_spline_fixed",
    "reducer.serial": "",
    "dynamics.natural_frequency": 55.0,
    "dynamics.damping_ratio": 0.023,
    "dynamics.inertia": 0.29,
    "input.source": "block",
    "input.axis": "y",
    "input.sensor_radius": 0.55,
    "diagnosis.both_ratio": 0.87,
}


def test_names_are_unique():
    names = [parameter.name for parameter in (*PARAMETERS, *NODE_PARAMETERS)]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("parameter", [*PARAMETERS, *NODE_PARAMETERS], ids=lambda p: p.name)
def test_every_parameter_is_described_bounded_and_accepts_its_default(parameter):
    assert len(parameter.description) > 10
    assert parameter.check(parameter.default) == parameter.default
    if isinstance(parameter.default, int | float) and not isinstance(parameter.default, bool):
        assert math.isfinite(parameter.low)
        assert math.isfinite(parameter.high)
        for beyond in (parameter.low - 1, parameter.high + 1):
            with pytest.raises(ParameterError):
                parameter.check(type(parameter.default)(beyond))


@pytest.mark.parametrize(("name", "default"), CONTRACT.items())
def test_the_contracts_names_have_the_contracts_defaults(name, default):
    (parameter,) = (parameter for parameter in PARAMETERS if parameter.name == name)
    assert parameter.default == default


def test_the_contracts_sources():
    assert tuple(INPUT_SOURCES) == ("block", "accel_stamped", "imu", "joint_effort", "joint_velocity")

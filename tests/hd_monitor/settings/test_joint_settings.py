"""One joint's settings: checked alone and against each other, and turned into the model's objects."""

import math

import pytest

from hd_monitor.errors import GeometryError, ParameterError
from hd_monitor.reducer import Mount
from hd_monitor.settings import PARAMETERS, JointSettings
from hd_monitor.sources import INPUT_SOURCES, Quantity


def settings(**changes):
    return JointSettings.from_mapping({name.replace("__", "."): value for name, value in changes.items()})


def test_limits_are_in_order_by_default():
    assert 0.0 < settings().diagnosis.warn_index < settings().diagnosis.error_index


def test_nested_and_dotted_names_are_the_same():
    nested = JointSettings.from_mapping({"reducer": {"flexspline_teeth": 100, "circular_spline_teeth": 102}})
    assert nested == settings(reducer__flexspline_teeth=100, reducer__circular_spline_teeth=102)


def test_equal_settings_are_equal_and_hashable():
    assert settings() == settings()
    assert hash(settings()) == hash(settings(diagnosis__both_ratio=0.87))
    assert settings() != settings(diagnosis__both_ratio=0.9)


def test_reducer_and_dynamics_are_built_from_their_groups():
    joint = settings(
        reducer__flexspline_teeth=200,
        reducer__circular_spline_teeth=202,
        reducer__mount="flexspline_fixed",
        dynamics__natural_frequency=30,
        dynamics__inertia=1.5,
    )
    assert joint.reducer.reduction == 101.0
    assert joint.reducer.mount is Mount.FLEXSPLINE_FIXED
    assert (joint.dynamics.natural_frequency, joint.dynamics.damping_ratio, joint.dynamics.inertia) == (30, 0.023, 1.5)


@pytest.mark.parametrize("source", INPUT_SOURCES)
def test_sensorless_sources_are_those_of_joint_states(source):
    joint = settings(input__source=source)
    assert joint.sensorless == source.startswith("joint_")
    assert set(joint.sources) == {Quantity.MOTION} | (set() if joint.sensorless else {Quantity.VIBRATION})


def test_a_torque_sensor_is_a_source_of_its_own():
    torque = settings(load__source="wrench").sources[Quantity.TORQUE]
    assert (torque.topic, torque.type) == ("wrench", "geometry_msgs/WrenchStamped")
    assert torque.name_below("elbow") == "elbow/wrench"
    assert settings(load__source="wrench", load__topic="ft/w").sources[Quantity.TORQUE].name_below("a") == "a/ft/w"
    assert settings(load__source="wrench", load__topic="/ft/w").sources[Quantity.TORQUE].name_below("a") == "/ft/w"
    assert Quantity.TORQUE not in settings(load__source="wrench", input__source="joint_effort").sources


def test_every_parameter_is_a_typed_field_of_its_group():
    joint = settings()
    elsewhere = {
        "reducer.serial": joint.serial,
        "reducer.transmission_error": joint.transmission_error,
        "dynamics.natural_frequency_uncertainty": joint.uncertainty.natural_frequency,
        "dynamics.damping_uncertainty": joint.uncertainty.damping,
        "dynamics.inertia_uncertainty": joint.uncertainty.inertia,
        "dynamics.hardening_uncertainty": joint.uncertainty.hardening,
    }
    for parameter in PARAMETERS:
        group, _, field = parameter.name.partition(".")
        value = elsewhere[parameter.name] if parameter.name in elsewhere else getattr(getattr(joint, group), field)
        assert value == parameter.default
        assert type(value) is type(parameter.default) or isinstance(value, Mount)


@pytest.mark.parametrize(
    ("changes", "error", "match"),
    [
        ({"reducer.teeth": 3}, ParameterError, r"reducer\.teeth is not a parameter of a joint"),
        ({"reducer.mount": "glued"}, ParameterError, "choose one of"),
        ({"reducer.circular_spline_teeth": 161}, GeometryError, "odd"),
        ({"reducer.flexspline_teeth": 170}, GeometryError, "swapped"),
        ({"dynamics.natural_frequency": 0.0}, ParameterError, "Hz"),
        ({"dynamics.natural_frequency": math.nan}, ParameterError, "outside"),
        ({"diagnosis.error_index": 0.01}, ParameterError, "worse than a warning"),
        ({"diagnosis.warn_index": 0.2}, ParameterError, "worse than a warning"),
        ({"diagnosis.confirm_count": 4}, ParameterError, "never be reached"),
        ({"analysis.harmonics": 2.0}, ParameterError, "wrong type"),
        ({"diagnosis.latch": 1}, ParameterError, "wrong type"),
        ({"load.topic": "ft sensor"}, ParameterError, "not a topic's name"),
        ({"load.topic": "ft//wrench"}, ParameterError, "not a topic's name"),
        ({"load.axis": "w"}, ParameterError, "choose one of: x, y, z, -x, -y, -z"),
        ({"input.source": "imu", "input.sensor_radius": 0.0}, ParameterError, "distance of the IMU"),
    ],
)
def test_what_is_wrong_is_refused_with_the_reason(changes, error, match):
    with pytest.raises(error, match=match):
        JointSettings.from_mapping(changes)

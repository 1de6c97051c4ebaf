"""The monitor's settings: the table, one joint's values, several joints in one file."""

import math

import pytest

from hd_monitor.errors import GeometryError, ParameterError
from hd_monitor.reducer import Mount
from hd_monitor.settings import (
    INPUT_SOURCES,
    NODE_PARAMETERS,
    PARAMETERS,
    SENSORLESS_SOURCES,
    JointSettings,
    split_joints,
)

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


def settings(**changes):
    return JointSettings.from_mapping({name.replace("__", "."): value for name, value in changes.items()})


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
    assert settings()[name] == default


def test_the_contracts_sources():
    assert INPUT_SOURCES == ("block", "accel_stamped", "imu", "joint_effort", "joint_velocity")


def test_limits_are_in_order_by_default():
    assert 0.0 < settings()["diagnosis.warn_index"] < settings()["diagnosis.error_index"]


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
    assert settings(input__source=source).sensorless == (source in SENSORLESS_SOURCES)
    assert source.startswith("joint_") == (source in SENSORLESS_SOURCES)


def test_an_unknown_name_is_a_key_error():
    with pytest.raises(KeyError):
        settings()["reducer.teeth"]


@pytest.mark.parametrize(
    ("changes", "error", "match"),
    [
        ({"reducer.teeth": 3}, ParameterError, r"reducer\.teeth is no parameter of a joint"),
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
    ],
)
def test_what_is_wrong_is_refused_with_the_reason(changes, error, match):
    with pytest.raises(error, match=match):
        JointSettings.from_mapping(changes)


class TestSplitJoints:
    def test_one_joint_needs_no_name(self):
        assert list(split_joints({})) == ["joint"]
        assert split_joints({"reducer": {"serial": "A7"}})["joint"]["reducer.serial"] == "A7"

    @pytest.mark.parametrize("nothing", [[], None])
    def test_an_empty_list_of_joints_is_one_joint(self, nothing):
        assert list(split_joints({"joints": nothing})) == ["joint"]

    def test_common_values_are_shared_and_own_ones_win(self):
        joints = split_joints(
            {
                "joints": ["elbow", "wrist"],
                "diagnosis": {"warn_index": 0.03},
                "elbow": {"reducer": {"serial": "E"}},
                "wrist": {"reducer.serial": "W", "diagnosis": {"warn_index": 0.02}},
            }
        )
        assert list(joints) == ["elbow", "wrist"]
        assert [joints[j]["reducer.serial"] for j in joints] == ["E", "W"]
        assert [joints[j]["diagnosis.warn_index"] for j in joints] == [0.03, 0.02]

    def test_a_name_that_begins_like_another_is_its_own(self):
        joints = split_joints({"joints": ["a", "ab"], "a.reducer.serial": "1", "ab.reducer.serial": "2"})
        assert [joints[j]["reducer.serial"] for j in ("a", "ab")] == ["1", "2"]

    @pytest.mark.parametrize("joints", ["elbow", ["a", "a"]])
    def test_joints_are_a_list_of_different_names(self, joints):
        with pytest.raises(ParameterError, match="different names"):
            split_joints({"joints": joints})

    @pytest.mark.parametrize("joints", [[1], [""], 5, [["a"]]])
    def test_joints_are_names(self, joints):
        with pytest.raises(ParameterError, match="joints"):
            split_joints({"joints": joints})

    def test_a_misspelt_name_is_refused(self):
        with pytest.raises(ParameterError, match=r"elbwo\.reducer\.serial.*elbow"):
            split_joints({"joints": ["elbow"], "elbwo": {"reducer": {"serial": "E"}}})

    def test_a_misspelt_name_below_a_joint_is_refused(self):
        with pytest.raises(ParameterError, match=r"reducer\.seriel"):
            split_joints({"joints": ["elbow"], "elbow": {"reducer": {"seriel": "E"}}})

    def test_what_belongs_to_the_node_or_to_ros_is_left_alone(self):
        values = {parameter.name: parameter.default for parameter in NODE_PARAMETERS}
        assert list(split_joints({"joints": ["elbow"], "use_sim_time": True, **values})) == ["elbow"]

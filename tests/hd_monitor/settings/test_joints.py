"""A node's parameters, split: several joints in one file, the node's own, and those of others."""

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.settings import NODE_PARAMETERS, set_aside_foreign, split_joints


def test_one_joint_needs_no_name():
    assert list(split_joints({})) == ["joint"]
    assert split_joints({"reducer": {"serial": "A7"}})["joint"].serial == "A7"


@pytest.mark.parametrize("nothing", [[], None])
def test_an_empty_list_of_joints_is_one_joint(nothing):
    assert list(split_joints({"joints": nothing})) == ["joint"]


def test_common_values_are_shared_and_own_ones_win():
    joints = split_joints(
        {
            "joints": ["elbow", "wrist"],
            "diagnosis": {"warn_index": 0.03},
            "elbow": {"reducer": {"serial": "E"}},
            "wrist": {"reducer.serial": "W", "diagnosis": {"warn_index": 0.02}},
        }
    )
    assert list(joints) == ["elbow", "wrist"]
    assert [joints[j].serial for j in joints] == ["E", "W"]
    assert [joints[j].diagnosis.warn_index for j in joints] == [0.03, 0.02]


def test_a_name_that_begins_like_another_is_its_own():
    joints = split_joints({"joints": ["a", "ab"], "a.reducer.serial": "1", "ab.reducer.serial": "2"})
    assert [joints[j].serial for j in ("a", "ab")] == ["1", "2"]


@pytest.mark.parametrize("joints", ["elbow", ["a", "a"]])
def test_joints_are_a_list_of_different_names(joints):
    with pytest.raises(ParameterError, match="different names"):
        split_joints({"joints": joints})


@pytest.mark.parametrize("joints", [[1], [""], 5, [["a"]], ["left\narm"], ["\x1b[31mred"]])
def test_joints_are_names(joints):
    with pytest.raises(ParameterError, match="joints"):
        split_joints({"joints": joints})


def test_a_misspelt_name_is_refused():
    with pytest.raises(ParameterError, match=r"elbwo\.reducer\.serial.*elbow"):
        split_joints({"joints": ["elbow"], "elbwo": {"reducer": {"serial": "E"}}})


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("elbwo.reducer.serial", r"there is no joint 'elbwo', only elbow, wrist; did you mean elbow\?"),
        ("gripper.load.torque", "there is no joint 'gripper', only elbow, wrist; add it to joints"),
        ("elbow.reducer.seriel", r"reducer\.seriel is not a parameter of a joint; did you mean reducer\.serial\?"),
        ("reducer.seriel", r"there is no parameter reducer\.seriel.*; did you mean reducer\.serial\?"),
    ],
)
def test_a_misspelt_joint_or_parameter_is_never_foreign_and_what_it_resembles_is_named(name: str, says: str) -> None:
    mine, foreign = set_aside_foreign({"joints": ["elbow", "wrist"], name: "1.0"})
    assert not foreign
    with pytest.raises(ParameterError, match=says):
        split_joints(mine)


def test_a_misspelt_name_below_a_joint_is_refused():
    with pytest.raises(ParameterError, match=r"reducer\.seriel"):
        split_joints({"joints": ["elbow"], "elbow": {"reducer": {"seriel": "E"}}})


def test_what_belongs_to_the_node_or_to_ros_is_left_alone():
    values = {parameter.name: parameter.default for parameter in NODE_PARAMETERS}
    assert list(split_joints({"joints": ["elbow"], "use_sim_time": True, **values})) == ["elbow"]


def test_what_a_shared_file_holds_for_others_is_set_aside() -> None:
    given = {
        "joints": ["elbow"],
        "reducer": {"serial": "A"},
        "stiffness": {"flexspline": [0.1]},
        "load": {"torque": 3.0, "fluctuation": 1.0},
        "elbow": {"input": {"axis": "x"}},
        "use_sim_time": True,
    }
    mine, foreign = set_aside_foreign(given)
    assert foreign == ["load.fluctuation", "stiffness.flexspline"]
    settings = split_joints(mine)["elbow"]
    assert (settings.load.torque, settings.input.axis) == (3.0, "x")


def test_a_shared_file_whose_joints_are_not_names_is_refused() -> None:
    given, _ = set_aside_foreign({"joints": 5})
    with pytest.raises(ParameterError, match="joints = 5 must be a list"):
        split_joints(given)


@pytest.mark.parametrize("name", ["reducer.flexspline_tooth", "diagnosis.warn_idnex", "elbow.sensor.radius"])
def test_a_misspelt_name_is_not_foreign(name: str) -> None:
    mine, foreign = set_aside_foreign({"joints": ["elbow"], name: 1.0})
    assert not foreign
    with pytest.raises(ParameterError, match=name.removeprefix("elbow.")):
        split_joints(mine)

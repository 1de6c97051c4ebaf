import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.settings import PARAMETERS, set_aside_foreign, split_joints

pytestmark = pytest.mark.ros


@pytest.mark.parametrize("names", [["joint"], ["arm-joint.1"], ["shoulder", "elbow_2"], ["_x", "y"]])
def test_names_that_can_stand_in_topics(names: list[str]) -> None:
    from hd_monitor.ros.parameters import check_names

    check_names(names)


@pytest.mark.parametrize(
    ("names", "way_out"),
    [
        (["left-arm", "b"], "'left_arm'"),
        (["a b", "c"], "'a_b'"),
        (["7dof", "b"], "'joint_7dof'"),
        (["diagnosis"], "'diagnosis_joint'"),
        ([""], "'joint'"),
        (["a/b", "c"], "'a_b'"),
    ],
)
def test_names_that_cannot_say_the_way_out(names: list[str], way_out: str) -> None:
    from hd_monitor.ros.parameters import check_names

    with pytest.raises(ParameterError, match=f"call it {way_out}") as caught:
        check_names(names)
    proposed = str(caught.value).partition("call it '")[2].partition("'")[0]
    check_names([proposed, *names[1:]])


def test_every_numeric_parameter_has_a_range() -> None:
    from hd_monitor.ros.parameters import describe

    for parameter in PARAMETERS:
        descriptor = describe(parameter, read_only=False)
        assert descriptor.description.startswith(parameter.description)
        if isinstance(parameter.default, (int, float)) and not isinstance(parameter.default, bool):
            assert descriptor.floating_point_range or descriptor.integer_range, parameter.name


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
    assert (settings["load.torque"], settings["input.axis"]) == (3.0, "x")


@pytest.mark.parametrize("name", ["reducer.flexspline_tooth", "diagnosis.warn_idnex", "elbow.sensor.radius"])
def test_a_misspelt_name_is_not_foreign(name: str) -> None:
    mine, foreign = set_aside_foreign({"joints": ["elbow"], name: 1.0})
    assert not foreign
    with pytest.raises(ParameterError, match=name.removeprefix("elbow.")):
        split_joints(mine)

import pytest

from hd_monitor.errors import ParameterError

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
def test_impossible_names_are_refused_with_the_remedy(names: list[str], way_out: str) -> None:
    from hd_monitor.ros.parameters import check_names

    with pytest.raises(ParameterError, match=f"call it {way_out}") as caught:
        check_names(names)
    proposed = str(caught.value).partition("call it '")[2].partition("'")[0]
    check_names([proposed, *names[1:]])

import numpy as np
import pytest

from hd_monitor.errors import HdMonitorError
from hd_monitor.paper.cases import Cases, has_cases, load_own_case, load_paper_cases, paper_file
from hd_monitor.reducer import Mount

OWN = """
reducer: {flexspline_teeth: 100, circular_spline_teeth: 102, mount: flexspline_fixed}
dynamics: {natural_frequency: 40.0, damping_ratio: 0.03, inertia: 0.5}
flexspline: {beta: [0.04, 0.02]}
circular_spline: {beta: [0.03], phase: [1.0]}
torque: {mean: 20.0, load_fluctuation: 2.0, load_order: 1}
"""


@pytest.fixture
def own(tmp_path):
    def write(text):
        path = tmp_path / "own.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_papers_cases_are_installed():
    assert paper_file().name == "paper.yaml"
    assert has_cases(paper_file())
    assert "table_1" in load_paper_cases()


def test_a_case_changes_only_its_own_values(cases):
    assert cases["sweep_double"].model.dynamics.damping_ratio == 0.023
    assert cases["sweep_double_damped"].model.dynamics.damping_ratio == 0.027
    assert cases["sweep_double_damped"].model.dynamics.natural_frequency == 55.0
    assert cases["combined_groups"].model.torque.load_fluctuation == 5.0
    assert cases["combined_groups"].model.torque.mean == 10.0


def test_pitch_errors_determine_the_circular_spline(cases):
    case = cases["sample_before"]
    gear = case.pitch_error
    assert gear is not None
    assert len(gear.errors.accumulated) == 162
    assert case.model.circular_spline == gear.errors.stiffness_series(gear.sensitivity)


def test_own_reducer(own):
    case = load_own_case(own(OWN))
    assert case.model.reducer.mount is Mount.FLEXSPLINE_FIXED
    assert case.model.flexspline.beta == (0.04, 0.02)
    assert case.model.circular_spline.phase == (1.0,)
    assert case.model.torque.mean == 20.0
    assert case.model.torque.load_order == 1
    assert case.settings.dynamics.damping_ratio == 0.03
    assert case.speeds.values[-1] > 60.0 * 40.0 / case.model.reducer.circular_spline_order  # the resonance is in it


def test_own_reducer_may_be_a_ros_parameter_file(own):
    nested = "/**:\n  ros__parameters:\n" + "\n".join(f"    {line}" for line in OWN.strip().splitlines())
    assert load_own_case(own(nested)).model == load_own_case(own(OWN)).model


def test_others_parameters_in_a_ros_file_are_named(own):
    text = "/**:\n  ros__parameters:\n    flexspline: {beta: [0.1]}\n    programme: dwell\n    sensor: {noise: 0.1}\n"
    assert load_own_case(own(text)).ignored == ("programme", "sensor.noise")


def test_the_monitors_load_is_the_mean_torque_unless_given(own):
    assert load_own_case(own("flexspline: {beta: [0.1]}\nload: {torque: 33.0}")).model.torque.mean == 33.0


def test_the_example_is_usable():
    case = load_own_case(paper_file().with_name("my_reducer.yaml"))
    assert case.model.flexspline.index > 0.0
    assert np.rad2deg(case.static_step) == pytest.approx(15.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("flexspine: {beta: [0.1]}", r"flexspine\.beta: no such value"),
        ("flexspline: {beta: 0.1}", "is not a list of numbers"),
        ("flexspline: {beta: [a]}", "not a number"),
        ("reducer: {flexspline_teeth: 162, circular_spline_teeth: 160}", "swapped"),
        ("dynamics: {damping_ratio: much}", "wrong type"),
        ("speed: 0", "must be above 0"),
        ("speed: .nan", "not a finite number"),
        ("torque: {load_fluctuation: yes}", "not a finite number"),
        ("speeds: {start: 300, stop: 200, step: 10}", "is empty or endless"),
        ("speeds: {start: 300, stop: 300, step: 10}", "stop must be above start"),
        ("sweep: {start: 1, stop: 10, rate: 0}", "is empty or endless"),
        ("circular_spline: {beta: [0.1]}\npitch_error: {eccentricity: 1.0e-5}", "not both"),
        ("- a\n- b", "holds no named values"),
        ("a: [", "is not valid YAML"),
        ("reducer: {flexspline_teeth: 100, circular_spline_teeth: 102}", "gives no stiffness index"),
    ],
)
def test_bad_files_are_refused_in_one_line(own, text, message):
    with pytest.raises(HdMonitorError, match=message) as caught:
        load_own_case(own(text))
    assert "\n" not in str(caught.value)


def test_an_absent_file_is_refused(tmp_path):
    with pytest.raises(HdMonitorError, match=r"nowhere\.yaml cannot be read"):
        load_own_case(tmp_path / "nowhere.yaml")


def test_a_file_without_cases_is_not_the_papers(own):
    with pytest.raises(HdMonitorError, match="has no `cases`"):
        load_paper_cases(own(OWN))


def test_a_missing_case_is_named():
    with pytest.raises(HdMonitorError, match=r"short\.yaml has no case 'rig'"):
        Cases({}, "short.yaml")["rig"]

"""The rig's parameters: one table, checked against itself, and a file that the monitor may share."""

import math

import pytest

from hd_monitor.errors import GeometryError, ParameterError
from hd_monitor.model import StiffnessSeries
from hd_monitor.settings import PARAMETERS as MONITOR_PARAMETERS
from hd_sim_node.drive.defects import FAULTY, HEALTHY
from hd_sim_node.motion.programme import Ripple
from hd_sim_node.parameters import CHANGEABLE, NODE_PARAMETERS, PARAMETERS
from hd_sim_node.settings import RigSettings, pick

EVERYTHING = (*PARAMETERS, *NODE_PARAMETERS)


def rig(**changes):
    return RigSettings.from_mapping({name.replace("__", "."): value for name, value in changes.items()})


def test_names_are_unique():
    names = [parameter.name for parameter in EVERYTHING]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("parameter", EVERYTHING, ids=lambda p: p.name)
def test_every_parameter_is_described_and_accepts_its_default(parameter):
    assert len(parameter.description) > 5
    assert parameter.check(parameter.default) == parameter.default
    if isinstance(parameter.default, float | int) and not isinstance(parameter.default, bool):
        assert math.isfinite(parameter.low)
        assert math.isfinite(parameter.high)


def test_the_reducer_and_its_dynamics_are_the_monitors_own_parameters():
    """So that one file serves both nodes, with the same names, ranges and defaults."""
    mine = {p.name: p for p in PARAMETERS}
    shared = [p for p in MONITOR_PARAMETERS if p.name.startswith(("reducer.", "dynamics."))]
    not_of_the_rig = {p.name for p in shared} - set(mine)
    assert not_of_the_rig == {
        "reducer.serial", "reducer.transmission_error", "dynamics.natural_frequency_uncertainty",
        "dynamics.damping_uncertainty", "dynamics.inertia_uncertainty", "dynamics.hardening_uncertainty",
    }  # fmt: skip
    assert all(mine[p.name] is p for p in shared if p.name in mine)


def test_defaults_are_the_papers_rig():
    settings = rig()
    model = settings.model
    assert (model.reducer.flexspline_teeth, model.reducer.circular_spline_teeth) == (160, 162)
    assert (model.dynamics.natural_frequency, model.dynamics.damping_ratio, model.dynamics.inertia) == (55, 0.023, 0.29)
    assert model.torque.mean == 10.0
    assert settings.programme.speeds[0] == 200.0
    assert settings.programme.speeds.max() == 3000.0
    assert settings.duration == math.inf


@pytest.mark.parametrize(
    ("defect", "flexspline", "circular_spline"),
    [
        ("none", HEALTHY, HEALTHY),
        ("flexspline", FAULTY, HEALTHY),
        ("circular_spline", HEALTHY, FAULTY),
        ("both", FAULTY, FAULTY),
    ],
)
def test_a_defect_by_its_name(defect, flexspline, circular_spline):
    model = rig(defect=defect).model
    assert (model.flexspline, model.circular_spline) == (flexspline, circular_spline)


def test_a_custom_defect_by_its_lists():
    settings = rig(
        defect="custom",
        flexspline__beta=[0.05, 0.03],
        flexspline__phase=[1.0],
        circular_spline__beta=[0.02],
    )
    assert settings.model.flexspline == StiffnessSeries((0.05, 0.03), (1.0, 0.0))
    assert settings.model.circular_spline == StiffnessSeries((0.02,), (0.0,))
    assert settings.remarks == []


def test_ignored_lists_cause_a_remark():
    assert "set defect to 'custom'" in rig(flexspline__beta=[0.05]).remarks[0]
    assert rig(flexspline__beta=[0.0]).remarks == []


def test_more_phases_than_indexes_are_refused():
    with pytest.raises(ParameterError, match="2 phases for 1 harmonics"):
        rig(defect="custom", flexspline__beta=[0.1], flexspline__phase=[0.0, 1.0])


def test_nested_and_dotted_names_are_the_same():
    nested = RigSettings.from_mapping({"programme": "fixed", "fixed": {"speed": 400.0}, "torque": {"mean": 20}})
    assert nested == rig(programme="fixed", fixed__speed=400.0, torque__mean=20.0)


def test_angles_are_degrees_outside_and_radians_inside():
    settings = rig(start_angle=90.0, torque__gravity=1.0, torque__gravity_angle=180.0)
    assert settings.start_angle == pytest.approx(math.pi / 2)
    assert settings.surroundings.gravity_angle == pytest.approx(math.pi)


def test_sensor_joint_and_transport_take_their_groups():
    settings = rig(sensor__noise=0.5, joint_states__side="output", transport__loss=0.1, rigid_body=True)
    assert settings.sensor.noise == 0.5
    assert settings.joint.side == "output"
    assert settings.transport.loss == 0.1
    assert settings.surroundings.rigid_body


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"programme": "fixed"}, math.inf),
        ({"programme": "fixed", "duration": 7.0}, 7.0),
        ({"programme": "fixed", "cycles": 1}, 60.0),
        ({"programme": "fixed", "cycles": 2, "duration": 300.0}, 120.0),
    ],
)
def test_the_duration_is_the_shorter_of_programme_and_limit(changes, expected):
    assert RigSettings.from_mapping(changes).duration == expected


def test_speed_ripple_reaches_the_programme():
    assert rig(speed_ripple__amplitude=0.1).programme.ripple == Ripple(0.1, order=2.0)


@pytest.mark.parametrize(
    ("changes", "error", "match"),
    [
        ({"defect": "rust"}, ParameterError, "choose one of"),
        ({"programme": "waltz"}, ParameterError, "choose one of"),
        ({"fixed.speed": "fast"}, ParameterError, "wrong type"),
        ({"sensor.noise": -1.0}, ParameterError, "outside"),
        ({"sensor.rate": math.nan}, ParameterError, "outside"),
        ({"flexspline.beta": [0.1, 2.0]}, ParameterError, "outside"),
        ({"flexspline.beta": ["a"]}, ParameterError, "list of numbers"),
        ({"nonsense": 1}, ParameterError, "not a parameter of the rig"),
        ({"reducer.circular_spline_teeth": 163}, GeometryError, "odd"),
        ({"defect": "custom", "flexspline.beta": [0.9, 0.9]}, ParameterError, "vanish"),
        ({"programme": "profile", "profile.times": [0.0, 1.0, 2.0]}, ParameterError, "3 times and 2 speeds"),
        ({"programme": "sweep", "sweep.first": 300.0, "sweep.last": 300.0}, ParameterError, "does not change"),
    ],
)
def test_what_is_wrong_is_refused_at_once(changes, error, match):
    with pytest.raises(error, match=match):
        RigSettings.from_mapping(changes)


class TestPick:
    def test_leaves_out_what_belongs_to_the_monitor(self):
        shared = {
            "joints": ["elbow"],
            "elbow": {"reducer": {"serial": "7"}},
            "reducer": {"flexspline_teeth": 200, "serial": "x"},
            "diagnosis.warn_index": 0.04,
            "use_sim_time": False,
            "autostart": True,
            "time_scale": 3.0,
            "defect": "both",
        }
        assert pick(shared, NODE_PARAMETERS) == {"reducer.flexspline_teeth": 200, "defect": "both"}

    def test_refuses_a_misspelt_name_with_a_hint(self):
        with pytest.raises(ParameterError, match=r"sensor\.nose .* did you mean sensor\.noise"):
            pick({"sensor": {"nose": 1.0}})

    def test_refuses_an_unknown_name(self):
        with pytest.raises(ParameterError, match="for their list"):
            pick({"zzz": 1.0})


@pytest.mark.parametrize("old", [True, False])
def test_a_velocity_given_as_before_is_refused_with_the_words_allowed(old):
    with pytest.raises(ParameterError, match=r"joint_states\.velocity = (True|False) .* reported, missing, zero"):
        RigSettings.from_mapping({"joint_states.velocity": old})


def test_a_fifo_must_be_read_faster_than_it_fills():
    with pytest.raises(ParameterError, match=r"sensor\.fifo_spacing"):
        RigSettings.from_mapping({"sensor.fifo": 8, "sensor.rate": 100_000.0})


def test_what_may_change_while_it_runs_exists():
    names = [parameter.name for parameter in PARAMETERS]
    for prefix in CHANGEABLE:
        assert any(name.startswith(prefix) for name in names), prefix


@pytest.mark.parametrize(
    "name",
    [
        *("programme", "seed", "block_size", "publish", "joint_states.rate", "sensor.rate", "sensor.bandwidth"),
        *("sensor.filter_order", "sensor.clock_drift", "sensor.fifo", "sensor.fifo_spacing", "sensor.cross_axis"),
    ],
)
def test_what_is_set_up_once_may_not(name):
    assert not name.startswith(CHANGEABLE)

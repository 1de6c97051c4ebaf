"""Drives to choose by name: presets fill in what the user has not given."""

import math
from typing import Any

import numpy as np
import pytest
from tests.hd_sim_node.drive import plain

from hd_monitor.errors import ParameterError
from hd_sim_node.drive.catalogue import DRIVES, PAPER, SOURCES, preset
from hd_sim_node.drive.defects import FAULTY, HEALTHY
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.stability import unstable_speeds
from hd_sim_node.motion.programmes import PROGRAMMES
from hd_sim_node.parameters import PARAMETERS
from hd_sim_node.settings import RigSettings

TABLE = {parameter.name: parameter for parameter in PARAMETERS}
PRESETS = sorted(set(DRIVES) - {PAPER})


def numbers(drive: str) -> dict[str, Any]:
    return dict(preset(drive))


@pytest.mark.parametrize("drive", PRESETS)
def test_every_value_is_one_of_its_parameter_and_has_a_source(drive):
    for name, (value, source) in DRIVES[drive].items():
        assert TABLE[name].check(value) == value
        assert len(source) > 5, name


def test_every_document_is_used():
    said = " ".join(entry.source for drive in DRIVES.values() for entry in drive.values())
    assert [name for name in SOURCES if name not in said] == []


def test_the_papers_drive_is_the_default_and_changes_nothing():
    assert RigSettings.from_mapping() == RigSettings.from_mapping({"drive": PAPER})
    assert dict(RigSettings.from_mapping().values) == {parameter.name: parameter.default for parameter in PARAMETERS}


@pytest.mark.parametrize("drive", PRESETS)
def test_a_preset_replaces_defaults_only(drive):
    values = RigSettings.from_mapping({"drive": drive}).values
    changed = {name for name, parameter in TABLE.items() if values[name] != parameter.default} - {"drive"}
    assert changed <= set(DRIVES[drive])
    assert {name: values[name] for name in DRIVES[drive]} == preset(drive)


@pytest.mark.parametrize("given", [{"dynamics.inertia": 2.0}, {"dynamics": {"inertia": 2.0}}])
def test_the_users_own_value_wins(given):
    settings = RigSettings.from_mapping({"drive": "catalogue", **given})
    assert settings.model.dynamics.inertia == 2.0
    assert settings.model.dynamics.natural_frequency == preset("catalogue")["dynamics.natural_frequency"]


@pytest.mark.parametrize("drive", PRESETS)
def test_a_defect_may_be_chosen_beside_it(drive):
    model = RigSettings.from_mapping({"drive": drive, "defect": "circular_spline"}).model
    assert (model.flexspline, model.circular_spline) == (HEALTHY, FAULTY)


def test_a_new_unit_is_sound_and_a_worn_one_is_not():
    assert RigSettings.from_mapping({"drive": "catalogue"}).model.flexspline == HEALTHY
    assert RigSettings.from_mapping({"drive": "worn"}).model.flexspline == FAULTY


@pytest.mark.parametrize(("drive", "stiffness"), [("catalogue", 25e3), ("worn", 20e3)])
def test_the_natural_frequency_is_that_of_the_inertia_on_the_middle_stiffness(drive, stiffness):
    dynamics = RigSettings.from_mapping({"drive": drive}).model.dynamics
    assert dynamics.inertia * (2.0 * math.pi * dynamics.natural_frequency) ** 2 == pytest.approx(stiffness, rel=1e-3)


@pytest.mark.parametrize(
    ("drive", "stiffness"), [("catalogue", (16e3, 25e3, 29e3)), ("worn", (10e3, 20e3, 25e3))], ids=PRESETS
)
def test_the_ratios_give_the_three_stiffnesses(drive, stiffness):
    values = numbers(drive)
    middle = values["dynamics.inertia"] * (2.0 * math.pi * values["dynamics.natural_frequency"]) ** 2
    assert [ratio * middle for ratio in values["elasticity.ratios"]] == pytest.approx(stiffness, rel=1e-3)


def test_the_errors_add_up_to_the_catalogues_positional_accuracy():
    parts = ("flexspline", "circular_spline", "wave_generator")
    assert sum(sum(numbers("catalogue")[f"{part}.transmission_error"]) for part in parts) == pytest.approx(1.0)


@pytest.mark.parametrize(("drive", "arcmin"), [("catalogue", 1.0), ("worn", 3.0)])
def test_the_hysteresis_loop_is_as_wide_as_stated(drive, arcmin):
    values = numbers(drive)
    middle = values["dynamics.inertia"] * (2.0 * math.pi * values["dynamics.natural_frequency"]) ** 2
    width = 2.0 * values["hysteresis.torque"] / (values["elasticity.ratios"][0] * middle)
    assert math.degrees(width) * 60.0 == pytest.approx(arcmin, rel=5e-3)


def test_friction_is_a_third_of_the_no_load_torque_at_the_output():
    values, speed = numbers("catalogue"), 2000.0 * math.tau / 60.0 / 80.0
    assert 3.0 * (values["friction.coulomb"] + values["friction.stribeck"]) == pytest.approx(80 * 0.037, rel=0.02)
    assert 3.0 * (values["friction.coulomb"] + values["friction.viscous"] * speed) == pytest.approx(
        80 * 0.105, rel=0.01
    )


@pytest.mark.parametrize("drive", PRESETS)
@pytest.mark.parametrize("programme", sorted(set(PROGRAMMES) - {"profile"}))
def test_every_programme_runs_stably(drive, programme):
    settings = RigSettings.from_mapping({"drive": drive, "programme": programme})
    assert unstable_speeds(settings.model, settings.programme) == []


def test_an_unknown_drive_is_refused():
    with pytest.raises(ParameterError, match="drive = 'cyclo' is unknown; choose one of: paper, catalogue, worn"):
        RigSettings.from_mapping({"drive": "cyclo"})


def test_the_monitor_must_be_told():
    (remark,) = RigSettings.from_mapping({"drive": "catalogue"}).remarks
    assert "31.21 Hz and an inertia of 0.65 kg·m²" in remark


def test_the_catalogue_in_a_robots_joint_agrees_with_the_plain_equation():
    """Everything at once: it picks and places under gravity, and turns back; cut where the acceleration jumps."""
    settings = RigSettings.from_mapping(
        {
            "drive": "catalogue",
            "programme": "pick_and_place",
            "pick_and_place.angle": 4.0,
            "pick_and_place.pick_pause": 0.12,
            "pick_and_place.place_pause": 0.1,
            "rigid_body": True,
            "torque.gravity": 9.0,
            "torque.payload": 6.0,
            "inertia.lowest": -0.3,
            "inertia.highest": 0.5,
            "inertia.period": 0.9,
            "inertia.payload": 0.15,
        }
    )
    rig = Rig(
        settings.model, settings.programme, rate=250.0, surroundings=settings.surroundings, effects=settings.effects
    )
    value, programme = settings.values, settings.programme

    def carried(t):
        return float(programme.course(t).carried)

    def inertia(t):
        return 1.1 + 0.4 * math.sin(math.tau * t / 0.9 + math.asin(-0.25)) + 0.15 * carried(t)

    def load(t, q):
        ripple = sum(m * math.cos(n * 80 * q) for m, n in zip(value["torque.ripple"], (2, 6, 12), strict=True))
        weight = (9.0 + 6.0 * carried(t)) * math.cos(q)
        return 17.0 + ripple + weight - 0.65 * inertia(t) * float(programme.acceleration(t)) / 80

    def error(part):
        sizes = value[f"{part}.transmission_error"]
        return sizes, (*value[f"{part}.transmission_error_phase"], 0.0, 0.0)[: len(sizes)]

    cuts = (30, 20, 95)  # the first after the pause, at 0.12 s
    chunks = [rig.advance(count) for count in cuts]
    expected = plain.solve(
        lambda t: float(programme.angle(t)) / 80,
        lambda t: float(programme.speed(t)) / 80,
        np.arange(sum(cuts)) / 250.0,
        longest=1e-3,
        tolerance=1e-9,
        beta1=(HEALTHY.beta, HEALTHY.phase),
        beta2=(HEALTHY.beta, HEALTHY.phase),
        e1=error("flexspline"),
        e2=error("circular_spline"),
        e0=error("wave_generator"),
        ratios=value["elasticity.ratios"],
        corners=value["elasticity.torques"],
        loop=(value["hysteresis.torque"], value["hysteresis.twist"]),
        coulomb=value["friction.coulomb"],
        stribeck=(value["friction.stribeck"], value["friction.stribeck_velocity"]),
        viscous=value["friction.viscous"],
        drift=tuple(value[f"drift.{name}"] for name in ("natural_frequency", "damping_ratio", "friction", "time")),
        fn=value["dynamics.natural_frequency"],
        zeta=value["dynamics.damping_ratio"],
        inertia=value["dynamics.inertia"],
        load=load,
        inertia_factor=inertia,
    )[2]
    found = np.concatenate([chunk.acceleration for chunk in chunks])
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())

"""The identifier on simulated cases: what it must find, what it must notice, and what it must survive."""

from dataclasses import replace

import numpy as np
import pytest
from tests.simulated.cases import Case, simulate

from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.fit import unknowns
from hd_monitor.identification.fit.gauss_newton import FitStatus
from hd_monitor.identification.identifier import Identifier
from hd_monitor.limitation import LimitationCode
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque, line_pairs

MODEL = ParametricModel(
    dynamics=Dynamics(),
    flexspline=StiffnessSeries((0.03, 0.015, 0.01), (0.4, 1.1, 2.0)),
    circular_spline=StiffnessSeries((0.07, 0.03, 0.02), (2.5, 0.3, 1.0)),
    torque=Torque(mean=10.0, load_fluctuation=8.0, load_phase=1.0),
)


def case(**changes):
    return Case(**({"model": MODEL} | changes))


def identify(records, settings):
    identifier = Identifier(settings)
    for record in records:
        identifier.add(record)
    return identifier.finish()


def assert_right(result, truth, *, stds=4.5):
    error = np.abs(np.subtract(result.index, truth.index)) / np.asarray(result.index_std)
    assert error.max() < stds, (result.index, truth.index, result.index_std)
    assert max(result.index_std) < 0.01
    assert result.blockers == ()


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"motion": "strokes", "speed": 1500.0},
        {"motion": "run_up", "speed": 1600.0},
        {"speed": 1650.0},
        {"speed": 825.0, "colour": "red"},
        {"motion": "strokes", "spikes": 0.002, "lost": 0.05, "measured": True},
        {"motion": "ripple", "model": replace(MODEL, torque=replace(MODEL.torque, load_fluctuation=28.0))},
        {"rate": 4000.0, "duration": 6.0},
    ],
    ids=["dwell", "strokes", "run-up", "resonance", "half", "faults", "load", "fast"],
)
def test_indexes_are_right_within_their_uncertainty(changes):
    truth = case(**changes)
    result = identify(simulate(truth), truth.settings())
    assert_right(result, truth)
    assert result.relative is False


def test_a_quarter_turn_at_20_db_is_enough():
    truth = case(duration=4.0, speed=320.0)
    result = identify(simulate(truth), truth.settings())
    assert np.degrees(result.travel) < 97.0
    assert result.blockers == ()
    assert result.index.circular_spline - result.index.flexspline > 3.0 * max(result.index_std)


@pytest.mark.parametrize("factor", [0.9, 1.1])
@pytest.mark.parametrize("motion", ["dwell", "run_up"])
def test_a_wrong_natural_frequency_is_noticed(factor, motion):
    truth = case(motion=motion, speed=1500.0)
    wrong = {"dynamics.natural_frequency": 55.0 * factor}
    result = identify(simulate(truth), truth.settings(**wrong))
    assert result.natural_frequency == pytest.approx(55.0, rel=0.01)
    assert any("natural frequency" in describe_limitation(doubt) for doubt in result.doubts)
    assert_right(result, truth)


@pytest.mark.parametrize("factor", [0.9, 1.1])
@pytest.mark.parametrize("motion", ["dwell", "run_up"])
def test_a_wrong_natural_frequency_said_to_be_exact_does_not_mislead(factor, motion):
    truth = case(motion=motion, speed=1500.0)
    exact = {"dynamics.natural_frequency": 55.0 * factor, "dynamics.natural_frequency_uncertainty": 0.0}
    result = identify(simulate(truth), truth.settings(**exact))
    assert (result.natural_frequency, result.natural_frequency_std) == (55.0 * factor, 0.0)
    # An inertia that moves takes the wrong frequency's place; it has to prove itself for longer
    assert {limitation.code for limitation in result.blockers} <= {LimitationCode.INERTIA_MOVES}
    assert_right(replace(result, limitations=result.doubts), truth)


def test_a_value_on_its_bound_is_reported_and_not_shown_as_a_measurement():
    truth = case(motion="run_up", speed=1500.0)
    result = identify(simulate(truth), truth.settings(**{"dynamics.natural_frequency": 40.0}))
    assert result.fit_status is FitStatus.ON_BOUND
    (said,) = [limitation for limitation in result.blockers if limitation.code is LimitationCode.VALUE_ON_BOUND]
    assert "natural frequency" in describe_limitation(said)
    assert LimitationCode.NATURAL_FREQUENCY_CORRECTED not in [doubt.code for doubt in result.doubts]


@pytest.mark.parametrize(("motion", "shift"), [("strokes", 4), ("run_up", 4), ("run_up", 42)])
def test_a_lag_between_the_clocks_is_noticed(motion, shift):
    """The vibration comes some samples of 1 ms late."""
    truth = case(motion=motion, speed=900.0)
    records = simulate(truth)
    acceleration = np.concatenate([r.acceleration for r in records])
    late = np.concatenate([np.full(shift, np.nan), acceleration[:-shift]]).reshape(len(records), -1)
    records = [replace(r, acceleration=row) for r, row in zip(records, late, strict=True)]
    result = identify(records, truth.settings())
    assert_right(result, truth)
    assert any("lag" in describe_limitation(doubt) for doubt in result.doubts)


def test_a_sensor_that_points_the_other_way_changes_nothing():
    truth = case(speed=1600.0, model=replace(MODEL, torque=Torque(mean=10.0)))
    records = [replace(r, acceleration=-r.acceleration) for r in simulate(truth)]
    assert_right(identify(records, truth.settings()), truth)


def test_a_torque_of_another_unit_forbids_a_name():
    truth = case(speed=1600.0, measured=True)
    records = [replace(r, torque=3.0 * r.torque) for r in simulate(truth)]
    assert identify(records, truth.settings()).blockers


def test_noise_on_a_measured_torque_does_not_pass_for_vibration():
    truth = case(measured=True)
    rng = np.random.default_rng(3)
    records = [replace(r, torque=r.torque + 0.2 * rng.standard_normal(len(r))) for r in simulate(truth)]
    assert_right(identify(records, truth.settings()), truth, stds=6.0)


def test_without_torque_the_ratio_is_right_and_said_to_be_relative():
    truth = case()
    records = [replace(r, torque=np.full(len(r), np.nan)) for r in simulate(truth)]
    result = identify(records, truth.settings(**{"load.source": "unknown"}))
    assert result.relative
    ratio = result.index.circular_spline / result.index.flexspline
    assert ratio == pytest.approx(truth.index.circular_spline / truth.index.flexspline, rel=0.05)


def test_another_part_is_a_row_in_the_table_of_torque_lines(monkeypatch):
    """Motor ripple three times per motor revolution, with a row of its own: fitted, and named."""
    order, ripple = 240, 0.4  # cycles per output revolution; N·m
    truth = case(speed=600.0, model=replace(MODEL, torque=Torque(mean=10.0)))
    shaken = case(
        speed=600.0, model=replace(MODEL, torque=Torque(mean=10.0, load_order=order, load_fluctuation=ripple))
    )
    monkeypatch.setitem(unknowns.TORQUE_LINES, order, "motor")
    found = identify(simulate(shaken), truth.settings())
    assert_right(found, truth)
    (said,) = [doubt for doubt in found.doubts if doubt.code is LimitationCode.OTHER_PART]
    assert said.values["order"] == order
    assert said.values["torque_nm"] == pytest.approx(ripple, rel=0.2)
    assert "points to the motor" in describe_limitation(said)
    sound = identify(simulate(truth), truth.settings())
    assert LimitationCode.OTHER_PART not in [doubt.code for doubt in sound.doubts]


def test_line_amplitudes_are_those_of_the_steady_state():
    truth = case(model=replace(MODEL, torque=Torque(mean=10.0)), snr=40.0)
    records = simulate(truth)
    result = identify(records, truth.settings())
    model = truth.model
    if (
        records[0].speed[0] < 0.0
    ):  # backwards the harmonics' phases run the other way, which the coupling of lines feels
        parts = {name: getattr(model, name).phasors.conj() for name in ("circular_spline", "flexspline")}
        model = replace(model, **{name: StiffnessSeries.from_phasors(z) for name, z in parts.items()})
    expected = line_pairs(model, 1000.0, 3)
    for line, pair in zip(result.lines, expected, strict=True):
        # over a few seconds the groups of lines leak into each other by some 1e-3 of the strongest line
        np.testing.assert_allclose(line.amplitude, pair, rtol=0.01, atol=5e-3 * max(map(max, expected)))


def test_what_little_travel_leaves_open_is_in_the_uncertainty():
    truth = case(duration=4.0, speed=150.0)
    result = identify(simulate(truth), truth.settings())
    assert np.degrees(result.travel) < 50.0
    assert result.blockers == ()
    error = np.abs(np.subtract(result.index, truth.index)) / np.asarray(result.index_std)
    assert error.max() < 4.5, (result.index, truth.index, result.index_std)


def test_a_standing_joint_gives_nothing():
    truth = case()
    still = [replace(r, speed=np.zeros(len(r)), angle=np.zeros(len(r))) for r in simulate(truth)]
    assert identify(still, truth.settings()) is None


@pytest.mark.parametrize(
    ("spoil", "code"),
    [
        (lambda r: replace(r, acceleration=np.zeros(len(r))), LimitationCode.VIBRATION_CONSTANT),
        (lambda r: replace(r, speed=1e5 * r.speed, angle=1e5 * r.angle), LimitationCode.SEGMENT_UNUSABLE),
        (lambda r: replace(r, torque=np.full(len(r), 1e12)), LimitationCode.TORQUE_ABSURD),
    ],
    ids=["zero vibration", "speed", "torque"],
)
@pytest.mark.parametrize("motion", ["dwell", "strokes"])
def test_the_true_fault_of_absurd_input_is_named_and_no_part(spoil, code, motion):
    truth = case(duration=6.0, motion=motion)
    result = identify([spoil(r) for r in simulate(truth)], truth.settings())
    assert code in [limitation.code for limitation in result.blockers]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda r: replace(r, acceleration=1e200 * r.acceleration),
        lambda r: replace(r, acceleration=np.full(len(r), np.nan)),
        lambda r: replace(r, torque=np.zeros(len(r))),
    ],
    ids=["huge", "missing", "no torque"],
)
def test_absurd_input_never_raises_and_never_names(spoil):
    truth = case(duration=6.0)
    settings = truth.settings(**{"diagnosis.confirm_count": 1, "diagnosis.confirm_window": 1})
    result = identify([spoil(r) for r in simulate(truth)], settings)
    assert Judge(settings).judge(result, WAITING).component is Component.UNDETERMINED


def test_a_later_fault_is_reported_beside_the_verdict():
    truth = case()
    records = simulate(truth)
    identifier = Identifier(truth.settings())
    for record in records:
        identifier.add(record)
    for record in records[:4]:
        identifier.add(replace(record, acceleration=np.zeros(len(record)), continues=False))
    result = identifier.estimate()
    assert result is not None
    assert_right(result, truth)
    assert result.doubts[-1].code is LimitationCode.VIBRATION_CONSTANT
    for record in records[:4]:
        identifier.add(replace(record, continues=False))
    result = identifier.finish()
    assert result is not None
    assert LimitationCode.VIBRATION_CONSTANT not in [doubt.code for doubt in result.doubts]


def test_the_same_records_give_the_same_result():
    truth = case(motion="strokes")
    first, second = (identify(simulate(truth), truth.settings()) for _ in range(2))
    np.testing.assert_array_equal(first.circular_spline, second.circular_spline)
    assert first.index_std == second.index_std


@pytest.mark.slow
def test_a_defect_that_comes_later_is_seen():
    before, after = (
        case(model=replace(MODEL, circular_spline=StiffnessSeries((0.01,))), duration=40.0),
        case(duration=60.0),
    )
    identifier = Identifier(before.settings())
    for record in [*simulate(before), *(replace(r, continues=False) for r in simulate(after))]:
        identifier.add(record)
    result = identifier.finish()
    assert result is not None
    assert result.index.circular_spline > 0.05

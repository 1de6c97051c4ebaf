"""A slow sensor with its anti-aliasing filter hides lines: what it does not hear is unknown, not zero."""

import pytest
from tests.studies.false_alarms import assessed

SECOND_HARMONIC = {
    "defect": "custom",
    "flexspline.beta": [0.02, 0.1, 0.01],
    "flexspline.phase": [0.3, 1.1, 2.2],
    "circular_spline.beta": [0.012, 0.008, 0.004],
    "circular_spline.phase": [0.4, 1.0, -2.0],
    "unstable": "warn",
}
SLOW = {"sensor.rate": 250.0, "sensor.bandwidth": 100.0, "sensor.noise": 0.3}
STROKES = {"programme": "strokes", "strokes.angle": 150.0}


def said(rig, **told):
    """All that a monitor says of a flexspline whose second harmonic is bad."""
    given = {"reducer.transmission_error": 0.0} | {name.replace("__", "."): value for name, value in told.items()}
    return list(assessed(SECOND_HARMONIC | SLOW | rig, given))


@pytest.mark.slow
@pytest.mark.parametrize("speed", [700, 850, 1000, 1150, 1300, 1450, 1750, 1900, 2050, 2300, 2600, 2900])
def test_a_harmonic_that_is_not_heard_never_makes_another_part_the_bad_one(speed):
    """Whatever the filter, which the monitor is not told."""
    fixed = {"programme": "fixed", "fixed.speed": float(speed), "duration": 8.0}
    for order in (2, 8):
        assessments = said(fixed | {"sensor.filter_order": order})
        assert {a.verdict.component.value for a in assessments} <= {"flexspline", "undetermined"}


def test_lines_beyond_the_bandwidth_are_the_reason_that_is_given():
    last = said({"programme": "fixed", "fixed.speed": 2300.0, "duration": 8.0})[-1]
    assert "from the pair k = 2 on lie beyond the 100 Hz that the sensor hears" in last.verdict.reason
    # of the first pair, which is heard, and without the second, which is not
    assert 100.0 * last.identification.index.flexspline == pytest.approx(2.0, abs=0.3)
    assert min(last.identification.index_std) > last.settings.diagnosis.warn_index


def test_a_sensor_that_hears_none_of_the_lines_says_so():
    last = said({"programme": "fixed", "fixed.speed": 1200.0, "duration": 6.0}, input__bandwidth=30.0)[-1]
    assert last.verdict.fault_code.value == "HD_UNDETERMINED"
    assert "all lines lie beyond the 30 Hz that the sensor hears" in last.verdict.reason


def test_with_the_bandwidth_given_fast_strokes_show_what_they_pass_through():
    last = said(STROKES | {"strokes.speed": 2100.0, "duration": 12.0}, input__bandwidth=100.0)[-1]
    assert last.verdict.component.value == "flexspline"
    assert 100.0 * last.identification.index.flexspline == pytest.approx(10.2, abs=1.0)

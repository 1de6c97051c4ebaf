"""Drives with a transmission error at the splines' own lines: both kinds of reading, and what they accuse."""

from dataclasses import replace

import pytest
from tests.studies.reach import last_assessment
from tests.studies.reach_sets import random_drive

from hd_monitor.diagnosis.verdict import Cause

SEED = 3


@pytest.mark.parametrize(("kind", "cause"), [("torque varies", Cause.STIFFNESS), ("error", Cause.TRANSMISSION_ERROR)])
def test_the_two_kinds_of_fault_are_distinguished(kind, cause):
    drive = random_drive(kind, SEED, 1)
    assert drive.bad != "none"
    last = last_assessment(drive)
    found = last.identification
    assert found is not None
    assert found.transmission_error is not None
    assert found.transmission_error_std is not None
    assert last.verdict.component.value == drive.bad
    assert last.verdict.cause is cause
    for value, std, truth in zip(found.index, found.index_std, drive.index, strict=True):
        assert abs(value - truth) < 4.0 * std + 1e-4
        assert std < 0.005
    for value, std, truth in zip(found.transmission_error, found.transmission_error_std, drive.error, strict=True):
        assert abs(value - truth) < 4.0 * std + 5e-3
        assert std < 0.05


def test_where_no_error_is_expected_none_is_estimated():
    found = last_assessment(random_drive("clips", SEED, 0)).identification
    assert found is not None
    assert found.transmission_error is None
    assert found.transmission_error_std is None


def test_a_sensor_that_hears_nothing_proves_nothing():
    """Only noise where even a sound reducer's lines would show: no verdict, and no health."""
    drive = random_drive("paper's world", SEED, 0)
    last = last_assessment(replace(drive, rig=drive.rig | {"sensor.fault": "dead"}))
    assert last.verdict.component.value == "undetermined"
    assert "hears nothing" in last.verdict.reason

"""Drives with a transmission error at the splines' own lines: both kinds of reading, and what they accuse."""

import pytest
from tests.studies.transmission_error import random_drive, watch

from hd_monitor.diagnosis.verdict import Cause
from hd_monitor.reducer import LinePair


@pytest.mark.parametrize(("kind", "cause"), [("varying", Cause.STIFFNESS), ("error", Cause.TRANSMISSION_ERROR)])
def test_the_two_kinds_of_fault_are_told_apart(kind, cause):
    rig, indexes, errors, bad = random_drive(kind, 3, 12.0)
    last = watch(rig, 1.0)
    found = last.identification
    assert found is not None
    assert last.verdict.component.value == bad
    assert last.verdict.cause is cause
    for spline in LinePair._fields:
        index, index_std = getattr(found.index, spline), getattr(found.index_std, spline)
        error, error_std = getattr(found.transmission_error, spline), getattr(found.transmission_error_std, spline)
        assert abs(index - indexes[spline]) < 4.0 * index_std + 1e-4
        assert abs(error - errors[spline]) < 4.0 * error_std + 5e-3
        assert index_std < 0.005
        assert error_std < 0.05


def test_where_no_error_is_expected_none_is_estimated():
    rig, *_ = random_drive("sound", 0, 5.0)
    found = watch(rig, 0.0).identification
    assert found is not None
    assert found.transmission_error is None
    assert found.transmission_error_std is None


def test_a_sensor_that_hears_nothing_proves_nothing():
    """Only noise where even a sound reducer's lines would show: no verdict, and no health."""
    rig, *_ = random_drive("varying", 3, 12.0)
    last = watch(rig | {"sensor.fault": "dead"}, 0.0)
    assert last.verdict.component.value == "undetermined"
    assert "hears nothing" in last.verdict.reason

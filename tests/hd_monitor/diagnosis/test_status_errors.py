"""Transmission errors in a status: keys that are there once there is a number."""

from tests.studies.transmission_error import random_drive, watch

from hd_monitor.diagnosis.status import status_of


def test_estimated_errors_are_numbers_with_their_unit():
    rig, _, errors, bad = random_drive("error", 3, 12.0)
    status = status_of(watch(rig, 1.0), "joint")
    assert status.value("cause") == "transmission_error"
    for spline, true in errors.items():
        part = spline.replace("_", " ")
        assert abs(float(status.value(f"{part} transmission error (arcmin)")) - true) < 0.1
        assert 0.0 < float(status.value(f"{part} transmission error std (arcmin)")) < 0.1
    assert bad.replace("_", " ") in status.message
    assert "transmission error of the flexspline" in status.message


def test_without_estimated_errors_their_keys_are_left_out():
    rig, *_ = random_drive("sound", 0, 5.0)
    status = status_of(watch(rig, 0.0), "joint")
    assert not [key for key, _ in status.values if "transmission error" in key]

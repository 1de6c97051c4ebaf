"""Transmission errors in a status: keys that are there once there is a number."""

from dataclasses import replace

from tests.studies.reach import last_assessment
from tests.studies.reach_sets import random_drive

from hd_monitor.diagnosis.status import status_of
from hd_monitor.reducer import LinePair

SEED = 3


def test_estimated_errors_are_numbers_with_their_unit():
    drive = random_drive("error", SEED, 4)
    noisy = replace(drive, rig=drive.rig | {"sensor.noise": 2.0})
    status = status_of(last_assessment(noisy), "joint")
    assert status.value("cause") == "transmission_error"
    for spline, true in zip(LinePair._fields, drive.error, strict=True):
        part = spline.replace("_", " ")
        assert abs(float(status.value(f"{part} transmission error (arcmin)")) - true) < 0.1
        assert 0.0 < float(status.value(f"{part} transmission error std (arcmin)")) < 0.1
    assert drive.bad.replace("_", " ") in status.message
    assert "transmission error of the flexspline" in status.message


def test_without_estimated_errors_their_keys_are_left_out():
    status = status_of(last_assessment(random_drive("clips", SEED, 0)), "joint")
    assert not [key for key, _ in status.values if "transmission error" in key]

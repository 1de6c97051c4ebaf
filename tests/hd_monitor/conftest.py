from pathlib import Path

import numpy as np
import pytest
import scipy.io

from hd_monitor.acquisition.record import JointSamples

RECORDINGS = Path(__file__).parents[2].parent / "shared" / "data"
"""Real recordings beside the checkout; they are not part of it (licences)."""


@pytest.fixture(scope="session")
def recording():
    """Path of a real recording by its name; skips the test where there is none."""

    def path(name: str) -> Path:
        file = RECORDINGS / name
        if not file.exists():
            pytest.skip(f"no recording {name} in {RECORDINGS}")
        return file

    return path


@pytest.fixture(scope="session")
def cwru(recording):
    """The motor rig's accelerometer signals at 12 kHz, by channel (DE, FE)."""
    content = scipy.io.loadmat(recording("cwru/B007_0.mat"))
    return {channel: content[f"X118_{channel}_time"].ravel() for channel in ("DE", "FE")}


@pytest.fixture(scope="session")
def ur10e(recording):
    """Joint samples of a UR10e arm by file and joint (1 … 6); the effort is the motor current [A]."""

    def joint(file: str, number: int) -> JointSamples:
        table = np.loadtxt(recording(f"ur10e/{file}.csv"), delimiter=",")
        return JointSamples(
            times=table[:, 0] - table[0, 0],
            angle=table[:, number],
            speed=table[:, 6 + number],
            effort=table[:, 12 + number],
        )

    return joint


@pytest.fixture(scope="session")
def franka(recording):
    """Joint samples of a Franka arm by joint (1 … 7); the effort is the joint torque [N·m]."""
    table = np.loadtxt(recording("franka/panda.csv.gz"), delimiter=",")

    def joint(number: int) -> JointSamples:
        return JointSamples(
            times=table[:, 0] - table[0, 0],
            angle=table[:, number],
            speed=table[:, 7 + number],
            effort=table[:, 14 + number],
        )

    return joint

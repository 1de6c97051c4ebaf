"""A recording of the rig with a defect, for the commands that read one."""

from pathlib import Path

import pytest
from tests.hd_monitor.offline import recordings as rec


@pytest.fixture(scope="session")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    events = rec.simulated(programme="fixed", fixed__speed=1200.0, duration=12.0, defect="flexspline")
    return rec.write(tmp_path_factory.mktemp("rig") / "bag", events)

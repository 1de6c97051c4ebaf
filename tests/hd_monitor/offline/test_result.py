"""Where nothing can be said of a joint, the reason is the one that holds."""

from pathlib import Path

import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.offline.errors import BagError
from hd_monitor.offline.plan import Request
from hd_monitor.offline.run import replay_bag

VIBRATION, MOTION = "/torsional_acceleration/block", "/joint_states"


@pytest.mark.parametrize(
    ("vibration", "motion", "said"),
    [
        ((7.5, 8.0), (0.0, 7.4), rf"no usable vibration samples.*{VIBRATION} \(10\).*hardly overlap in time"),
        ((5.0, 8.0), (0.0, 3.0), r"no usable vibration samples.*hardly overlap in time"),
        ((0.0, 3.0), (5.0, 8.0), rf"no usable joint states.*{MOTION} \(300\).*hardly overlap in time"),
    ],
)
def test_sparse_messages_are_not_called_missing(
    tmp_path: Path, vibration: tuple[float, float], motion: tuple[float, float], said: str
) -> None:
    spans = {VIBRATION: vibration, MOTION: motion}
    kept = [
        event
        for event in rec.simulated(programme="fixed", fixed__speed=850.0, duration=8.0)
        if spans[event.topic][0] <= (event.time - rec.START) * 1e-9 < spans[event.topic][1]
    ]
    with pytest.raises(BagError, match=said):
        replay_bag(rec.write(tmp_path / "bag", kept), Request())

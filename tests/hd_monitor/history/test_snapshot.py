"""A snapshot is written once a transition, within bounds, or not at all."""

import json
from pathlib import Path

import pytest
from tests.hd_monitor.monitored import SETTINGS, Recording, latest, run

from hd_monitor.assessment import Assessment
from hd_monitor.diagnosis.verdict import Level
from hd_monitor.errors import OutputError
from hd_monitor.history.mcap import Channel
from hd_monitor.history.snapshot import MOST_BYTES, MOST_SNAPSHOTS, RecentMessages, Snapshots
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

SECOND = 1_000_000_000
CHANNELS = {Quantity.MOTION: Channel("/joint_states", "sensor_msgs/msg/JointState", "")}


@pytest.fixture(scope="module")
def assessment() -> Assessment:
    return latest(run(Recording(seconds=6.0)))


def snapshots(folder: Path, serial: str = "A/7") -> Snapshots:
    given = {"history.path": str(folder / "ledger.sqlite"), "reducer.serial": serial}
    return Snapshots("elbow", JointSettings.from_mapping(given), Level.OK)


def test_one_minute_is_kept() -> None:
    recent = RecentMessages()
    for second in range(100):
        recent.add(second * SECOND, {Quantity.MOTION: [b"m%d" % second], Quantity.VIBRATION: []})
    assert [time // SECOND for time, _, _ in recent] == list(range(39, 100))
    assert [message for _, _, message in recent] == [b"m%d" % second for second in range(39, 100)]


def test_the_oldest_make_room_where_messages_are_many() -> None:
    recent = RecentMessages()
    for number in range(1000):
        recent.add(number, {Quantity.VIBRATION: [bytes(100_000)]})
    assert 0.9 * MOST_BYTES < sum(len(message) for _, _, message in recent) <= MOST_BYTES
    assert [time for time, _, _ in recent][-1] == 999


def test_only_a_new_level_above_ok_is_due(tmp_path: Path) -> None:
    taker = snapshots(tmp_path)
    levels = [Level.OK, Level.WARN, Level.WARN, Level.ERROR, Level.OK, Level.ERROR, Level.WARN]
    assert [taker.is_due(level) for level in levels] == [False, True, False, True, False, True, True]


def test_a_level_known_from_before_a_restart_is_not_due() -> None:
    settings = JointSettings.from_mapping({"history.path": "ledger.sqlite"})
    assert not Snapshots("elbow", settings, Level.ERROR).is_due(Level.ERROR)


def test_what_was_said_and_the_parameters_stand_beside_the_data(tmp_path: Path, assessment: Assessment) -> None:
    folder = snapshots(tmp_path).write(assessment, CHANNELS)
    assert folder.parent == tmp_path / "ledger.sqlite.snapshots" / "A_7"
    reducer, inputs = json.loads((folder / "status.json").read_text())
    assert (reducer["fault_code"], inputs["subject"]) == ("HD_FLEXSPLINE", "elbow input")
    assert 'joints: ["elbow"]' in (folder / "parameters.yaml").read_text()
    assert "history." not in (folder / "parameters.yaml").read_text()


def test_the_oldest_make_room_for_new_ones_and_strangers_stay(tmp_path: Path, assessment: Assessment) -> None:
    from dataclasses import replace

    taker = snapshots(tmp_path)
    taker.folder.mkdir(parents=True)
    (taker.folder / "notes").mkdir()
    written = [
        taker.write(replace(assessment, stamp=assessment.stamp + number * SECOND), CHANNELS)
        for number in range(MOST_SNAPSHOTS + 3)
    ]
    assert sorted(taker.folder.iterdir()) == sorted([*written[3:], taker.folder / "notes"])


def test_nothing_is_left_of_one_that_cannot_be_written(
    tmp_path: Path, assessment: Assessment, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(path: Path, content: bytes) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", fail)
    taker = snapshots(tmp_path)
    with pytest.raises(OutputError, match="cannot be written: No space left on device"):
        taker.write(assessment, CHANNELS)
    assert list(taker.folder.iterdir()) == []


def test_the_settings_are_those_of_the_replay(tmp_path: Path, assessment: Assessment) -> None:
    from hd_monitor.offline.parameters import load_parameters
    from hd_monitor.settings import split_joints

    folder = snapshots(tmp_path).write(assessment, CHANNELS)
    (settings,) = split_joints(load_parameters(folder / "parameters.yaml")).values()
    assert settings == SETTINGS

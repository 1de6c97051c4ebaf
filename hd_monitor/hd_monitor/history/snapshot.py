"""Snapshots: what a reducer's inputs said in the minute before its status became a warning or an error."""

import json
import re
import shutil
import tempfile
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

from .. import __version__
from ..assessment import Assessment
from ..contract import NANOSECONDS
from ..diagnosis.status import Status, input_status_of, status_of
from ..diagnosis.verdict import Level
from ..errors import OutputError
from ..settings import JointSettings
from ..sources import Quantity
from .mcap import Channel, Recorded, mcap_file

SECONDS = 60
"""Time for which messages are kept [s]."""
MOST_BYTES = 8_000_000
"""Of the messages kept for a joint; the oldest make room."""
MOST_SNAPSHOTS = 10
"""Kept of a reducer; the oldest make room."""

DATA, PARAMETERS, STATUS = "data.mcap", "parameters.yaml", "status.json"

_PER_MESSAGE = 50  # bytes that a message takes besides its data
_NAME = re.compile(r"\d{8}T\d{6}Z-[A-Z_]+")


class RecentMessages:
    """The newest minute of a joint's serialised messages, at most `MOST_BYTES` of them."""

    def __init__(self) -> None:
        self._batches: deque[tuple[int, Quantity, Sequence[bytes], int]] = deque()
        self._size = 0

    def add(self, now: int, messages: Mapping[Quantity, Sequence[bytes]]) -> None:
        """Keep messages that have come by `now` [ns]."""
        for quantity, batch in messages.items():
            if batch:
                size = sum(map(len, batch)) + _PER_MESSAGE * len(batch)
                self._batches.append((now, quantity, batch, size))
                self._size += size
        while self._batches and (self._size > MOST_BYTES or now - self._batches[0][0] > SECONDS * NANOSECONDS):
            self._size -= self._batches.popleft()[3]

    def __iter__(self) -> Iterator[tuple[int, Quantity, bytes]]:
        """Yield the messages in the order in which they came."""
        for time, quantity, batch, _ in self._batches:
            for message in batch:
                yield time, quantity, message


class Snapshots:
    """Writes a joint's snapshots beside its ledger.

    Parameters
    ----------
    joint : str
    settings : JointSettings
        With ``history.path``.
    level : Level
        Of the status at the start, for which there is no snapshot.
    """

    def __init__(self, joint: str, settings: JointSettings, level: Level) -> None:
        ledger = Path(settings.history.path).expanduser()
        reducer = re.sub(r"[^\w.-]+", "_", settings.serial or joint)
        self.folder = ledger.with_name(f"{ledger.name}.snapshots") / reducer
        self._joint = joint
        self._level = level
        self.recent = RecentMessages()

    def is_due(self, level: Level) -> bool:
        """Whether a status of this level, following the last one asked about, is to have a snapshot."""
        before, self._level = self._level, level
        return level > Level.OK and level != before

    def write(self, assessment: Assessment, channels: Mapping[Quantity, Channel]) -> Path:
        """Write the minute before an assessment, with the parameters and what the statuses say; return the folder.

        Raises
        ------
        OutputError
            If it cannot be written; nothing is left of it then.
        """
        at = datetime.fromtimestamp(assessment.stamp / NANOSECONDS, UTC)
        target = self.folder / f"{at:%Y%m%dT%H%M%SZ}-{assessment.verdict.fault_code.value}"
        order = list(channels)
        messages = [Recorded(order.index(q), time, data) for time, q, data in self.recent if q in channels]
        files = {
            DATA: mcap_file(list(channels.values()), messages, library=f"hd_monitor {__version__}"),
            PARAMETERS: _parameters(self._joint, assessment.settings).encode(),
            STATUS: _statuses(status_of(assessment, self._joint), input_status_of(assessment, self._joint)).encode(),
        }
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryDirectory(dir=self.folder) as partial:
                whole = Path(partial, target.name)
                whole.mkdir()
                for name, content in files.items():
                    (whole / name).write_bytes(content)
                shutil.rmtree(target, ignore_errors=True)
                whole.rename(target)
            for old in sorted(path for path in self.folder.iterdir() if _NAME.fullmatch(path.name))[:-MOST_SNAPSHOTS]:
                shutil.rmtree(old)
        except OSError as error:
            raise OutputError(f"the snapshot {target} cannot be written: {error.strerror or error}") from None
        return target


def _parameters(joint: str, settings: JointSettings) -> str:
    """Write a parameter file for a replay of this joint alone."""
    values = {name: value for name, value in settings.values if not name.startswith("history.")}
    lines = [f"    {name}: {json.dumps(value, ensure_ascii=False)}" for name, value in values.items()]
    return "\n".join(["/**:", "  ros__parameters:", f"    joints: {json.dumps([joint])}", *lines, ""])


def _statuses(*statuses: Status) -> str:
    rows = [
        {"subject": s.subject, "level": s.level, "message": s.message, "hardware_id": s.hardware_id, **dict(s.values)}
        for s in statuses
    ]
    return json.dumps(rows, ensure_ascii=False, indent=2) + "\n"

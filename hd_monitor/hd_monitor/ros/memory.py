"""What a node remembers of one joint's reducer: the ledger, whose failures cost entries, never a verdict."""

from collections.abc import Callable
from pathlib import Path

from ..assessment import Assessment
from ..history.diary import Diary
from ..history.entry import Entry, Kind
from ..history.ledger import Ledger, LedgerError
from ..history.rating import Baseline, baseline_of
from ..identification.sensorless.agreement import DirectionEvidence
from ..settings import JointSettings

NEWEST = 200
"""Entries that are read at the start: more than the memory of the evidence reaches back."""


class Memory:
    """One joint's part of the ledger.

    Parameters
    ----------
    joint : str
    settings : JointSettings
        With ``history.path``.
    complain : callable
        Told in a sentence, once, why entries are lost.

    Attributes
    ----------
    last : Entry or None
        The newest entry with a verdict on this reducer, as of the start or of the last exchange.
    evidence : tuple of tuple of DirectionEvidence
        Lines by direction of earlier motion, the oldest first; from joint states alone.
    baseline : mapping or None
        Lines of the baseline, once it is set or complete.
    """

    def __init__(self, joint: str, settings: JointSettings, complain: Callable[[str], None]) -> None:
        self._joint = joint
        self._serial = settings.serial
        self._complain = complain
        self._complained = ""
        self._diary = Diary(joint, settings.history.interval)
        self._newest: Assessment | None = None
        self._ledger: Ledger | None = None
        self.last: Entry | None = None
        self.evidence: tuple[tuple[DirectionEvidence, ...], ...] = ()
        self.baseline: Baseline | None = None

        def read() -> None:
            self._ledger = Ledger(Path(settings.history.path).expanduser())
            known = self._ledger.entries(settings.serial, joint, newest=NEWEST)
            self.last = next((entry for entry in reversed(known) if entry.verdict is not None), None)
            alike = [entry for entry in known if entry.kind is Kind.EVIDENCE and entry.source == settings.input.source]
            self.evidence = tuple(entry.evidence for entry in alike if entry.evidence)
            self._find_baseline()

        self._try(read)

    def note(self, assessment: Assessment) -> None:
        """Take the next assessment, and write what is worth an entry."""
        self._newest = assessment
        if entry := self._diary.note(assessment):
            self._append(entry)
            if self.baseline is None:
                self._try(self._find_baseline)

    def close(self) -> None:
        """Write what followed the last entry, and close the file."""
        self._write_rest()
        if self._ledger is not None:
            self._ledger.close()
            self._ledger = None

    def mark(self, kind: Kind, at: float) -> None:
        """Note an exchange or a baseline at a time [s]."""
        if kind is Kind.EXCHANGE:
            self.last, self.evidence, self.baseline = None, (), None
        else:
            self._write_rest()
        if (ledger := self._ledger) is not None:
            self._try(lambda: ledger.mark(self._serial, self._joint, kind, at))
            self._try(self._find_baseline)

    def _write_rest(self) -> None:
        if self._newest is not None and (entry := self._diary.close(self._newest)):
            self._append(entry)

    def _find_baseline(self) -> None:
        if self._ledger is not None:
            self.baseline = baseline_of(self._ledger.entries(self._serial, self._joint))

    def _append(self, entry: Entry) -> None:
        if (ledger := self._ledger) is not None:
            self._try(lambda: ledger.append(entry))

    def _try(self, work: Callable[[], None]) -> None:
        try:
            work()
        except LedgerError as error:
            if str(error) != self._complained:
                self._complained = str(error)
                self._complain(f"{self._joint}: the history is not kept: {error}")

"""What a user reads when something around the reducer is broken: a fault a row, on a worn and on a sound unit.

    python tests/studies/faults.py > msgs_doc/faults.md
    python tests/studies/faults.py dead stuck          those rows alone

A simulated rig sends its messages, each fault spoils them, and the monitor gets what is left of them. The worn unit's
flexspline is defective, the sound one has no defect.
"""

import re
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from hd_monitor.acquisition.quality import Quality
from hd_monitor.adapters import UNNAMED_JOINT, Inputs
from hd_monitor.assessment import Assessment
from hd_monitor.contract import NANOSECONDS
from hd_monitor.diagnosis.inputs import InputCode, InputState
from hd_monitor.diagnosis.verdict import Component, Verdict
from hd_monitor.monitor import Monitor
from hd_monitor.offline.plan import Request
from hd_monitor.offline.run import replay_bag
from hd_monitor.process import set_up_process
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity
from hd_sim_node.bag import write_bag
from hd_sim_node.messages.encoding import encode
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.studies.fault_rows import FAULTS, Fault

START = 1_700_000_000_000_000_000
RIG = {"programme": "strokes", "duration": 12.0}
WATCHED = {"analysis.period": 2.0, "input.timeout": 2.0, "input.startup_warning": 2.0, "input.startup_timeout": 4.0}
"""Few assessments: a fit that cannot succeed, as under a fault, costs seconds of processor time each. And less patience
with the inputs than by default, as the recordings are short."""
TRUTHS = {"flexspline": Component.FLEXSPLINE, "none": Component.NONE}
"""What is right, by the rig's parameter `defect`."""


# Replaying -----------------------------------------------------------------------------------------------------------


class Said(NamedTuple):
    """What the monitor said in the end."""

    verdict: Verdict
    input: InputState
    quality: Quality
    used: int
    """Samples that the result rests on."""
    notes: Sequence[str]
    """What is wrong with the bag."""

    @property
    def reason(self) -> str:
        """What a user reads."""
        if self.input.code is InputCode.OK:
            return self.verdict.reason
        return f"{self.verdict.reason}. Input: {self.input.reason}"

    @property
    def codes(self) -> str:
        """The verdict's code, and the input's where something is wrong with it."""
        code = f"`{self.verdict.fault_code.value}`"
        return code if self.input.code is InputCode.OK else f"{code}, `{self.input.code.value}`"


def _said(assessment: Assessment, notes: Sequence[str] = ()) -> Said:
    found = assessment.identification
    return Said(assessment.verdict, assessment.input, assessment.quality, found.samples if found else 0, notes)


def replayed(fault: Fault, defect: str) -> Said:
    """Simulate a unit with this `defect`, spoil its messages and put them through a monitor."""
    rig = RigSettings.from_mapping({**RIG, **fault.rig, "defect": defect})
    if fault.damage is not None:
        return _from_bag(fault, rig)
    watched = JointSettings.from_mapping({**WATCHED, **fault.monitor})
    monitor = Monitor(watched)
    inputs = Inputs(UNNAMED_JOINT, watched, monitor)
    changes = {Quantity.VIBRATION: fault.blocks, Quantity.MOTION: fault.joints}
    sent = dict.fromkeys(changes, 0)
    other = RigSettings.from_mapping({**RIG, **fault.rig, **fault.motion})
    for stretches in zip(Simulation(rig), Simulation(other), strict=True):
        senders = dict(zip(changes, stretches, strict=True))  # the vibration's, and that of the joint states
        for quantity, change in changes.items():
            topic, stretch = watched.sources[quantity].topic, senders[quantity]
            messages = encode(stretch, rig, START)
            going_out = [messages[topic][row] for row in stretch.dispatch[topic].row.tolist()]
            if change is not None:
                numbered = enumerate(going_out, sent[quantity])
                sent[quantity] += len(going_out)
                going_out = list(chain.from_iterable(change(number, data) for number, data in numbered))
            inputs.add(quantity, going_out)
        monitor.advance()
    return _said(monitor.finish() or monitor.silence(START + round(12.0 * NANOSECONDS)))


def _from_bag(fault: Fault, rig: RigSettings) -> Said:
    assert fault.damage is not None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag"
        write_bag(rig, path, storage=fault.storage, start=START)
        (file,) = (path for path in path.iterdir() if path.suffix in {".mcap", ".db3"})
        file.write_bytes(fault.damage(bytearray(file.read_bytes())))
        outcome = replay_bag(path, Request(parameters=WATCHED))
    last = outcome.joints[0].last
    assert last is not None
    return _said(last, outcome.notes)


# The page ------------------------------------------------------------------------------------------------------------

PAGE = Path(__file__).resolve().parents[2] / "msgs_doc" / "faults.md"

HEAD = """\
# Faults, and what a user reads of them

Each row spoils the messages of a simulated rig in one way (12 s of strokes) and puts them through the monitor: once
with a defective flexspline, once with a sound reducer. No row may accuse a part that is sound. Every row should name
the right part, or be `undetermined` with the true cause; **rows in bold do not yet**, and say what is missing.
A second code is that of the input, where it fails: a verdict that was there before stands.

The page is written by `python tests/studies/faults.py > msgs_doc/faults.md`; `tests/studies/test_faults.py` runs every
row by the name in the last column and holds this page to it. Numbers are those of one machine.

| fault | bad flexspline | sound | what the user reads, here of the bad flexspline | what is kept | test |
|---|---|---|---|---|---|
"""


@dataclass(frozen=True)
class Row:
    """A row of the page: what was said of the worn and of the sound unit."""

    name: str
    worn: Said
    sound: Said

    @property
    def component(self) -> tuple[Component, Component]:
        """What was named, of the worn and of the sound unit."""
        return self.worn.verdict.component, self.sound.verdict.component

    @property
    def gap(self) -> bool:
        """Whether one of them is neither right nor undetermined with the cause."""
        fault = FAULTS[self.name]
        pairs = zip((self.worn, self.sound), TRUTHS.values(), strict=True)
        return not all(_is_right(fault, said, truth) for said, truth in pairs)

    def line(self) -> str:
        """Write the row as a line of the page."""
        fault, quality = FAULTS[self.name], self.worn.quality
        reason = self.worn.reason
        if self.component[0] == TRUTHS["flexspline"] and self.component[1] == Component.UNDETERMINED:
            reason += f". Of the sound unit: {self.sound.reason}"
        complaint = "" if quality.last_fault in reason else f". Last complaint: {quality.last_fault}"
        notes = "".join(f". Note: {note}" for note in self.worn.notes)
        (_, samples), *counts = quality.counts()
        kept = ", ".join(
            [
                f"{self.worn.used} of {samples} samples used",
                *(f"{key} {count}" for key, count in counts if count != "0"),
            ]
        )
        title = f"**{fault.fault}**; {fault.gap}" if fault.gap else fault.fault
        codes = f"{self.worn.codes} | {self.sound.codes}"
        return f"| {title} | {codes} | {reason}{complaint}{notes} | {kept} | `{self.name}` |"


def _is_right(fault: Fault, said: Said, truth: Component) -> bool:
    named = bool(fault.cause) and fault.cause in said.reason
    return said.verdict.component is truth or (said.verdict.component is Component.UNDETERMINED and named)


def row(name: str) -> Row:
    """Run a row."""
    return Row(name, *(replayed(FAULTS[name], defect) for defect in TRUTHS))


def check(name: str) -> None:
    """Run a row for a test.

    Raises
    ------
    AssertionError
        If a sound part is accused, the row is better or worse than it is declared to be, or the page says other words.
    """
    done = row(name)
    for component, truth in zip(done.component, TRUTHS.values(), strict=True):
        assert component in {truth, Component.UNDETERMINED, Component.NONE}, f"{name}: {component}, not {truth}"
    assert done.gap == bool(FAULTS[name].gap), f"{name}: {done.worn.reason} / {done.sound.reason}"
    assert words_of(done.line()) in map(words_of, PAGE.read_text(encoding="utf-8").splitlines()), (
        f"msgs_doc/faults.md is not up to date: {done.line()}"
    )


def words_of(line: str) -> str:
    """Leave out numbers: their last digits, and counts near a limit, are the machine's."""
    return re.sub(r"-?\d[\d.]*", "#", line)


def main(names: Sequence[str]) -> int:
    """Print rows; all of them as the page. Status 1 if a row is not what it is declared to be."""
    if not names:
        print(HEAD, end="")
    surprises = []
    for name in names or FAULTS:
        done = row(name)
        print(done.line(), flush=True)
        if done.gap != bool(FAULTS[name].gap):
            surprises.append(f"{name} {'is not' if done.gap else 'has become'} right: {done.component}")
    print("\n".join(surprises), end="", file=sys.stderr)
    return int(bool(surprises))


if __name__ == "__main__":
    set_up_process()
    raise SystemExit(main(sys.argv[1:]))

"""One joint as the node sees it: its monitor, its last input, and the result. Knows no rclpy."""

import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from ..acquisition.presence import Loss, Presence
from ..adapters import Inputs
from ..assessment import Assessment
from ..contract import NANOSECONDS
from ..diagnosis.absence import (
    NO_SIMULATED_TIME,
    WAITING,
    Explain,
    internal_error,
    lost_by_clock,
    remembered,
    stamped_by_two_clocks,
)
from ..diagnosis.status import Status, status_of
from ..diagnosis.verdict import FaultCode, Verdict
from ..errors import HdMonitorError, ParameterError
from ..evidence import new_identifier
from ..history.entry import Kind
from ..monitor import Monitor
from ..orders.zoom import ZoomSpectrum
from ..settings import JointSettings
from ..sources import Quantity
from .memory import Memory


class JointWatch:
    """Feeds one joint's monitor and keeps what its status says; an error of the core ends here.

    Parameters
    ----------
    joint : str
    settings : JointSettings
    now : int
        The node's time [ns]; silence counts from here.
    explain : callable
        Asked where an input is lost.
    explain_crowd : callable
        Asked which inputs have several publishers; the answer is added to what the status says.

    memory : Memory, optional
        What is remembered of earlier runs.
    date : callable
        The time [s] by the messages' clock.

    Attributes
    ----------
    present : Assessment
        What the status says now; from the start that it waits.
    errors : int
        Errors of the core so far.
    last_error : str
        Traceback of the newest one; empty if there is none.
    """

    def __init__(
        self,
        joint: str,
        settings: JointSettings,
        now: int,
        explain: Explain,
        explain_crowd: Callable[[], str],
        memory: Memory | None = None,
        date: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self.joint = joint
        self.settings = settings
        self._explain = explain
        self._explain_crowd = explain_crowd
        self._memory = memory
        self._date = date
        self._remembered = memory.last if memory is not None else None
        self.errors = 0
        self.last_error = ""
        self._presence = Presence(settings.sources, round(settings.input.timeout * NANOSECONDS))
        self._assessed = False
        self._start()
        self.wake(now)
        self.present = self._recalled(self._other(now, WAITING))
        self._told = self._key()
        self._transitions: list[Status] = []

    def _start(self) -> None:
        known = self._memory.evidence if self._memory is not None else ()
        self._monitor = Monitor(self.settings, new_identifier(self.settings, known=known))
        self._inputs = Inputs(self.joint, self.settings, self._monitor)

    def wake(self, now: int) -> None:
        """Count silence from `now` [ns] on: the node has only just begun to listen."""
        self._presence.start(now or None)

    # What the node calls --------------------------------------------------------------------------------------------

    def feed(self, messages: Mapping[Quantity, Sequence[bytes]], now: int) -> bool:
        """Hand over serialised messages at the node's time [ns]; return True if that led to a new assessment."""
        try:
            stamps = self._monitor.newest_stamps
            for quantity, new in messages.items():
                if new:
                    before = stamps.get(quantity)
                    self._inputs.add(quantity, new)
                    if now:  # else a simulated clock has not begun
                        self._presence.note(quantity, now, now if stamps.get(quantity) != before else None)
            if self._memory is not None:
                self._monitor.baseline = self._memory.baseline
            assessments = self._monitor.advance()
            for assessment in assessments:
                self._show(self._explained(assessment, now))
                if self._memory is not None:
                    self._memory.note(assessment)
        except Exception as error:
            self._fail(error, now)
            return False
        self._assessed = self._assessed or bool(assessments)
        return bool(assessments)

    def check(self, now: int) -> None:
        """Look for inputs that are silent or useless; to be called once a second.

        A time `now` of 0 says that a simulated clock is used but has not begun.
        """
        if self._assessed:
            self._assessed = False
            return
        try:
            if not now:
                self._show(self._other(now, NO_SIMULATED_TIME))
            elif losses := self._presence.losses(now):
                self._show(self._other(now, self._describe(losses)))
        except Exception as error:
            self._fail(error, now)

    def status(self) -> Status:
        """Write what is known now."""
        return status_of(self.present, self.joint)

    def take_transitions(self) -> list[Status]:
        """Return the statuses that named another part, level or code than the one before, oldest first, once."""
        transitions, self._transitions = self._transitions, []
        return transitions

    def zoom(self) -> ZoomSpectrum | None:
        """Zoom spectrum of the present assessment, where there is one to show."""
        try:
            return self.present.zoom
        except HdMonitorError:  # the stretch holds no number, say: no picture, but no reason to restart
            return None
        except Exception as error:
            self._fail(error, self.present.stamp)
            return None

    def change_limits(self, settings: JointSettings) -> None:
        """Put other ``diagnosis.*`` parameters in force."""
        self.settings = settings
        self._monitor.change_limits(settings)

    def reset_latch(self) -> None:
        """Release a latched verdict."""
        self._monitor.reset_latch()

    def reset(self) -> None:
        """Forget all evidence: the reducer was exchanged."""
        self._monitor.reset()
        self._remembered = None
        self.mark(Kind.EXCHANGE)

    def set_baseline(self) -> None:
        """Declare the reducer to be as it should be from here on."""
        if self._memory is None:
            raise ParameterError("history.path is empty, so that no baseline can be kept; set it to a file")
        self.mark(Kind.BASELINE)

    def mark(self, kind: Kind) -> None:
        """Note an exchange or a baseline in the ledger, if there is one."""
        if self._memory is not None:
            self._memory.mark(kind, max(self._monitor.newest_stamps.values(), default=0) / NANOSECONDS)

    def close(self) -> None:
        """Write what the ledger does not have yet."""
        if self._memory is not None:
            self._memory.close()

    # ----------------------------------------------------------------------------------------------------------------

    def _describe(self, losses: Sequence[Loss]) -> Verdict:
        fault = self._monitor.silence(0).quality.last_fault
        return lost_by_clock(losses, self._monitor.newest_stamps, fault, self._explain)

    def _explained(self, assessment: Assessment, now: int) -> Assessment:
        """Add to a lost input what the monitor, which sees stamps only, cannot know."""
        if assessment.verdict.fault_code is not FaultCode.INPUT_LOST:
            return assessment
        stamps = self._monitor.newest_stamps
        if losses := self._presence.losses(now):
            return replace(assessment, verdict=self._describe(losses))
        if len(stamps) > 1 and max(stamps.values()) - min(stamps.values()) >= self._presence.timeout * NANOSECONDS:
            return replace(assessment, verdict=stamped_by_two_clocks(stamps))
        return assessment

    def _other(self, now: int, verdict: Verdict) -> Assessment:
        """Make an assessment that the monitor knows nothing of, with all that it knows."""
        return replace(self._monitor.silence(now), verdict=verdict)

    def _recalled(self, assessment: Assessment) -> Assessment:
        """Put the last verdict of an earlier run, with its age, in the place of none yet."""
        known = self._remembered
        if known is None or known.verdict is None or assessment.verdict.fault_code is not FaultCode.WAITING:
            return assessment
        age = max(self._date() - known.time, 0.0)
        verdict = remembered(known.verdict, age, assessment.verdict)
        return replace(assessment, verdict=verdict, extra=(*assessment.extra, ("evidence age (s)", f"{age:.0f}")))

    def _show(self, assessment: Assessment) -> None:
        if assessment.identification is not None and assessment.verdict.fault_code is not FaultCode.WAITING:
            self._remembered = None
        assessment = self._recalled(assessment)
        if self.errors:
            assessment = replace(assessment, extra=(*assessment.extra, ("internal errors", str(self.errors))))
        if crowd := self._explain_crowd():
            reason = f"{assessment.verdict.reason}; {crowd}"
            assessment = replace(assessment, verdict=replace(assessment.verdict, reason=reason))
        self.present = assessment
        if (key := self._key()) != self._told:
            self._told = key
            self._transitions.append(self.status())

    def _key(self) -> tuple[object, ...]:
        verdict = self.present.verdict
        return verdict.level, verdict.component, verdict.fault_code

    def _fail(self, error: Exception, now: int) -> None:
        """Restart this joint after an error of the core, and say so: the other joints must not suffer."""
        self.errors += 1
        self.last_error = traceback.format_exc()
        self._start()
        self._show(self._other(now, internal_error(error)))

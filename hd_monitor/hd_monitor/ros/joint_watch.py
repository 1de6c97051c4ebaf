"""One joint as the node sees it: its monitor, its last input, and the result. Knows no rclpy."""

import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from ..acquisition.presence import Presence
from ..adapters import Inputs
from ..assessment import Assessment
from ..contract import NANOSECONDS
from ..diagnosis.absence import internal_error
from ..diagnosis.inputs import (
    ARRIVING,
    Explain,
    InputCode,
    InputState,
    describe_inputs,
    no_simulated_time,
    stamped_by_two_clocks,
)
from ..diagnosis.status import Status, input_status_of, status_of
from ..diagnosis.verdict import Level
from ..errors import HdMonitorError, ParameterError
from ..evidence import new_identifier
from ..history.entry import Kind
from ..monitor import Monitor, Recalled
from ..orders.rms_curve import SpeedBin
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
        Asked where an input is missing.
    explain_crowd : callable
        Asked which inputs have several publishers; the answer is added to what the input's status says.
    memory : Memory, optional
        What is remembered of earlier runs.
    date : callable
        The time [s] by the messages' clock.

    Attributes
    ----------
    present : Assessment
        What the statuses say now; from the start that they wait.
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
        self.errors = 0
        self.last_error = ""
        self._assessed = False
        self._ahead: int | None = None  # ns by which the messages' clock is ahead of the node's
        self._start()
        self.wake(now)
        self._input = self._describe(now)
        self.present = self._quiet(now, self._input)
        self._told = self._key()
        self._transitions: list[tuple[Status, Status]] = []

    def _start(self) -> None:
        known, last = (self._memory.evidence, self._memory.last) if self._memory is not None else ((), None)
        recalled = Recalled(last.verdict, round(last.time * NANOSECONDS)) if last and last.verdict else None
        self._monitor = Monitor(self.settings, new_identifier(self.settings, known=known), recalled)
        self._inputs = Inputs(self.joint, self.settings, self._monitor)

    def wake(self, now: int) -> None:
        """Await the first data from `now` [ns] on: the node has only just begun to listen."""
        self._presence = Presence(self.settings)
        self._presence.start(now or None)
        self._looks_without_clock = 0

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
                self._ahead = assessment.stamp - now if now else None
                self._show(self._explained(assessment, now))
                if self._memory is not None:
                    self._memory.note(assessment)
        except Exception as error:
            self._fail(error)
            return False
        self._assessed = self._assessed or bool(assessments)
        return bool(assessments)

    def check(self, now: int) -> None:
        """Look for inputs that are missing; to be called once a second.

        A time `now` of 0 says that a simulated clock is used but has not begun.
        """
        if self._assessed:
            self._assessed = False
            return
        try:
            self._looks_without_clock += not now
            state = self._describe(now)
            if state.code is not InputCode.OK or self._input.code is InputCode.WAITING:
                self._show(self._quiet(now, state))
        except Exception as error:
            self._fail(error)

    def statuses(self) -> tuple[Status, Status]:
        """Write what is known now of the reducer and of its inputs."""
        return status_of(self.present, self.joint), input_status_of(self.present, self.joint)

    def take_transitions(self) -> list[tuple[Status, Status]]:
        """Return the statuses that named another part, level or code than those before, oldest first, once."""
        transitions, self._transitions = self._transitions, []
        return transitions

    def zoom(self) -> ZoomSpectrum | None:
        """Zoom spectrum of the present assessment, where there is one to show."""
        try:
            return self.present.zoom
        except HdMonitorError:  # the stretch holds no number, say: no picture, but no reason to restart
            return None
        except Exception as error:
            self._fail(error)
            return None

    @property
    def baseline_curve(self) -> tuple[SpeedBin, ...]:
        """RMS by speed in the baseline; empty without one."""
        return self._monitor.baseline.rms_curve if self._monitor.baseline else ()

    def change(self, settings: JointSettings) -> None:
        """Put other settings in force that leave the evidence valid."""
        self.settings = settings
        self._monitor.change(settings)
        self._inputs.change(settings)
        self._presence.change(settings)
        self.present = replace(self.present, settings=settings)  # its status says the limits

    def await_anew(self, quantity: Quantity, now: int) -> None:
        """Expect an input from `now` [ns] on as if nothing of it had come: it is on another topic."""
        self._presence.await_anew(quantity, now or None)

    def reset_latch(self) -> None:
        """Release a latched verdict."""
        self._monitor.reset_latch()

    def reset(self) -> None:
        """Forget all evidence: the reducer was exchanged."""
        self._monitor.reset()
        self._show(replace(self._monitor.silence(self.present.stamp), input=self._input))
        self.mark(Kind.EXCHANGE)

    def set_baseline(self) -> None:
        """Declare the reducer to be as it should be from here on."""
        if self._memory is None:
            raise ParameterError("history.path is empty, so that no baseline can be kept; set it to a file")
        self.mark(Kind.BASELINE)
        self._monitor.restart_rms_curve()

    def mark(self, kind: Kind) -> None:
        """Note an exchange or a baseline in the ledger, if there is one."""
        if self._memory is not None:
            self._memory.mark(kind, max(self._monitor.newest_stamps.values(), default=0) / NANOSECONDS)

    def close(self) -> None:
        """Write what the ledger does not have yet."""
        if self._memory is not None:
            self._memory.close()

    # ----------------------------------------------------------------------------------------------------------------

    def _describe(self, now: int) -> InputState:
        """Say which inputs are missing by the node's time [ns], and why by the ROS graph."""
        if not now:
            patient = self._looks_without_clock < self.settings.input.startup_warning
            return no_simulated_time(Level.OK if patient else Level.WARN)
        if not (missing := self._presence.missing(now)):
            return ARRIVING
        fault = self._monitor.silence(0).quality.last_fault
        return describe_inputs(missing, fault, explain=self._explain, stamps=self._monitor.newest_stamps)

    def _explained(self, assessment: Assessment, now: int) -> Assessment:
        """Add to a missing input what the monitor, which sees stamps only, cannot know."""
        if assessment.input.code in (InputCode.OK, InputCode.INVALID):
            return assessment
        if (state := self._describe(now)).code is not InputCode.OK:
            return replace(assessment, input=state)
        stamps, longest = self._monitor.newest_stamps, self.settings.input.timeout * NANOSECONDS
        if len(stamps) > 1 and max(stamps.values()) - min(stamps.values()) >= longest:
            return replace(assessment, input=stamped_by_two_clocks(stamps))
        return assessment

    def _quiet(self, now: int, state: InputState) -> Assessment:
        """Make the assessment of a time in which the monitor heard nothing new, with all that it knows."""
        stamp = round(self._date() * NANOSECONDS) if self._ahead is None else now + self._ahead
        return replace(self._monitor.silence(stamp), input=state)

    def _show(self, assessment: Assessment) -> None:
        self._input = assessment.input
        if self.errors:
            assessment = replace(assessment, extra=(*assessment.extra, ("internal errors", str(self.errors))))
        if crowd := self._explain_crowd():
            state = assessment.input
            assessment = replace(assessment, input=replace(state, reason=f"{state.reason}; {crowd}"))
        self.present = assessment
        if (key := self._key()) != self._told:
            self._told = key
            self._transitions.append(self.statuses())

    def _key(self) -> tuple[object, ...]:
        verdict, state = self.present.verdict, self.present.input
        return verdict.level, verdict.component, verdict.fault_code, state.level, state.code

    def _fail(self, error: Exception) -> None:
        """Restart this joint after an error of the core, and say so: the other joints must not suffer."""
        self.errors += 1
        self.last_error = traceback.format_exc()
        self._start()
        nothing = self._monitor.silence(self.present.stamp)
        self._show(replace(nothing, verdict=internal_error(error), input=self._input))

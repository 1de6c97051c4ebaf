"""One joint as the node sees it: its monitor, what it was last told, and what became of that. Knows no rclpy."""

import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..adapters import Inputs
from ..arrays import FloatArray, IntArray
from ..assessment import Assessment
from ..contract import NANOSECONDS, Block
from ..diagnosis.status import Status, status_of
from ..diagnosis.verdict import Component, FaultCode, Level, Verdict
from ..errors import HdMonitorError
from ..monitor import Monitor
from ..orders.zoom import ZoomSpectrum
from ..settings import JointSettings
from ..sources import Quantity

Explain = Callable[[Quantity], str]
"""Says of an input why nothing comes, as far as the ROS graph tells."""


@dataclass(slots=True)
class _Heard:
    """When an input was last heard [ns, the node's clock], and its newest stamp [ns]."""

    arrived: int
    useful: int
    stamp: int | None = None


class _Witness:
    """Stands before a monitor and notes the newest stamp of each input that passes."""

    def __init__(self, monitor: Monitor) -> None:
        self._monitor = monitor
        self.stamps: dict[Quantity, int] = {}

    def add_vibration(self, stamps: IntArray, values: FloatArray) -> None:
        """Pass on and note."""
        self.stamps[Quantity.VIBRATION] = int(stamps[-1])
        self._monitor.add_vibration(stamps, values)

    def add_block(self, block: Block) -> None:
        """Pass on and note."""
        self.stamps[Quantity.VIBRATION] = block.stamp
        self._monitor.add_block(block)

    def add_motion(self, stamps: IntArray, position: FloatArray, velocity: FloatArray, effort: FloatArray) -> None:
        """Pass on and note those that say where the joint is."""
        known = np.flatnonzero(np.isfinite(position))
        if known.size:
            self.stamps[Quantity.MOTION] = int(stamps[known[-1]])
        self._monitor.add_motion(stamps, position, velocity, effort)

    def reject(self, reason: str) -> None:
        """Pass on."""
        self._monitor.reject(reason)


class JointWatch:
    """Feeds one joint's monitor and keeps what its status says; an error of the core ends here.

    Parameters
    ----------
    joint : str
    settings : JointSettings
    now : int
        The node's time [ns]; silence counts from here.

    Attributes
    ----------
    present : Assessment
        What the status says now; from the start that it waits.
    errors : int
        Errors of the core so far.
    last_error : str
        Traceback of the newest one; empty if there is none.
    """

    def __init__(self, joint: str, settings: JointSettings, now: int) -> None:
        self.joint = joint
        self.settings = settings
        self.errors = 0
        self.last_error = ""
        self._timeout = round(settings.input.timeout * NANOSECONDS)
        self._assessed = False
        self._start()
        self.wake(now)
        self.present = self._other(
            now, Level.WARN, FaultCode.UNDETERMINED, "Waiting for the first data: no verdict is possible yet"
        )
        self._told = self._key()
        self._transitions: list[Status] = []

    def _start(self) -> None:
        self._monitor = Monitor(self.joint, self.settings)
        self._witness = _Witness(self._monitor)
        self._inputs = Inputs(self.joint, self.settings, self._witness)

    def wake(self, now: int) -> None:
        """Count silence from `now` [ns] on: the node has only just begun to listen."""
        self._heard = {name: _Heard(now, now, self._witness.stamps.get(name)) for name in self.settings.sources}

    # What the node calls --------------------------------------------------------------------------------------------

    def feed(self, messages: Mapping[Quantity, Sequence[bytes]], now: int, explain: Explain) -> bool:
        """Hand over serialised messages as they came; return True if that led to a new assessment.

        Parameters
        ----------
        messages : mapping of Quantity to sequence of bytes
        now : int
            The node's time [ns].
        explain : callable
            Asked where an input is lost.
        """
        try:
            for quantity, new in messages.items():
                if new:
                    self._inputs.add(quantity, new)
                    self._note(quantity, now)
            assessments = self._monitor.advance()
            for assessment in assessments:
                self._show(self._explained(assessment, now, explain))
        except Exception as error:
            self._fail(error, now)
            return False
        self._assessed = self._assessed or bool(assessments)
        return bool(assessments)

    def check(self, now: int, explain: Explain) -> None:
        """Look for inputs that are silent or useless; to be called once a second.

        A time `now` of 0 says that a simulated clock is asked for but has not begun.
        """
        if self._assessed:
            self._assessed = False
            return
        try:
            if not now:
                reason = "use_sim_time is set, but no simulated time has come yet: does anything publish /clock?"
                self._show(self._other(now, Level.WARN, FaultCode.UNDETERMINED, reason))
                return
            useless = self._useless(now)
            if not useless:
                return
            reasons = [self._complain(name, now, explain) for name in useless]
            self._show(self._other(now, Level.ERROR, self._code(useless, now), _sentence("; ".join(reasons))))
        except Exception as error:
            self._fail(error, now)

    def status(self) -> Status:
        """Write what is known now."""
        return status_of(self.present, self.joint, self.settings)

    def take_transitions(self) -> list[Status]:
        """Return the statuses that named another part, level or code than the one before, oldest first, once."""
        transitions, self._transitions = self._transitions, []
        return transitions

    def zoom(self) -> ZoomSpectrum | None:
        """Zoom spectrum of the present assessment, where there is one to show."""
        try:
            return self.present.zoom
        except HdMonitorError:  # the stretch holds no number, say: no picture, but no reason to start afresh
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
        """Forget all evidence."""
        self._monitor.reset()

    # ----------------------------------------------------------------------------------------------------------------

    def _note(self, name: Quantity, now: int) -> None:
        heard = self._heard[name]
        heard.arrived = now
        stamp = self._witness.stamps.get(name)
        if stamp != heard.stamp:
            heard.stamp, heard.useful = stamp, now

    def _useless(self, now: int) -> list[Quantity]:
        for heard in self._heard.values():
            if heard.arrived > now or not heard.arrived:  # the clock was set back, or has only just begun
                heard.arrived = heard.useful = now
        return [name for name, heard in self._heard.items() if now - heard.useful >= self._timeout]

    def _complain(self, name: Quantity, now: int, explain: Explain) -> str:
        heard = self._heard[name]
        if now - heard.arrived >= self._timeout:
            return f"no {_WORDS[name]} for {(now - heard.arrived) / NANOSECONDS:.0f} s: {explain(name)}"
        fault = self._monitor.silence(now).quality.last_fault
        if heard.stamp is not None and not fault:
            fault = f"their stamps stand still at {heard.stamp / NANOSECONDS:.3f} s"
        return f"messages with the {_WORDS[name]} come but cannot be used: {fault}"

    def _explained(self, assessment: Assessment, now: int, explain: Explain) -> Assessment:
        """Add to a lost input what the monitor, which sees stamps only, cannot know."""
        if assessment.verdict.fault_code is not FaultCode.INPUT_LOST:
            return assessment
        useless = self._useless(now)
        reasons = [self._complain(name, now, explain) for name in useless]
        code = self._code(useless, now) if useless else FaultCode.INPUT_LOST
        stamps = [heard.stamp for heard in self._heard.values()]
        if not reasons and len(stamps) == 2 and stamps[0] is not None and stamps[1] is not None:
            apart = abs(stamps[0] - stamps[1])
            if apart >= self._timeout:
                reasons = [
                    f"vibration and joint states both come, but their stamps are {apart / NANOSECONDS:.1f} s apart: "
                    "stamp both from one clock"
                ]
        if not reasons:
            return assessment
        verdict = replace(assessment.verdict, fault_code=code, reason=_sentence("; ".join(reasons)))
        return replace(assessment, verdict=verdict)

    def _code(self, useless: list[Quantity], now: int) -> FaultCode:
        silent = any(now - self._heard[name].arrived >= self._timeout for name in useless)
        return FaultCode.INPUT_LOST if silent else FaultCode.INPUT_INVALID

    def _other(self, now: int, level: Level, code: FaultCode, reason: str) -> Assessment:
        """Make an assessment that the monitor knows nothing of, with all that it knows."""
        verdict = Verdict(component=Component.UNDETERMINED, level=level, fault_code=code, reason=reason)
        return replace(self._monitor.silence(now), verdict=verdict)

    def _show(self, assessment: Assessment) -> None:
        if self.errors:
            assessment = replace(assessment, extra=(*assessment.extra, ("internal errors", str(self.errors))))
        self.present = assessment
        if (key := self._key()) != self._told:
            self._told = key
            self._transitions.append(self.status())

    def _key(self) -> tuple[object, ...]:
        verdict = self.present.verdict
        return verdict.level, verdict.component, verdict.fault_code

    def _fail(self, error: Exception, now: int) -> None:
        """Start this joint afresh after an error of the core, and say so: the other joints must not suffer."""
        self.errors += 1
        self.last_error = traceback.format_exc()
        self._start()
        self._show(
            self._other(
                now,
                Level.ERROR,
                FaultCode.INTERNAL_ERROR,
                f"Internal error, please report it: {type(error).__name__}: {error}; this joint's evidence was "
                "dropped and its watch starts afresh",
            )
        )


_WORDS = {Quantity.VIBRATION: "vibration signal", Quantity.MOTION: "joint states"}


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]

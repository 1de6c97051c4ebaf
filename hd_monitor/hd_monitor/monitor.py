"""The monitor of one joint: fed stamped arrays, it yields assessments. The node, the replay and the tests run this."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .acquisition.intake import Intake
from .acquisition.presence import Presence
from .acquisition.recorder import AssembledPeriod, Recorder
from .acquisition.thermometer import Thermometer
from .acquisition.timeline import Period
from .assessment import Assessment
from .contract import Block
from .diagnosis.absence import WAITING, WITHOUT_INPUT, not_enough, with_assumed_torque
from .diagnosis.inputs import InputState, describe_inputs, describe_silence
from .diagnosis.judge import Judge
from .diagnosis.verdict import FaultCode, Verdict
from .evidence import Evidence
from .history.rating import Baseline, growth_of, rated
from .identification.identifier import Identifier
from .identification.sensorless.identifier import SensorlessIdentifier
from .orders.rms_curve import rms_growth
from .settings import JointSettings
from .sources import Quantity


class Recalled(NamedTuple):
    """What was said of a reducer before."""

    verdict: Verdict
    evidence_end: int | None
    """Stamp of the newest motion behind it [ns]; None where there was none."""


class Monitor:
    """Watches one reducer.

    Parameters
    ----------
    settings : JointSettings
    identifier : Identifier or SensorlessIdentifier, optional
        An identifier to continue with, for example from an earlier recording of the same joint.
    recalled : Recalled, optional
        What was last said of this reducer, which stands as long as there is no new verdict.

    Attributes
    ----------
    baseline : mapping or None
        The lines of this reducer as they should be, where that is known.
    latest : Assessment or None
        The newest assessment, if any.

    Notes
    -----
    Every whole ``analysis.period`` of the message stamps is assessed once, as soon as all inputs are complete up to
    its end. The result depends on the messages alone: neither on how they are grouped into calls, nor on how those of
    different topics interleave, nor on any clock.

    Examples
    --------
    >>> import numpy as np
    >>> monitor = Monitor(JointSettings.from_mapping())
    >>> t = np.arange(0, 3_000_000_000, 10_000_000)
    >>> monitor.add(Quantity.MOTION, t, 0.1e-9 * t, np.full(t.size, 0.1), np.full(t.size, 10.0))
    >>> monitor.advance()
    []
    """

    def __init__(
        self,
        settings: JointSettings,
        identifier: Identifier | SensorlessIdentifier | None = None,
        recalled: Recalled | None = None,
    ) -> None:
        self.settings = settings
        self._recorder = Recorder(settings)
        self._intake = Intake(settings, self._recorder.count)
        self._presence = Presence(settings)
        self._thermometer = Thermometer()
        self._evidence = Evidence(settings, identifier)
        self._judge = Judge(settings)
        self._recalled = recalled is not None
        self._verdict, self._evidence_end = recalled or Recalled(WAITING, None)
        self.baseline: Baseline | None = None
        self.latest: Assessment | None = None

    # Feeding -------------------------------------------------------------------------------------------------------

    def add(self, quantity: Quantity, stamps: npt.ArrayLike, *columns: npt.ArrayLike) -> None:
        """Add single samples in the order they came, stamps and columns of shape (N,).

        Parameters
        ----------
        quantity : Quantity
        stamps : array_like of int
            [ns].
        *columns : array_like
            Of a vibration θ'' [rad/s²]; of a motion the output-side position [rad], velocity [rad/s] and effort
            [N·m], NaN where a message lacks one; of a torque the one transmitted [N·m]; of a temperature [°C].
        """
        if quantity is Quantity.TEMPERATURE:
            self._thermometer.add(np.asarray(stamps, dtype=np.int64), np.asarray(columns[0], dtype=np.float64))
            return
        rows = np.column_stack([np.asarray(column, dtype=np.float64) for column in columns])
        self._intake.add(quantity, np.asarray(stamps, dtype=np.int64), rows)

    def add_block(self, block: Block) -> None:
        """Add a block of samples of θ''; one with number and stamp of the last one is a duplicate and is dropped."""
        self._intake.add_block(block)

    def reject(self, reason: str) -> None:
        """Note a message that could not be used, with the reason; it shows in every status."""
        self._recorder.count(rejected=1, last_fault=reason)

    @property
    def newest_stamps(self) -> Mapping[Quantity, int]:
        """Stamp [ns] of what came last of each input."""
        return self._intake.newest

    # Results -------------------------------------------------------------------------------------------------------

    def advance(self) -> list[Assessment]:
        """Assess every period that has become complete; oldest first."""
        return [self._assess(period) for period in self._intake.complete()]

    def finish(self) -> Assessment | None:
        """Return the final assessment, None if there is nothing to assess: what a node would show, but for two things.

        The evidence will not change any more, so no further verdict is needed to confirm the last one; and where
        nothing could be identified, what is left is used although its period, or segment of motion, is not complete.
        """
        self.advance()
        if self._evidence.identification is None:
            for period in self._intake.rest():
                newest = [int(samples.stamps.max()) for samples in period.samples.values() if samples.stamps.size]
                if self.latest is None or len(newest) == len(period.samples):  # one input alone adds nothing
                    self._assess(period, now=max(newest, default=period.start))  # what follows the data is no silence
            self._evidence.finish()
        if self.latest is None:
            return None
        verdict = self.latest.verdict
        if (found := self._evidence.identification) is not None:
            verdict = rated(self._judge.conclude(found), found, self.baseline, self.settings.diagnosis)
            verdict = self._with_torque(verdict)
        state = self.latest.input
        if not state.failed and self.newest_stamps:  # an input may have ended after the last period that is complete
            for quantity, stamp in self.newest_stamps.items():
                self._presence.note(quantity, stamp, stamp)
            state = describe_inputs(self._presence.missing(max(self.newest_stamps.values())), self._recorder.last_fault)
        self.latest = replace(self.latest, identification=found, verdict=verdict, input=state)
        return self.latest

    def silence(self, now: int) -> Assessment:
        """Say that nothing came until `now` [ns], by the messages' clock; verdict and evidence are kept."""
        return self._pack(now, self._verdict, describe_silence(self._presence.absent), None)

    def change(self, settings: JointSettings) -> None:
        """Put other settings in force that leave the evidence valid: see :func:`hd_monitor.settings.check_change`."""
        self.settings = settings
        self._presence.change(settings)
        self._intake.change(settings)
        self._recorder.change(settings)
        self._evidence.change(settings)
        self._judge.change_limits(settings.diagnosis)

    def reset_latch(self) -> None:
        """Release a latched verdict."""
        self._judge.reset_latch()

    def restart_rms_curve(self) -> None:
        """Begin the RMS curve anew, so that it shows what comes after a baseline."""
        self._evidence.restart_rms_curve()

    def reset(self) -> None:
        """Forget all evidence, for example after the reducer was replaced; the input counters are kept."""
        self._judge = Judge(self.settings)
        self._recorder.cut()
        self._evidence = Evidence(self.settings)
        self._verdict, self._evidence_end, self._recalled = WAITING, None, False
        self.baseline = None

    # One period ----------------------------------------------------------------------------------------------------

    def _assess(self, period: Period, now: int | None = None) -> Assessment:
        if period.cut:
            self._recorder.cut()
            self._presence.start(period.start)
        assembled = self._recorder.assemble(period)
        for quantity, samples in period.samples.items():
            if samples.stamps.size:
                newest = int(samples.stamps.max())
                self._presence.note(quantity, newest, newest if quantity in assembled.usable else None)
        grown = self._evidence.add(assembled)
        missing = self._presence.missing(period.end if now is None else now)
        state = describe_inputs(missing, self._recorder.last_fault)
        if state.failed:  # nothing new to judge: the last verdict stands
            verdict = self._verdict if self._verdict.fault_code is not FaultCode.WAITING else WITHOUT_INPUT
        else:
            found = self._evidence.identification
            otherwise = not_enough(
                assembled,
                self.settings,
                self._presence.absent,
                speed=self._evidence.speed(assembled),
                rate=self._recorder.rate,
                fault=self._recorder.last_fault,
            )
            verdict = self._judge.judge(found, otherwise)
            verdict = rated(verdict, found, self.baseline, self.settings.diagnosis)
            if found is not None:
                verdict = self._with_torque(verdict)
            if self._recalled and verdict.fault_code is FaultCode.WAITING:
                verdict = self._verdict
            else:
                self._recalled = False
        if grown and not self._recalled:
            self._evidence_end = period.end
        self._verdict = verdict
        self.latest = self._pack(period.end, verdict, state, assembled)
        return self.latest

    def _with_torque(self, verdict: Verdict) -> Verdict:
        if self._recorder.torque_source != "assumed":
            return verdict
        return with_assumed_torque(verdict, self.settings.load.torque)

    def _pack(self, stamp: int, verdict: Verdict, state: InputState, assembled: AssembledPeriod | None) -> Assessment:
        evidence, intake = self._evidence, self._intake
        curve, base = evidence.rms_curve, self.baseline.rms_curve if self.baseline else ()
        quality = self._recorder.quality(
            out_of_order=intake.out_of_order, clock_jumps=intake.clock_jumps, dropped=intake.dropped
        )
        return Assessment(
            stamp=stamp,
            settings=self.settings,
            verdict=verdict,
            input=state,
            evidence_end=self._evidence_end,
            recalled=self._recalled,
            identification=evidence.identification,
            steady_parts=evidence.steady_parts,
            rms_curve=curve,
            rms_growth=rms_growth(curve, base, self.settings.analysis.rms_bin_width),
            line_growth=growth_of(evidence.identification, self.baseline),
            quality=quality,
            speed=evidence.speed(assembled) if assembled is not None else math.nan,
            rms=evidence.level(assembled) if assembled is not None else math.nan,
            torque_source=self._recorder.torque_source,
            temperature=self._thermometer.at(stamp),
            records=assembled.records if assembled is not None else (),
            joint_samples=assembled.joint_samples if assembled is not None else None,
        )

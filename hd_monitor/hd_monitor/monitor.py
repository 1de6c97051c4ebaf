"""The monitor of one joint: fed stamped arrays, it yields assessments. The node, the replay and the tests run this."""

import math
from dataclasses import replace
from itertools import groupby

import numpy as np
import numpy.typing as npt

from .acquisition.recorder import AssembledPeriod, Recorder
from .acquisition.stream import StampedBuffer
from .arrays import FloatArray
from .assessment import Assessment
from .contract import NANOSECONDS, Block
from .diagnosis.absence import nothing_received, partly_lost, unusable
from .diagnosis.judge import Judge
from .diagnosis.verdict import Verdict
from .identification.identifier import Identifier
from .identification.result import Identification
from .identification.sensorless.identifier import SensorlessIdentifier
from .orders.rms_curve import RmsAccumulator
from .orders.steady import SteadySegment
from .settings import JointSettings
from .timeline import Timeline, Window

VIBRATION = "vibration signal"
MOTION = "joint states"
_SLOW_DEGREE = 5  # of the polynomial that takes gravity and rigid motion off a second of an IMU's signal


class Monitor:
    """Watches one reducer.

    Parameters
    ----------
    joint : str
        Name of the joint, for messages.
    settings : JointSettings
    identifier : Identifier or SensorlessIdentifier, optional
        One that goes on with what it knows, from an earlier recording of the same joint say.

    Notes
    -----
    Every whole ``analysis.period`` of the message stamps is assessed once, as soon as all inputs are complete up to
    its end. The result depends on the messages alone: neither on how they are grouped into calls, nor on how those of
    different topics interleave, nor on any clock.

    Examples
    --------
    >>> import numpy as np
    >>> monitor = Monitor("joint", JointSettings.from_mapping())
    >>> t = np.arange(0, 3_000_000_000, 10_000_000)
    >>> monitor.add_motion(t, 0.1e-9 * t, np.full(t.size, 0.1), np.full(t.size, 10.0))
    >>> monitor.advance()
    []
    """

    def __init__(
        self, joint: str, settings: JointSettings, identifier: Identifier | SensorlessIdentifier | None = None
    ) -> None:
        self.joint = joint
        self.settings = settings
        self._reducer = settings.reducer
        self._rpm = self._reducer.reduction * 60.0 / math.tau
        self._radius = settings.input.sensor_radius
        self._period = round(settings.analysis.period * NANOSECONDS)
        self._timeout = round(settings.input.timeout * NANOSECONDS)
        self._judge = Judge(settings)
        self._vibration = StampedBuffer(1)
        self._motion = StampedBuffer(3)
        needed = (self._motion,) if settings.sensorless else (self._vibration, self._motion)
        self._timeline = Timeline(needed, self._period, self._timeout)
        self._recorder = Recorder(settings)
        self._block: Block | None = None
        self._blocks: list[Block] = []
        self._seen: dict[str, int] = {}
        self._useful = 0
        self._latest: Assessment | None = None
        self._begin_evidence(identifier)

    def _begin_evidence(self, identifier: Identifier | SensorlessIdentifier | None = None) -> None:
        settings = self.settings
        self._rms = RmsAccumulator(settings.analysis.rms_bin_width)
        self._steady = SteadySegment(self._reducer, settings.analysis.minimum_speed)
        self._identifier = identifier or (
            SensorlessIdentifier(settings) if settings.sensorless else Identifier(settings)
        )

    # Feeding -------------------------------------------------------------------------------------------------------

    def add_vibration(self, stamps: npt.ArrayLike, values: npt.ArrayLike) -> None:
        """Add single samples of θ'' [rad/s²] with their stamps [ns], both of shape (N,), in the order they came."""
        self._unpack_blocks()
        self._vibration.add(np.asarray(stamps, dtype=np.int64), np.asarray(values, dtype=np.float64).reshape(-1, 1))

    def add_block(self, block: Block) -> None:
        """Add a block of samples of θ''; one with number and stamp of the last one is a duplicate and is dropped."""
        last = self._block
        self._block = block
        if last is not None and (block.sequence, block.stamp) == (last.sequence, last.stamp):
            if np.array_equal(block.samples, last.samples, equal_nan=True):
                self._recorder.count(duplicates=len(block.samples), last_fault=f"block {block.sequence} came twice")
            else:
                self.reject(f"two different blocks have the number {block.sequence}: are there two publishers?")
            return
        self._blocks.append(block)

    def _unpack_blocks(self) -> None:
        """Hand over the samples of the blocks that have gathered; many at once cost little more than one."""
        blocks, self._blocks = self._blocks, []
        for (period, size), alike in groupby(blocks, key=lambda block: (block.period, block.samples.size)):
            group = list(alike)
            offsets = np.rint(np.arange(size) * (period * NANOSECONDS)).astype(np.int64)
            starts = np.array([block.stamp for block in group], dtype=np.int64)
            samples = np.concatenate([block.samples for block in group])
            self._vibration.add((starts[:, None] + offsets).ravel(), samples.reshape(-1, 1))

    def add_motion(
        self, stamps: npt.ArrayLike, position: npt.ArrayLike, velocity: npt.ArrayLike, effort: npt.ArrayLike
    ) -> None:
        """Add joint states, all of shape (N,), in the order they came.

        Stamps [ns], output-side position [rad], velocity [rad/s] and effort [N·m]; NaN where a message lacks one.
        """
        rows = np.column_stack([np.asarray(column, dtype=np.float64) for column in (position, velocity, effort)])
        self._motion.add(np.asarray(stamps, dtype=np.int64), rows)

    def reject(self, reason: str) -> None:
        """Note a message that could not be used, with the reason; it shows in every status."""
        self._recorder.count(rejected=1, last_fault=reason)

    # Results -------------------------------------------------------------------------------------------------------

    @property
    def latest(self) -> Assessment | None:
        """The newest assessment, if any."""
        return self._latest

    def advance(self) -> list[Assessment]:
        """Assess every period that has become complete; oldest first."""
        self._unpack_blocks()
        done = []
        while (window := self._timeline.next()) is not None:
            done.append(self._assess(window))
        return done

    def finish(self) -> Assessment | None:
        """Return what a node would show at the end of the data; a bag shorter than a period is assessed as it is."""
        self.advance()
        if self._latest is None:
            while (window := self._timeline.rest()) is not None:
                self._assess(window)
        return self._latest

    def silence(self, now: int) -> Assessment:
        """Say that nothing came for ``input.timeout`` until `now` [ns] by the caller's clock; the evidence is kept."""
        missing = [name for name in self._needed_names() if name not in self._seen]
        return self._pack(now, nothing_received(missing, self._timeout / NANOSECONDS), None)

    def change_limits(self, settings: JointSettings) -> None:
        """Put the ``diagnosis.*`` parameters of other settings in force, without losing any evidence."""
        self.settings = settings
        self._judge.change_limits(settings.diagnosis)

    def reset_latch(self) -> None:
        """Release a latched verdict."""
        self._judge.reset_latch()

    def reset(self) -> None:
        """Forget all evidence, after the reducer was exchanged say; counters of the input stay."""
        self._judge = Judge(self.settings)
        self._recorder.cut()
        self._begin_evidence()

    # One period ----------------------------------------------------------------------------------------------------

    def _needed_names(self) -> tuple[str, ...]:
        return (MOTION,) if self.settings.sensorless else (VIBRATION, MOTION)

    def _assess(self, window: Window) -> Assessment:
        epoch, end = self._timeline.epoch, window.end
        if window.cut:
            self._recorder.cut()
            self._seen = dict.fromkeys(self._seen, window.start)
            self._useful = window.start
        vibration, motion = self._vibration.take(end), self._motion.take(end)
        for name, samples in ((VIBRATION, vibration), (MOTION, motion)):
            if samples.stamps.size:
                self._seen[name] = int(samples.stamps.max())
        assembled = self._recorder.assemble(vibration, motion, self._motion.peek_first(), epoch, end)
        if self.settings.sensorless or np.isfinite(assembled.vibration).any():
            self._useful = end
        evidence = self._gather(assembled)
        lost = [name for name in self._needed_names() if self._is_lost(name, end)]
        if lost:
            verdict = partly_lost(lost, self._timeout / NANOSECONDS)
        elif end - self._useful >= self._timeout:
            verdict = unusable(self._recorder.last_fault, self._timeout / NANOSECONDS)
        else:
            verdict = self._judge.judge(evidence, "" if evidence is not None else self._missing(assembled))
            if evidence is not None and self._recorder.torque_source == "assumed":
                note = f"no effort was measured: the torque is taken to be {self.settings.load.torque:g} N·m"
                verdict = replace(verdict, reason=f"{verdict.reason}; {note}")
        self._latest = self._pack(end, verdict, assembled)
        return self._latest

    def _gather(self, assembled: AssembledPeriod) -> Identification | None:
        if isinstance(self._identifier, SensorlessIdentifier):
            if len(assembled.joint_samples):
                self._identifier.add(assembled.joint_samples)
            return self._identifier.estimate()
        for record in assembled.records:
            self._rms.add(record.speed * self._rpm, self._tangential(record.acceleration))
            self._steady.add(record)
            self._identifier.add(record)
        if not assembled.records:
            self._steady.interrupt()
        return self._identifier.estimate()

    def _is_lost(self, name: str, end: int) -> bool:
        return bool(end - self._seen.get(name, self._timeline.epoch) >= self._timeout)

    def _missing(self, assembled: AssembledPeriod) -> str:
        """Say why there is no evidence yet."""
        absent = [name for name in self._needed_names() if name not in self._seen]
        if absent:
            return f"No {' and no '.join(absent)} so far"
        if not self.settings.sensorless and not assembled.records:
            fault = self._recorder.last_fault
            return "No vibration with known motion in the last period" + (f": {fault}" if fault else "")
        if not self.settings.sensorless and not np.isfinite(assembled.vibration).any():
            return f"No usable vibration sample in the last period: {self._recorder.last_fault}"
        speed = self._speed(assembled)
        if not speed >= self.settings.analysis.minimum_speed:
            return "The joint has not turned enough yet: the lines show in motion only"
        rate = self._recorder.rate
        if not self.settings.sensorless and self._reducer.line_frequencies(speed).circular_spline > 0.5 * rate:
            return (
                f"At {speed:.0f} rpm all lines lie above half the sampling rate of {rate:.0f} Hz: check that positions "
                "are in rad on the output side, or sample faster"
            )
        return "Not enough motion seen yet: let the joint turn on"

    def _speed(self, assembled: AssembledPeriod) -> float:
        """Mean magnitude of the wave-generator speed [rpm]."""
        if assembled.records:
            total = sum(len(record) for record in assembled.records)
            return sum(float(np.abs(r.speed).sum()) for r in assembled.records) / total * self._rpm
        joint = assembled.joint_samples
        if len(joint) < 2:
            return math.nan
        travel = float(np.abs(np.diff(np.unwrap(joint.angle))).sum())
        return travel / float(joint.times[-1] - joint.times[0]) * self._rpm

    def _tangential(self, acceleration: FloatArray) -> FloatArray:
        """Vibration at the sensor's radius [m/s²]; gravity and the arm's own motion taken off an IMU's signal."""
        values = self._radius * acceleration
        known = np.isfinite(values)
        if not self.settings.vibration.gravity or int(known.sum()) < 2 * _SLOW_DEGREE:
            return values
        place = np.linspace(-1.0, 1.0, values.size)
        slow = np.polynomial.Legendre.fit(place[known], values[known], _SLOW_DEGREE, domain=[-1.0, 1.0])
        return np.asarray(values - slow(place))

    def _level(self, vibration: FloatArray) -> float:
        """RMS [m/s²] of the period's samples."""
        values = self._tangential(vibration)
        squares = values * values
        power = float(squares.sum())
        if math.isnan(power):
            squares = squares[np.isfinite(squares)]
            power = float(squares.sum())
        return math.sqrt(power / squares.size) if squares.size else math.nan

    def _pack(self, stamp: int, verdict: Verdict, assembled: AssembledPeriod | None) -> Assessment:
        limits = self.settings.diagnosis
        quality = self._recorder.quality(
            out_of_order=self._vibration.late + self._vibration.disordered,
            clock_jumps=self._vibration.jumps + self._motion.jumps,
        )
        return Assessment(
            stamp=stamp,
            verdict=verdict,
            identification=self._identifier.estimate(),
            steady_parts=self._steady.parts(),
            reducer=self._reducer,
            rms_curve=self._rms.curve(),
            quality=quality,
            speed=self._speed(assembled) if assembled is not None else math.nan,
            rms=self._level(assembled.vibration) if assembled is not None else math.nan,
            travel_needed=self._reducer.travel_to_separate(1),
            warn_limit=limits.warn_index,
            error_limit=limits.error_index,
            torque_source=self._recorder.torque_source,
            records=assembled.records if assembled is not None else (),
            joint_samples=assembled.joint_samples if assembled is not None else None,
        )

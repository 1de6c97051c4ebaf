"""Assembles vibration, motion and torque of one period into records on an even grid, and counts their faults."""

import itertools
import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray, runs_of
from ..settings import JointSettings
from ..sources import Quantity
from .bursts import interleaved
from .clock import Clock, recover_clock
from .motion import LARGEST, MotionTrack, TorqueTrack, Track, even_stamps
from .quality import Quality
from .record import JointSamples, Record
from .screening import Screened, screen
from .stream import Samples
from .timeline import Period

_NS = 1e-9
_REPLACED = ("rate", "last_fault")  # of the quality: not counters
_FAULTS = {
    "not_finite": "are not finite",
    "clipped": "are clipped",
    "stuck": "did not change although they should",
    "spikes": "are spikes",
}
_SHORTEST_RECORD = 8  # samples
_SPARSEST = 16  # places on the grid for each sample that came
_FASTEST, _COVERED = 2.0, 0.5  # a rate of more than twice that expected must cover half of a period
_STANDING = 1e-3  # rad of output travel in a period, below which a constant signal does not mean a stuck sensor


class AssembledPeriod(NamedTuple):
    """One period's messages combined.

    Attributes
    ----------
    records : tuple of Record
        Contiguous stretches of vibration with their motion, in time order.
    joint_samples : JointSamples
        The joint states of the period as they came.
    vibration : ndarray, shape (N,)
        All screened vibration samples of the period, those without known motion included; NaN where bad.
    usable : frozenset of Quantity
        Inputs with something usable.
    """

    records: tuple[Record, ...]
    joint_samples: JointSamples
    vibration: FloatArray
    usable: frozenset[Quantity]


@dataclass(slots=True)
class _Grid:
    """Where the sampling grid of the last period ended: time of the next sample due [s] and period [s]."""

    due: float
    period: float


class Recorder:
    """Turns the raw samples of successive periods into records.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._max_gap = settings.analysis.max_gap
        single = settings.input.source != "block"  # then the rate of the messages is that of the samples
        self._expected_period = 1.0 / settings.input.expected_rate if single else 0.0
        self._span = settings.analysis.period
        self._full_scale = settings.input.clipping_limit
        self.change(settings)
        self._has_sensor = Quantity.TORQUE in settings.sources
        self._counts: dict[str, Any] = {}
        self.torque_source = "unknown"
        self.cut()

    def change(self, settings: JointSettings) -> None:
        """Put another ``load.torque`` in force."""
        self._load = settings.load

    def cut(self) -> None:
        """Forget the motion and the grid: the next samples have another time base."""
        self._track = MotionTrack()
        self._torque_track = TorqueTrack()
        self._grid: _Grid | None = None
        self._joined = False
        self._reach = 0.0  # s by which samples may have been taken before they were stamped

    def count(self, **changes: int | float | str) -> None:
        """Add to counters of the quality; words and the rate replace the old value."""
        counts = self._counts
        for name, value in changes.items():
            counts[name] = value if name in _REPLACED else counts.get(name, 0) + value

    def quality(self, *, out_of_order: int, clock_jumps: int, dropped: int) -> Quality:
        """Return the counters so far, with those that the buffers keep."""
        counts = self._counts | {"dropped": self._counts.get("dropped", 0) + dropped}
        return Quality(**counts, out_of_order=out_of_order, clock_jumps=clock_jumps)

    @property
    def rate(self) -> float:
        """Sampling rate [Hz]; 0 before anything came."""
        return float(self._counts.get("rate", 0.0))

    @property
    def last_fault(self) -> str:
        """The newest complaint in words; empty if there is none."""
        return str(self._counts.get("last_fault", ""))

    def assemble(self, period: Period) -> AssembledPeriod:
        """Join the samples of one period."""
        joint_samples = self._motion(period)
        angle = joint_samples.angle
        turning = angle.size > 0 and float(angle.max() - angle.min()) > _STANDING
        torques = self._measured_torque(period)
        records, values = self._vibration(period.samples[Quantity.VIBRATION], period.epoch, turning)
        for track in (self._track, self._torque_track):
            track.forget((period.end - period.epoch) * _NS, self._reach)
        some = {
            Quantity.VIBRATION: np.isfinite(values).any(),
            Quantity.MOTION: len(joint_samples) > 0,
            Quantity.TORQUE: torques > 0,
        }
        return AssembledPeriod(
            records, joint_samples, values, frozenset(quantity for quantity, usable in some.items() if usable)
        )

    def _motion(self, period: Period) -> JointSamples:
        stamps, rows = _sorted(period.samples[Quantity.MOTION])
        times = _seconds(stamps, period.epoch)
        taken = self._extend(self._track, even_stamps(times, rows), rows, period, Quantity.MOTION)
        dropped = stamps.size - int(np.count_nonzero(taken))
        self.count(motion_messages=stamps.size - dropped, motion_faults=dropped)
        if dropped:
            self.count(
                last_fault="joint states without a finite position, with numbers beyond "
                f"{LARGEST:g} or with repeated stamps were left out"
            )
            times, rows = times[taken], rows[taken]
        return JointSamples(times=times, angle=rows[:, 0], speed=rows[:, 1], effort=rows[:, 2])

    def _measured_torque(self, period: Period) -> int:
        """Take in a torque sensor's samples, if there is one; return how many are usable."""
        if not self._has_sensor:
            return 0
        stamps, rows = _sorted(period.samples[Quantity.TORQUE])
        times = _seconds(stamps, period.epoch)
        taken = int(np.count_nonzero(self._extend(self._torque_track, times, rows, period, Quantity.TORQUE)))
        self.count(torque_messages=taken, torque_faults=stamps.size - taken)
        if taken < stamps.size:
            self.count(
                last_fault=f"torques that are not finite, beyond {LARGEST:g} N·m or with repeated stamps were left out"
            )
        return taken

    @staticmethod
    def _extend(track: Track, times: FloatArray, rows: FloatArray, period: Period, quantity: Quantity) -> BoolArray:
        """Append to a track, with the first sample after the period; return which ones of the period were taken."""
        following = period.following[quantity]
        lent = _seconds(following.stamps, period.epoch)
        return track.extend(np.concatenate([times, lent]), np.concatenate([rows, following.values]))[: times.size]

    def _vibration(self, samples: Samples, epoch: int, turning: bool) -> tuple[tuple[Record, ...], FloatArray]:
        if not samples.stamps.size:
            self._joined = False
            return (), np.empty(0)
        grid = self._grid
        clock = recover_clock(_seconds(samples.stamps, epoch), grid.period if grid else None)
        if clock is None:
            fault = "the stamps of the vibration samples do not advance"
            self.count(last_fault=fault, duplicates=samples.stamps.size - 1)
            return (), np.empty(0)
        if fault := self._misplaced(clock, samples.values[clock.order, 0]):
            self._grid, self._joined = None, False
            self.count(dropped=samples.stamps.size, last_fault=fault)
            return (), np.empty(0)
        self._reach = 2.0 * clock.burst * clock.period if clock.burst > 1 else 0.0
        if clock.burst > 1:
            spread = f"bursts of {clock.burst} vibration samples are spread evenly, at {1.0 / clock.period:.6g} Hz"
            self.count(last_fault=spread)
        screened = screen(samples.values[clock.order, 0], full_scale=self._full_scale, turning=turning)
        self._count_screened(screened)
        self.count(samples=clock.order.size, duplicates=clock.duplicates, rate=1.0 / clock.period)
        number, start = clock.number, clock.start
        missing = 0
        if grid is not None:
            missing = round((clock.start - grid.due) / clock.period)
            if abs(missing) < 0.5 * clock.burst:  # within what the read-outs show of the clock
                missing = 0
            if missing:
                self.count(gaps=1, lost=max(missing, 1))
            if missing * clock.period > self._max_gap or missing < 0:
                self._joined, missing = False, 0
        self._grid = _Grid(clock.start + clock.period * (int(number[-1]) + 1), clock.period)
        bounds = [0, number.size]
        if int(number[-1]) >= number.size:
            steps = np.diff(number)
            holes = np.flatnonzero(steps > 1)
            for hole in holes.tolist():
                self.count(gaps=1, lost=int(steps[hole]) - 1)
            cuts = holes[(steps[holes] - 1) * clock.period > self._max_gap] + 1
            bounds[1:1] = cuts.tolist()
        records: list[Record] = []
        for piece, (first, last) in enumerate(itertools.pairwise(bounds)):
            if piece:
                self._joined = False
            lead = missing if piece == 0 else 0
            offset = int(number[first]) - lead
            size = int(number[last - 1]) - offset + 1
            values = screened.values[first:last]
            if size > last - first:  # some are missing in between
                values = np.full(size, np.nan)
                values[number[first:last] - offset] = screened.values[first:last]
            records.extend(self._records(start + clock.period * offset, clock.period, values))
        return tuple(records), screened.values

    def _misplaced(self, clock: Clock, values: FloatArray) -> str:
        """Say why the stamps do not show when samples were taken; empty if they do."""
        publishers = clock.burst if clock.burst > 1 else round(self._expected_period / clock.period)
        if interleaved(values, clock.number, publishers):
            return f"vibration samples of {publishers} publishers alternate: stop all publishers but one"
        steps = clock.number[1:] - clock.number[:-1]
        places = int(steps[(steps - 1) * clock.period <= self._max_gap].sum())
        dense = _FASTEST * clock.period < self._expected_period and values.size * clock.period < _COVERED * self._span
        if dense or places > _SPARSEST * values.size:
            return (
                f"the stamps of the vibration samples are {1e6 * clock.period:.3g} µs apart, but not all the time: "
                "several publishers share the topic, samples are stamped as they are read out, or "
                "input.expected_rate is too low"
            )
        return ""

    def _records(self, start: float, period: float, values: FloatArray) -> list[Record]:
        """Cut a contiguous stretch where the motion is unknown."""
        times = np.asarray(start + period * np.arange(values.size), dtype=np.float64)
        angle, speed, torque = self._track.at(times)
        known = np.isfinite(angle)
        if self._has_sensor:  # in a hole of its signal there is no torque that could be mixed with a measured one
            torque = self._torque_track.at(times)
            known &= np.isfinite(torque)
        if not known.any():  # where no motion is known, nothing is said of where its torque comes from
            self._joined = False
            return []
        spans = [(0, values.size)] if known.all() else runs_of(known)
        torque = self._torque(torque)
        records, joined = [], self._joined
        self._joined = False
        for first, last in spans:
            continues = joined and first == 0
            if last - first >= _SHORTEST_RECORD or continues:
                part = slice(first, last)
                records.append(
                    Record(
                        start=float(times[first]),
                        period=period,
                        acceleration=values[part],
                        angle=angle[part],
                        speed=speed[part],
                        torque=torque[part],
                        continues=continues,
                    )
                )
                self._joined = last == values.size
        return records

    def _torque(self, measured: FloatArray) -> FloatArray:
        """Pick the transmitted torque; drivers and sensors that measure none report zeros."""
        source = self._load.source
        if source not in ("parameter", "unknown") and bool((np.abs(measured) > 0.0).any()):  # false for NaN
            self.torque_source = "effort" if source == "auto" else source
            return measured
        if source in ("auto", "parameter") and self._load.torque != 0.0:
            self.torque_source = "parameter" if source == "parameter" else "assumed"
        else:
            self.torque_source = "unknown"
        return np.full(measured.size, math.nan)

    def _count_screened(self, screened: Screened) -> None:
        counts = {name: getattr(screened, name) for name in _FAULTS}
        worst = max(counts, key=counts.__getitem__)
        if counts[worst]:
            fault = f"vibration samples of the last period {_FAULTS[worst]} and were left out"
            self.count(**counts, last_fault=fault)


def _sorted(samples: Samples) -> Samples:
    """Bring samples into the order of their stamps."""
    stamps, values = samples
    if stamps.size < 2 or bool((stamps[1:] > stamps[:-1]).all()):
        return samples
    order = np.argsort(stamps, kind="stable")
    return Samples(stamps[order], values[order])


def _seconds(stamps: IntArray, epoch: int) -> FloatArray:
    """Stamps [ns] as times [s] relative to the epoch [ns]."""
    return np.asarray((stamps - epoch) * _NS, dtype=np.float64)

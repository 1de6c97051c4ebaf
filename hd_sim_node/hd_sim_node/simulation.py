"""The whole rig as a stream of messages, as arrays: motion, sensor, joint and transport, a stretch at a time."""

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import repeat
from operator import itemgetter

import numpy as np

from hd_monitor import contract
from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import Block

from .drive.chunk import RigChunk
from .drive.rig import Rig
from .drive.stability import check_stability
from .messages.transport import Dispatch, Transport, TransportSettings
from .sensing.accelerometer import Accelerometer
from .sensing.clock import Clock, nanoseconds
from .sensing.filter import AntiAliasing
from .sensing.imu import Imu, ImuReadings
from .sensing.joint import Joint, JointBatch
from .settings import RigSettings

_STRETCH = 0.25  # s of simulated time in one stretch, or one block if that is longer


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stretch:
    """The messages of a stretch of simulated time; all stamps count from the start, in nanoseconds.

    Attributes
    ----------
    motion : RigChunk
        What truly happened at the sampling instants.
    samples : ndarray, shape (samples,)
        What the accelerometer put out [rad/s²].
    stamps : ndarray of int64, shape (samples,)
        Their stamps [ns] as single samples.
    blocks : tuple of Block
        The same samples in blocks.
    imu : ImuReadings or None
        If they are published.
    joint : JointBatch
    dispatch : dict of str to Dispatch
        By topic, of those published: which message (row of `samples`, `blocks` or `joint`) goes out when.
    """

    motion: RigChunk
    samples: FloatArray
    stamps: IntArray
    blocks: tuple[Block, ...]
    imu: ImuReadings | None
    joint: JointBatch
    dispatch: dict[str, Dispatch]

    def schedule(self) -> Iterator[tuple[int, str, int]]:
        """Iterate over (due [ns], topic, row) of every message in the order of going out."""
        rows = (zip(due.tolist(), repeat(topic), row.tolist()) for topic, (due, row) in self.dispatch.items())
        return heapq.merge(*rows, key=itemgetter(0))


class Simulation:
    """A simulated rig.

    Raises
    ------
    ParameterError
        If ``unstable`` is ``refuse`` and vibration would grow without bound.

    Attributes
    ----------
    settings : RigSettings
        Settings in force.
    warning : str
        The warning of ``unstable: warn``, or empty.

    Examples
    --------
    >>> rig = Simulation(RigSettings.from_mapping({"programme": "fixed", "duration": 2.0}))
    >>> sum(len(stretch.samples) for stretch in rig)
    2000
    """

    def __init__(self, settings: RigSettings) -> None:
        self.warning = check_stability(settings.largest_model, settings.programme, settings.general.unstable)
        self.settings = settings
        general, rate, seed = settings.general, settings.sampling.rate, settings.general.seed
        self._filter = AntiAliasing(settings.filter, rate=rate)
        self._rig = Rig(
            settings.model,
            settings.programme,
            rate=rate * self._filter.oversampling,
            start_angle=settings.start_angle,
            surroundings=settings.surroundings,
            effects=settings.effects,
        )
        self._accelerometer = Accelerometer(settings.sensor, settings.fault, rate=rate, seed=seed)
        self._imu = Imu(settings.imu, settings.fault, seed=seed) if general.publish_imu else None
        self._clock = Clock(settings.clock, rate=rate, seed=seed)
        self._joint = Joint(self._rig, settings.joint, settings.effort, seed=seed)
        self._block_size = general.block_size
        self._sequence = 0
        published = {
            contract.TORSIONAL_ACCELERATION_BLOCK: general.publish in ("block", "both"),
            contract.TORSIONAL_ACCELERATION: general.publish in ("samples", "both"),
            contract.IMU: general.publish_imu,
        }
        self._transports = {t: Transport(settings.transport, seed=seed, topic=t) for t in published if published[t]}
        loss = TransportSettings(loss=settings.joint.loss)
        self._transports[contract.JOINT_STATES] = Transport(loss, seed=seed, topic=contract.JOINT_STATES)
        self._stretch = max(1, round(_STRETCH * rate / self._block_size))  # in blocks
        # Whole blocks, at least one; rounding must not cost the last one.
        total = settings.duration * rate / self._block_size
        self._left = max(1, int(total + 1e-9)) if math.isfinite(total) else math.inf

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics published."""
        return tuple(self._transports)

    def message_rate(self, topic: str) -> float:
        """Messages per simulated second on a topic."""
        if topic == contract.JOINT_STATES:
            return self.settings.joint.rate
        rate = self.settings.sampling.rate
        return rate / (self._block_size if topic == contract.TORSIONAL_ACCELERATION_BLOCK else 1)

    def change(self, settings: RigSettings) -> None:
        """Change defect, torque, surroundings, sensor or transport; the motion continues.

        Programme, rates, topics and seed stay as they were at the start.

        Raises
        ------
        ParameterError
            If vibration would grow without bound, as at the start; nothing is changed then.
        """
        self.warning = check_stability(settings.largest_model, settings.programme, settings.general.unstable)
        self.settings = settings
        self._rig.model = settings.model
        self._rig.surroundings = settings.surroundings
        self._rig.effects = settings.effects
        self._accelerometer.settings = settings.sensor
        self._accelerometer.fault.settings = settings.fault
        if self._imu is not None:
            self._imu.fault.settings = settings.fault
        self._clock.settings = settings.clock
        self._joint.settings, self._joint.effort.settings = settings.joint, settings.effort
        for topic, transport in self._transports.items():
            if topic != contract.JOINT_STATES:
                transport.settings = settings.transport

    def __iter__(self) -> Iterator[Stretch]:
        """Iterate over the stretches until the programme or `duration` ends."""
        return iter(self.advance, None)

    def advance(self) -> Stretch | None:
        """Simulate the next stretch; None at the end."""
        if not self._left:
            return None
        blocks = int(min(self._stretch, self._left))
        self._left -= blocks
        size = self._block_size
        first, self._sequence = self._sequence, self._sequence + blocks
        fine = self._rig.advance(blocks * size * self._filter.oversampling)
        motion, felt, joint = fine.thinned(self._filter.oversampling), self._filter.thin(fine), self._joint.report(fine)
        samples, stamps = self._accelerometer.measure(felt), self._clock.stamp(motion)
        imu = None
        if self._imu is not None:
            settings = self.settings
            imu = self._imu.measure(felt, samples, surroundings=settings.surroundings, gain=settings.sensor.gain)
        instants = nanoseconds(motion.times)
        read = np.minimum(stamps.due, instants[-1])  # a stretch sends its own messages, those of a FIFO half full too
        due = {
            contract.TORSIONAL_ACCELERATION_BLOCK: instants[size - 1 :: size],
            contract.TORSIONAL_ACCELERATION: read,
            contract.IMU: read,
            contract.JOINT_STATES: nanoseconds(joint.times),
        }
        return Stretch(
            motion=motion,
            samples=samples,
            stamps=stamps.read,
            blocks=tuple(
                Block(stamp, self._clock.period, first + number, row)
                for number, (stamp, row) in enumerate(
                    zip(stamps.sampled[::size].tolist(), samples.reshape(-1, size), strict=True)
                )
            ),
            imu=imu,
            joint=joint,
            dispatch={topic: transport.dispatch(due[topic]) for topic, transport in self._transports.items()},
        )

"""The whole rig as a stream of messages, as arrays: motion, sensor, joint and transport, a stretch at a time."""

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import repeat
from operator import itemgetter

from hd_monitor import contract
from hd_monitor.arrays import FloatArray, IntArray
from hd_monitor.contract import Block

from .drive.chunk import RigChunk
from .drive.rig import Rig
from .drive.stability import check_stability
from .messages.transport import Dispatch, Transport, TransportSettings
from .sensing.accelerometer import Accelerometer, nanoseconds
from .sensing.joint import Joint, JointBatch
from .settings import RigSettings

_STRETCH = 0.25  # s of simulated time in one stretch, or one block if that is longer


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stretch:
    """The messages of a stretch of simulated time; all stamps count from the start, in nanoseconds.

    Attributes
    ----------
    motion : RigChunk
        What truly happened.
    samples : ndarray, shape (samples,)
        What the accelerometer put out [rad/s²].
    stamps : ndarray of int64, shape (samples,)
        Its stamps [ns].
    blocks : tuple of Block
        The same samples in blocks.
    joint : JointBatch
    dispatch : dict of str to Dispatch
        By topic, of those published: which message (row of `samples`, `blocks` or `joint`) goes out when.
    """

    motion: RigChunk
    samples: FloatArray
    stamps: IntArray
    blocks: tuple[Block, ...]
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
        self.warning = check_stability(settings.model, settings.programme, settings.general.unstable)
        self.settings = settings
        general, rate, seed = settings.general, settings.mounting.rate, settings.general.seed
        self._rig = Rig(
            settings.model,
            settings.programme,
            rate=rate,
            start_angle=settings.start_angle,
            surroundings=settings.surroundings,
        )
        self._accelerometer = Accelerometer(settings.sensor, rate=rate, seed=seed)
        self._joint = Joint(self._rig, settings.joint, seed=seed)
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
        return self._rig.rate / (self._block_size if topic == contract.TORSIONAL_ACCELERATION_BLOCK else 1)

    def change(self, settings: RigSettings) -> None:
        """Change defect, torque, surroundings, sensor or transport; the motion continues.

        Programme, rates, topics and seed stay as they were at the start.

        Raises
        ------
        ParameterError
            If vibration would grow without bound, as at the start; nothing is changed then.
        """
        self.warning = check_stability(settings.model, settings.programme, settings.general.unstable)
        self.settings = settings
        self._rig.model = settings.model
        self._rig.surroundings = settings.surroundings
        self._accelerometer.settings = settings.sensor
        self._joint.settings = settings.joint
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
        motion = self._rig.advance(blocks * size)
        samples, stamps = self._accelerometer.measure(motion), self._accelerometer.stamps(motion)
        joint = self._joint.report(motion)
        instants = nanoseconds(motion.times)
        due = {
            contract.TORSIONAL_ACCELERATION_BLOCK: instants[size - 1 :: size],
            contract.TORSIONAL_ACCELERATION: instants,
            contract.IMU: instants,
            contract.JOINT_STATES: nanoseconds(joint.times),
        }
        return Stretch(
            motion=motion,
            samples=samples,
            stamps=stamps,
            blocks=tuple(
                Block(stamp, 1.0 / self._rig.rate, first + number, row)
                for number, (stamp, row) in enumerate(
                    zip(stamps[::size].tolist(), samples.reshape(-1, size), strict=True)
                )
            ),
            joint=joint,
            dispatch={topic: transport.dispatch(due[topic]) for topic, transport in self._transports.items()},
        )

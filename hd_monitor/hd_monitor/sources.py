"""The sources of input: what each tells, its topic, its message type and its decoder.

Parameters' choices, the node's subscriptions, the topics that replay looks for and the decoding follow these tables.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from . import cdr, contract
from .arrays import FloatArray, IntArray
from .errors import LayoutError

if TYPE_CHECKING:
    from .settings import JointSettings


class Quantity(StrEnum):
    """What an input tells of a joint."""

    VIBRATION = "vibration"
    MOTION = "motion"
    TORQUE = "torque"
    TEMPERATURE = "temperature"


class Stamped(NamedTuple):
    """Single samples of a quantity."""

    stamps: IntArray
    """Sampling instants [ns], shape (N,)."""
    values: FloatArray
    """θ'' [rad/s²] of a vibration, torque [N·m] or temperature [°C]; shape (N,)."""


Decoded = Stamped | contract.Block | str
"""Samples, a block of samples, or what is wrong with a message."""

Decoder = Callable[[Sequence[bytes], "JointSettings"], Iterable[Decoded]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """A topic that a joint listens to.

    Attributes
    ----------
    quantity : Quantity
    topic : str
        Its name, relative unless the parameters say otherwise.
    type : str
        ROS message type, as ``package/Type``.
    decode : callable or None
        Decodes serialised messages, in their order; None for joint states, where the joint has to be found first.
    needs : tuple of (str, str)
        Parameters that must not be 0, each with the reason.
    gravity : bool
        Whether the signal also holds gravity and the arm's own motion.
    """

    quantity: Quantity
    topic: str
    type: str
    decode: Decoder | None = None
    needs: tuple[tuple[str, str], ...] = ()
    gravity: bool = False

    def name_below(self, joint: str | None) -> str:
        """Name of the topic where several joints are watched, each with its own topics below its name."""
        shared = joint is None or self.quantity is Quantity.MOTION or self.topic.startswith("/")
        return self.topic if shared else f"{joint}/{self.topic}"


def _decode_blocks(messages: Sequence[bytes], settings: "JointSettings") -> list[Decoded]:
    """Return the blocks, and what is wrong with the others, in the order of the messages."""
    groups, faults = cdr.decode_multi_arrays(messages)
    items: list[tuple[int, contract.Block | LayoutError | str]] = list(faults)
    for group in groups:
        blocks: Sequence[contract.Block | LayoutError]
        try:
            blocks = contract.unpack_blocks(group.dimensions, group.data_offset, group.data)
        except LayoutError as error:
            blocks = [error] * len(group.place)
        items += zip(group.place.tolist(), blocks, strict=True)
    ordered = sorted(items, key=itemgetter(0))
    return [str(item) if isinstance(item, LayoutError) else item for _, item in ordered]


def _decode_vectors(
    decode: Callable[[Sequence[bytes]], cdr.Samples], value: Callable[[cdr.Samples, "JointSettings"], FloatArray]
) -> Decoder:
    """Make a decoder of single samples from that of the message type and what counts of its vectors."""

    def decoder(messages: Sequence[bytes], settings: "JointSettings") -> Iterator[Decoded]:
        samples = decode(messages)
        yield from samples.faults
        if samples.stamps.size:
            yield Stamped(samples.stamps, np.ascontiguousarray(value(samples, settings)))

    return decoder


def _decode_temperatures(messages: Sequence[bytes], _: "JointSettings") -> Iterator[Decoded]:
    stamps, values, faults = cdr.decode_temperatures(messages)
    yield from faults
    if stamps.size:
        yield Stamped(stamps, values)


def _along(axis: str, vectors: FloatArray) -> FloatArray:
    """Components of vectors, shape (N, 3), along an axis as the parameters name it, ``-z`` say; shape (N,)."""
    component = vectors[:, "xyz".index(axis[-1])]
    return -component if axis.startswith("-") else component


JOINT_STATES = Source(quantity=Quantity.MOTION, topic=contract.JOINT_STATES, type="sensor_msgs/JointState")
"""The motion that every mode refers to."""

INPUT_SOURCES: Mapping[str, Source] = {
    "block": Source(
        quantity=Quantity.VIBRATION,
        topic=contract.TORSIONAL_ACCELERATION_BLOCK,
        type="std_msgs/Float64MultiArray",
        decode=_decode_blocks,
    ),
    "accel_stamped": Source(
        quantity=Quantity.VIBRATION,
        topic=contract.TORSIONAL_ACCELERATION,
        type="geometry_msgs/AccelStamped",
        decode=_decode_vectors(cdr.decode_vectors, lambda samples, _: samples.angular[:, 2]),
    ),
    "imu": Source(
        quantity=Quantity.VIBRATION,
        topic=contract.IMU,
        type="sensor_msgs/Imu",
        decode=_decode_vectors(
            cdr.decode_imu,
            lambda samples, given: _along(given.input.axis, samples.linear) * (1.0 / given.input.sensor_radius),
        ),
        needs=(
            (
                "input.sensor_radius",
                "a tangential acceleration becomes an angular one by dividing by the radius; give the distance of the "
                "IMU from the joint's axis",
            ),
        ),
        gravity=True,
    ),
    "joint_effort": JOINT_STATES,
    "joint_velocity": JOINT_STATES,
}
"""The words of ``input.source``; where joint states carry the vibration signal too, no sensor is needed."""

LOAD_SOURCES: Mapping[str, Source | None] = {
    "auto": None,
    "effort": None,
    "wrench": Source(
        quantity=Quantity.TORQUE,
        topic=contract.WRENCH,
        type="geometry_msgs/WrenchStamped",
        decode=_decode_vectors(cdr.decode_vectors, lambda samples, given: _along(given.load.axis, samples.angular)),
    ),
    "parameter": None,
    "unknown": None,
}
"""The words of ``load.source``; None where the torque needs no topic besides joint states."""

TEMPERATURE = Source(
    quantity=Quantity.TEMPERATURE,
    topic=contract.TEMPERATURE,
    type="sensor_msgs/Temperature",
    decode=_decode_temperatures,
)
"""The reducer's temperature, which no verdict needs and the ledger keeps."""

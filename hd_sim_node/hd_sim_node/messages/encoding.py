"""The simulation's arrays as serialised messages: the same for the node and for a bag, a stretch at once."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from hd_monitor import contract
from hd_monitor.arrays import IntArray
from hd_monitor.contract import NANOSECONDS
from hd_monitor.sources import INPUT_SOURCES

from ..settings import RigSettings
from ..simulation import Stretch

MESSAGE_TYPES = {source.topic: source.type.replace("/", "/msg/") for source in INPUT_SOURCES.values()}
"""By topic."""

_PLAIN_CDR = b"\x00\x01\x00\x00"  # little-endian; alignment counts from behind it

Column = npt.NDArray[Any]
"""A field's values in a stretch's messages: a row a message, or one row for all."""


def encode(stretch: Stretch, settings: RigSettings, epoch: int) -> dict[str, list[bytes]]:
    """Serialise the messages of a stretch by topic, one a row; `epoch` [ns] is the stamp of the start."""
    columns = {
        contract.TORSIONAL_ACCELERATION_BLOCK: _blocks,
        contract.TORSIONAL_ACCELERATION: _samples,
        contract.IMU: _imu,
        contract.JOINT_STATES: _joint_states,
    }
    return {topic: _serialise(columns[topic](stretch, settings, epoch)) for topic in stretch.dispatch}


def _samples(stretch: Stretch, settings: RigSettings, epoch: int) -> list[Column]:
    vectors = np.zeros((len(stretch.samples), 6))  # linear, angular
    vectors[:, 1] = settings.imu.radius * stretch.samples
    vectors[:, 5] = stretch.samples
    return [*_header(stretch.stamps + epoch, settings.sampling.frame_id), vectors]


def _imu(stretch: Stretch, settings: RigSettings, epoch: int) -> list[Column]:
    if stretch.imu is None:
        raise ValueError("the stretch holds no readings of an IMU; simulate with publish_imu")
    (force, turning), unknown = stretch.imu, np.zeros((1, 9))
    orientation = np.array([[0.0, 0.0, 0.0, 1.0, -1.0, *[0.0] * 8]])  # REP-145: none known, gravity included
    return [*_header(stretch.stamps + epoch, settings.sampling.frame_id), orientation, turning, unknown, force, unknown]


def _joint_states(stretch: Stretch, settings: RigSettings, epoch: int) -> list[Column]:
    joint = stretch.joint
    columns = [*_header(joint.stamps + epoch, ""), _whole(1), *_text(settings.joint.name)]
    for values in (joint.position, joint.velocity, joint.effort):
        columns += [_whole(0)] if values is None else [_whole(1), values]
    return columns


def _blocks(stretch: Stretch, settings: RigSettings, epoch: int) -> list[Column]:
    packed = [contract.pack_block(block._replace(stamp=block.stamp + epoch)) for block in stretch.blocks]
    dimension, data = packed[0][0], np.stack([data for _, data in packed])
    layout = [_whole(1), *_text(dimension.label), _whole(dimension.size), _whole(dimension.stride)]
    return [*layout, _whole(contract.BLOCK_OFFSET), _whole(data.shape[1]), data]


def _header(stamps: IntArray, frame: str) -> list[Column]:
    seconds, nanoseconds = divmod(stamps, NANOSECONDS)
    return [seconds.astype("<i4"), nanoseconds.astype("<u4"), *_text(frame)]


def _text(text: str) -> list[Column]:
    data = text.encode() + b"\0"
    return [_whole(len(data)), np.array([data])]


def _whole(number: int) -> Column:
    return np.array([number], dtype="<u4")


def _serialise(columns: list[Column]) -> list[bytes]:
    """Write messages as plain CDR, each field aligned to the size of its numbers."""
    end, offsets = len(_PLAIN_CDR), []
    for column in columns:
        alignment = 1 if column.dtype.kind == "S" else column.itemsize
        start = end + (len(_PLAIN_CDR) - end) % alignment
        offsets.append(start)
        end = start + column.itemsize * math.prod(column.shape[1:])
    names = [f"field {number}" for number in range(len(columns))]
    formats = [(column.dtype.newbyteorder("<"), column.shape[1:]) for column in columns]
    record = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": end})
    (count,) = np.broadcast_shapes(*(column.shape[:1] for column in columns))
    messages = np.zeros(count, dtype=record)
    for name, column in zip(names, columns, strict=True):
        messages[name] = column
    data = messages.tobytes()
    return [_PLAIN_CDR + data[at + len(_PLAIN_CDR) : at + end] for at in range(0, len(data), end)]

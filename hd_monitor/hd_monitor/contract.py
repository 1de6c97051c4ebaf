"""The topics' names, and the layouts of their arrays as a publisher packs and a subscriber unpacks them.

Nothing here knows a message class: the ROS shell and the offline reader both pass labels, sizes and data.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .arrays import FloatArray
from .errors import LayoutError

TORSIONAL_ACCELERATION = "torsional_acceleration"
TORSIONAL_ACCELERATION_BLOCK = "torsional_acceleration/block"
IMU = "imu/data_raw"
JOINT_STATES = "joint_states"
WRENCH = "wrench"
TEMPERATURE = "temperature"
DIAGNOSTICS = "/diagnostics"
ZOOM_SPECTRUM = "zoom_spectrum"
READINGS = ("index", "transmission_error")
"""Topics below each spline's name (``flexspline/index``): per cent, and arcmin peak to peak."""
RMS_CURVE = "rms_curve"
RMS_BASELINE = "rms_curve/baseline"

BLOCK_LABEL = "torsional_acceleration"
BLOCK_OFFSET = 4
"""Values before the first sample: seconds, nanoseconds, sample period, sequence number."""

_TOO_MUCH = (2.0**33, 1e9, 2.0**63)  # seconds, nanoseconds and sequence number: values from here on are damaged data

ZOOM_BINS = 50
"""Viewers drop arrays of more than 100 values; a bin takes two."""

NANOSECONDS = 1_000_000_000


class Dimension(NamedTuple):
    """One entry of a MultiArrayLayout: its label, its size and its stride in values."""

    label: str
    size: int
    stride: int


class Block(NamedTuple):
    """A block of torsional acceleration samples."""

    stamp: int
    """Sampling instant of the first sample [ns]."""
    period: float
    """Sample period [s]."""
    sequence: int
    """Number of the block; a jump exposes loss."""
    samples: FloatArray
    """θ'' [rad/s²], shape (N,)."""


def pack_block(block: Block) -> tuple[Dimension, FloatArray]:
    """Lay out a block as the topic ``torsional_acceleration/block`` carries it: (dimension, data)."""
    count = len(block.samples)
    data = np.empty(BLOCK_OFFSET + count)
    data[0], data[1] = divmod(block.stamp, NANOSECONDS)
    data[2] = block.period
    data[3] = block.sequence
    data[BLOCK_OFFSET:] = block.samples
    return Dimension(BLOCK_LABEL, count, count), data


def unpack_blocks(
    dimensions: Sequence[tuple[str, int, int]], data_offset: int, data: FloatArray
) -> list[Block | LayoutError]:
    """Read ``torsional_acceleration/block`` arrays of the same layout.

    Parameters
    ----------
    dimensions : sequence of (label, size, stride)
        ``layout.dim`` of the messages.
    data_offset : int
        ``layout.data_offset`` of the messages.
    data : ndarray, shape (messages, values)
        ``data`` of each message.

    Returns
    -------
    list of Block or LayoutError
        One a message; in place of a bad one the reason.

    Raises
    ------
    LayoutError
        If the layout is not the contract's, saying what differs.
    """
    if len(dimensions) != 1:
        raise LayoutError(f"a block has {len(dimensions)} dimensions; the contract requires exactly 1")
    label, size, stride = dimensions[0]
    if label != BLOCK_LABEL:
        raise LayoutError(f"a block's dimension is labelled {label!r}; the contract requires {BLOCK_LABEL!r}")
    if data_offset != BLOCK_OFFSET:
        raise LayoutError(f"a block's data_offset is {data_offset}; the contract requires {BLOCK_OFFSET}")
    if stride != size or data.shape[1] != BLOCK_OFFSET + size:
        raise LayoutError(
            f"a block announces {size} samples with stride {stride} but carries {data.shape[1]} values; "
            f"the contract requires stride = size and {BLOCK_OFFSET} values before the samples"
        )
    heads, samples = data[:, :BLOCK_OFFSET], data[:, BLOCK_OFFSET:]
    counts = heads[:, [0, 1, 3]]
    starts = ((counts >= 0.0) & (counts == np.floor(counts)) & (counts < _TOO_MUCH)).all(axis=1)
    good = starts & (heads[:, 2] > 0.0) & (heads[:, 2] < 10.0)
    seconds, nanoseconds, sequences = np.where(good, counts.T, 0.0).astype(np.int64)
    stamps = seconds * NANOSECONDS + nanoseconds
    blocks: list[Block | LayoutError] = list(
        map(Block, stamps.tolist(), heads[:, 2].tolist(), sequences.tolist(), samples)
    )
    for place in np.flatnonzero(~good).tolist():
        blocks[place] = _fault(heads[place].tolist())
    return blocks


def _fault(head: list[float]) -> LayoutError:
    """Say what is wrong with the values before a block's samples."""
    seconds, nanoseconds, period, sequence = head
    if not 0.0 < period < 10.0:
        return LayoutError(f"a block's sample period is {period!r} s; the contract requires the time between samples")
    return LayoutError(
        f"a block starts at {seconds!r} s {nanoseconds!r} ns with number {sequence!r}; the contract requires "
        "whole, non-negative values"
    )


def zoom_layout() -> tuple[Dimension, Dimension]:
    """Dimensions of ``zoom_spectrum``: frequencies [Hz], then amplitudes, as plots by message path need them."""
    return Dimension("frequency_amplitude", 2, 2 * ZOOM_BINS), Dimension("bin", ZOOM_BINS, ZOOM_BINS)


def rms_layout(bins: int) -> tuple[Dimension, Dimension]:
    """Dimensions of ``rms_curve``: [speed bin, (rpm, rms, samples)]."""
    return Dimension("speed_bin", bins, 3 * bins), Dimension("rpm_rms_samples", 3, 3)

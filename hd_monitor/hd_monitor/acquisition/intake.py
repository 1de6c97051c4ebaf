"""A joint's inputs, buffered until a period of their stamps is complete on all of them."""

from collections.abc import Callable, Iterator
from itertools import groupby

import numpy as np

from ..arrays import FloatArray, IntArray
from ..contract import NANOSECONDS, Block
from ..settings import JointSettings
from ..sources import Quantity
from .stream import StampedBuffer
from .timeline import Period, Timeline

_COLUMNS = {Quantity.VIBRATION: 1, Quantity.MOTION: 3, Quantity.TORQUE: 1}
_OVERLAP = 0.51  # of the longer block's duration; of two publishers' blocks one lies nearer than that to the one before


class Intake:
    """Takes in samples and hands out whole periods.

    Parameters
    ----------
    settings : JointSettings
    count : callable
        Adds to the counters of :class:`.Quality`, by name.

    Attributes
    ----------
    newest : dict of Quantity to int
        Stamp [ns] of the sample that came last, of those that hold a number.
    """

    def __init__(self, settings: JointSettings, count: Callable[..., None]) -> None:
        self._count = count
        self._buffers = {quantity: StampedBuffer(columns) for quantity, columns in _COLUMNS.items()}
        self._timeline = Timeline(
            self._buffers,
            settings.sources,
            round(settings.analysis.period * NANOSECONDS),
            round(settings.input.timeout * NANOSECONDS),
        )
        self._last: Block | None = None
        self._blocks: list[Block] = []
        self.newest: dict[Quantity, int] = {}

    def change(self, settings: JointSettings) -> None:
        """Put another ``input.timeout`` in force."""
        self._timeline.timeout = round(settings.input.timeout * NANOSECONDS)

    def add(self, quantity: Quantity, stamps: IntArray, values: FloatArray) -> None:
        """Add samples with their stamps [ns], shape (N,), and values, shape (N, columns), in the order they came."""
        self._unpack_blocks()
        self._buffers[quantity].add(stamps, values)
        if quantity is not Quantity.VIBRATION:  # a vibration that is not finite belongs to a sensor that still samples
            stamps = stamps[np.isfinite(values[:, 0])]
        if stamps.size:
            self.newest[quantity] = int(stamps[-1])

    def add_block(self, block: Block) -> None:
        """Add a block of vibration; one that came before, or that overlaps another publisher's, is dropped."""
        last = self._last
        self.newest[Quantity.VIBRATION] = block.stamp
        if last is None or not _overlap(last, block):
            self._last = block
            self._blocks.append(block)
        elif (block.sequence, block.stamp) != (last.sequence, last.stamp):
            reason = f"block {block.sequence} covers the time of block {last.sequence}: are there two publishers?"
            self._count(rejected=1, last_fault=reason)
        elif np.array_equal(block.samples, last.samples, equal_nan=True):
            self._count(duplicates=len(block.samples), last_fault=f"block {block.sequence} came twice")
        else:
            reason = f"two different blocks have the number {block.sequence}: are there two publishers?"
            self._count(rejected=1, last_fault=reason)

    def _unpack_blocks(self) -> None:
        """Hand over the samples of the blocks that have gathered; many at once cost little more than one."""
        blocks, self._blocks = self._blocks, []
        for (period, size), alike in groupby(blocks, key=lambda block: (block.period, block.samples.size)):
            group = list(alike)
            offsets = np.rint(np.arange(size) * (period * NANOSECONDS)).astype(np.int64)
            starts = np.array([block.stamp for block in group], dtype=np.int64)
            samples = np.concatenate([block.samples for block in group])
            self._buffers[Quantity.VIBRATION].add((starts[:, None] + offsets).ravel(), samples.reshape(-1, 1))

    def complete(self) -> Iterator[Period]:
        """Yield every period that has become complete on all inputs that the joint needs; oldest first."""
        self._unpack_blocks()
        yield from iter(self._timeline.next, None)

    def rest(self) -> Iterator[Period]:
        """Yield what is left, complete or not: for the end of a recording."""
        yield from iter(self._timeline.rest, None)

    @property
    def out_of_order(self) -> int:
        """Vibration samples that came late."""
        vibration = self._buffers[Quantity.VIBRATION]
        return vibration.late + vibration.disordered

    @property
    def dropped(self) -> int:
        """Samples of all inputs for which the buffers had no room."""
        return sum(buffer.dropped for buffer in self._buffers.values())

    @property
    def clock_jumps(self) -> int:
        """Jumps of the stamps."""
        return sum(buffer.jumps for buffer in self._buffers.values())


def _overlap(last: Block, block: Block) -> bool:
    """Whether a block covers the time of the last one and does not continue it."""
    duration = max(each.period * each.samples.size for each in (last, block)) * NANOSECONDS
    return block.sequence != last.sequence + 1 and abs(block.stamp - last.stamp) < _OVERLAP * duration

"""Stamped samples of one input, in the order they came, until the time they belong to is complete.

Only the input's own stamps decide what is late or a jump of the clock, never how messages of several inputs interleave:
that makes a replay equal to the live run.
"""

from collections import deque
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray

LATENESS = 50_000_000
"""A sample may come this long [ns] after a later one and is still sorted in."""

CLOCK_JUMP = 1_000_000_000
"""A stamp further back than this [ns] is an outlier or a clock that was set back, not a late message."""

LEAP = 10_000_000_000
"""A stamp further ahead than this [ns] is an outlier or the end of a long pause."""

TRUSTED = 1_000_000_000
"""Stamps elsewhere are accepted once they have continued for this long [ns]; until then they may be outliers."""

MOST_AT_ONCE = 5000
MOST_A_SECOND = 200_000
"""Samples that a buffer holds whatever their stamps, and further ones for each second that they span: twice as many as
the fastest sensor sends. Stamps that stand still must not fill the memory."""

MOST_EPOCHS = 8
"""Jumps of the clock, less one, that may wait for the other inputs to follow."""


class Samples(NamedTuple):
    """Stamps [ns], shape (N,), and values, shape (N, columns), in the order of arrival."""

    stamps: IntArray
    values: FloatArray


class _Chunk(NamedTuple):
    """Samples that were added together; `ordered` is true if their stamps are known never to fall."""

    stamps: IntArray
    values: FloatArray
    ordered: bool

    def split(self, until: int) -> tuple["_Chunk | None", "_Chunk | None"]:
        """Return the samples stamped before `until` [ns], and the others."""
        stamps, values, ordered = self
        if ordered:
            count = int(stamps.searchsorted(until))
            early: slice | BoolArray = slice(count)
            late: slice | BoolArray = slice(count, None)
        else:
            early = stamps < until
            late, count = ~early, int(np.count_nonzero(early))
        if count == stamps.size:
            return self, None
        if not count:
            return None, self
        return _Chunk(stamps[early], values[early], ordered), _Chunk(stamps[late], values[late], ordered)


@dataclass(slots=True)
class _Epoch:
    """What came between two jumps of the clock."""

    chunks: list[_Chunk] = field(default_factory=list)
    newest: int | None = None
    oldest: int | None = None
    size: int = 0


class StampedBuffer:
    """Buffer of one input.

    Parameters
    ----------
    columns : int
        Values per sample.

    Attributes
    ----------
    late, disordered, jumps, dropped : int
        Samples dropped because they came too late, samples that came late but in time, jumps of the clock, and samples
        dropped because the buffer was full.
    """

    def __init__(self, columns: int) -> None:
        self._columns = columns
        self._epochs: deque[_Epoch] = deque([_Epoch()])
        self._suspects: list[Samples] = []
        self._suspected = 0  # samples in these
        self._standing = 0  # samples held whose stamp is the newest one again
        self.late = 0
        self.disordered = 0
        self.jumps = 0
        self.dropped = 0

    def add(self, stamps: IntArray, values: FloatArray) -> None:
        """Append samples: stamps [ns] of shape (N,), values of shape (N, columns)."""
        if not stamps.size:
            return
        steps = stamps[1:] - stamps[:-1]
        first, newest = int(stamps[0]), self._epochs[-1].newest
        near = newest is None or newest <= first <= newest + LEAP
        if near and not self._suspects and (not steps.size or (steps.min() >= 0 and steps.max() <= LEAP)):
            self._append(self._epochs[-1], _Chunk(stamps, values, ordered=True))  # the common case
            return
        bounds = [0, *(np.flatnonzero(np.abs(steps) > CLOCK_JUMP) + 1).tolist(), stamps.size]
        for start, stop in pairwise(bounds):
            self._add_piece(Samples(stamps[start:stop], values[start:stop]))

    def _add_piece(self, piece: Samples) -> None:
        """Append samples without a leap among them: one stray stamp must not reset the clock."""
        epoch, first = self._epochs[-1], int(piece.stamps[0])
        if epoch.newest is None or -CLOCK_JUMP <= first - epoch.newest <= LEAP:
            if self._suspects:  # the clock is back where it was: the leap was an outlier
                self.jumps += 1
                self._drop_suspects()
            self._append_in_time(epoch, piece)
            return
        last = int(self._suspects[-1].stamps[-1]) if self._suspects else first
        if not -CLOCK_JUMP <= first - last <= LEAP:
            self._drop_suspects()
        since = int(self._suspects[0].stamps[0]) if self._suspects else first
        span = int(piece.stamps[-1]) - since
        if not (room := self._room(self._suspected, span, piece.stamps.size)):
            return
        self._suspects.append(Samples(piece.stamps[:room], piece.values[:room]))
        self._suspected += room
        if span >= TRUSTED:
            suspects, self._suspects, self._suspected = self._suspects, [], 0
            if first < epoch.newest:
                self.jumps += 1
                self._epochs.append(_Epoch())
                if len(self._epochs) > MOST_EPOCHS:
                    self.dropped += self._epochs[1].size
                    del self._epochs[1]
            for suspect in suspects:
                self._append_in_time(self._epochs[-1], suspect)

    def _drop_suspects(self) -> None:
        self.late += self._suspected
        self._suspects, self._suspected = [], 0

    def _append_in_time(self, epoch: _Epoch, piece: Samples) -> None:
        stamps, values = piece
        newest = epoch.newest if epoch.newest is not None else int(stamps[0])
        before = np.maximum.accumulate(np.concatenate([[newest], stamps]))[:-1]
        behind = before - stamps
        keep = behind <= LATENESS
        self.late += int(stamps.size - keep.sum())
        self.disordered += int((behind[keep] > 0).sum())
        if keep.any():
            self._append(epoch, _Chunk(stamps[keep], values[keep], ordered=False))

    def _append(self, epoch: _Epoch, chunk: _Chunk) -> None:
        stamps, values, ordered = chunk
        low, high = (int(stamps[0]), int(stamps[-1])) if ordered else (int(stamps.min()), int(stamps.max()))
        if standing := low == high == epoch.newest:
            room = self._room(self._standing, 0, stamps.size)
        else:
            oldest = low if epoch.oldest is None else min(low, epoch.oldest)
            room = self._room(epoch.size, high - oldest, stamps.size)
        self._standing = self._standing + room if standing else 0
        if room:
            whole = room == stamps.size
            epoch.chunks.append(chunk if whole else _Chunk(stamps[:room].copy(), values[:room].copy(), ordered))
        epoch.size += room
        epoch.newest = high if epoch.newest is None else max(high, epoch.newest)
        epoch.oldest = low if epoch.oldest is None else min(low, epoch.oldest)

    def _room(self, held: int, span: int, wanted: int) -> int:
        """Return how many of `wanted` samples fit to those held, which span a time [ns] together; count the others."""
        most = MOST_AT_ONCE + max(span, 0) * MOST_A_SECOND // 1_000_000_000
        room = max(0, min(wanted, most - held))
        self.dropped += wanted - room
        return room

    @property
    def complete_until(self) -> int | None:
        """Time [ns] before which nothing more will be accepted; None before the first sample."""
        newest = self._epochs[0].newest
        return None if newest is None else newest - LATENESS

    @property
    def newest(self) -> int | None:
        """Latest stamp [ns] since the last jump of the clock that was passed."""
        return self._epochs[0].newest

    @property
    def oldest(self) -> int | None:
        """Earliest stamp [ns] of the samples still here."""
        return self._epochs[0].oldest

    @property
    def jumped(self) -> bool:
        """Whether the clock was set back after the samples that are handed out now."""
        return len(self._epochs) > 1

    @property
    def seconds_after_jump(self) -> float:
        """Time [s] covered by samples that came after the clock was set back."""
        if not self.jumped:
            return 0.0
        newest, oldest = self._epochs[1].newest, self._epochs[1].oldest
        return 0.0 if newest is None or oldest is None else (newest - oldest) * 1e-9

    def pass_jump(self) -> None:
        """Continue with what came after the clock was set back."""
        if self.jumped:
            self._epochs.popleft()

    def take(self, until: int) -> Samples:
        """Remove and return the samples stamped before `until` [ns], in the order of arrival."""
        epoch = self._epochs[0]
        taken: list[_Chunk] = []
        left: list[_Chunk] = []
        for chunk in epoch.chunks:
            early, late = chunk.split(until)
            if early is not None:
                taken.append(early)
            if late is not None:
                left.append(late)
        epoch.chunks = left
        epoch.size = sum(chunk.stamps.size for chunk in left)
        epoch.oldest = min((_oldest(chunk) for chunk in left), default=None)
        if not taken:
            return Samples(np.empty(0, dtype=np.int64), np.empty((0, self._columns)))
        if len(taken) == 1:
            return Samples(taken[0].stamps, taken[0].values)
        return Samples(np.concatenate([c.stamps for c in taken]), np.concatenate([c.values for c in taken]))

    def peek_first(self) -> Samples:
        """Return the earliest sample still here without removing it, or none."""
        chunks = self._epochs[0].chunks
        if not chunks:
            return Samples(np.empty(0, dtype=np.int64), np.empty((0, self._columns)))
        first = min(chunks, key=_oldest)
        place = 0 if first.ordered else int(np.argmin(first.stamps))
        return Samples(first.stamps[place : place + 1], first.values[place : place + 1])


def _oldest(chunk: _Chunk) -> int:
    return int(chunk.stamps[0] if chunk.ordered else chunk.stamps.min())

"""The simulation paced by a clock: which messages are due."""

from collections.abc import Iterator

from hd_monitor.contract import NANOSECONDS

from ..simulation import Simulation, Stretch


class Stream:
    """Hands out a simulation's messages when they are due, `scale` simulated seconds in one second of the clock.

    Attributes
    ----------
    epoch : int
        Stamp [ns] of the simulation's start; after a pause it has moved by the pause.
    running : bool
        Whether it has been started and not paused since.
    ended : bool
        Whether the last message has been handed out.
    """

    def __init__(self, simulation: Simulation, scale: float) -> None:
        self._scale = scale
        self._anchor = (0.0, 0)  # clock [s] and simulated time [ns] from which the pace counts
        self._sent = 0  # simulated time [ns] of the newest message
        self._messages = (
            (due, stretch, topic, row) for stretch in simulation for due, topic, row in stretch.schedule()
        )
        self._waiting: tuple[int, Stretch, str, int] | None = None
        self.epoch = 0
        self.running = False
        self.ended = False

    @property
    def position(self) -> float:
        """Simulated time of the newest message [s]."""
        return self._sent / NANOSECONDS

    def start(self, clock: float, stamp: int) -> None:
        """Start, or continue after a pause, at `clock` [s]; messages of this moment are stamped `stamp` [ns]."""
        self._anchor = (clock, self._sent)
        self.epoch = stamp - self._sent
        self.running = True

    def pause(self) -> None:
        """Stop the simulated time until the next start."""
        self.running = False

    def set_scale(self, scale: float, clock: float) -> None:
        """Change the pace from `clock` [s] on."""
        # A backlog of more than a second is dropped, not caught up with.
        self._anchor = (clock, min(self._target(clock), self._sent + NANOSECONDS))
        self._scale = scale

    def lag(self, clock: float) -> float:
        """Seconds of the clock by which the newest message handed out is behind what is due."""
        if self.ended:
            return 0.0
        due = self._sent if self._waiting is None else self._waiting[0]
        return max(0.0, (self._target(clock) - due) / NANOSECONDS / self._scale)

    def due(self, clock: float) -> Iterator[tuple[Stretch, str, int]]:
        """Yield (stretch, topic, row) of the messages due at `clock` [s] that were not handed out before."""
        if not self.running:
            return
        target = self._target(clock)
        while True:
            if self._waiting is None:
                self._waiting = next(self._messages, None)
                if self._waiting is None:
                    self.ended = True
                    return
            due, stretch, topic, row = self._waiting
            if due > target:
                return
            self._waiting, self._sent = None, due
            yield stretch, topic, row

    def _target(self, clock: float) -> int:
        start, simulated = self._anchor
        return simulated + round((clock - start) * self._scale * NANOSECONDS)

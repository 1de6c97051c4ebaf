"""Replay: a recording's messages through the same monitors, by the same path, as in the node."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ..adapters import Inputs
from ..assessment import Assessment
from ..contract import NANOSECONDS
from ..evidence import SomeIdentifier
from ..history.rating import Baseline
from ..monitor import Monitor
from .bag import Bag
from .batches import Window
from .plan import JointPlan


class Replayed(NamedTuple):
    """What a monitor said, and of which joint."""

    plan: JointPlan
    assessment: Assessment
    last: bool = False
    """True for what a node would show at the recording's end; it may repeat the one before."""


class _Channel:
    """One joint's monitor with its inputs."""

    def __init__(self, plan: JointPlan, identifier: SomeIdentifier | None, baseline: Baseline | None) -> None:
        self.plan = plan
        self.monitor = Monitor(plan.settings, identifier)
        self.monitor.baseline = baseline
        self._inputs = Inputs(plan.joint, plan.settings, self.monitor)
        self._timeout = round(plan.settings.input.timeout * NANOSECONDS)
        self._heard: int | None = None

    def feed(self, window: Window) -> Iterator[Replayed]:
        """Hand over a window's messages; yield what the monitor says to them."""
        messages = {q: window.messages[topic] for q, topic in self.plan.topics.items() if topic in window.messages}
        if not messages:
            return
        if self._heard is not None and window.start - self._heard >= self._timeout:
            yield Replayed(self.plan, self.monitor.silence(self._heard + self._timeout))
        self._heard = window.end
        for quantity, new in messages.items():
            self._inputs.add(quantity, new)
        for assessment in self.monitor.advance():
            yield Replayed(self.plan, assessment)

    def finish(self) -> Replayed:
        """Return what a node would show at the end."""
        # Without any usable input the monitor has nothing to assess, but knows what it had to reject.
        assessment = self.monitor.finish() or self.monitor.silence((self._heard or 0) + self._timeout)
        return Replayed(self.plan, assessment, last=True)


def replay(
    bag: Bag,
    plans: Sequence[JointPlan],
    progress: Callable[[Window], None] | None = None,
    identifiers: Mapping[str, SomeIdentifier] | None = None,
    baselines: Mapping[str, Baseline | None] | None = None,
) -> Iterator[Replayed]:
    """Put a recording through one monitor a joint, as fast as the machine allows.

    Parameters
    ----------
    bag : Bag
    plans : sequence of JointPlan
    progress : callable, optional
        Called with each window of messages after it has been fed.
    identifiers : mapping of str to Identifier or SensorlessIdentifier, optional
        By joint, those that go on with what they know from earlier recordings.
    baselines : mapping of str to Baseline, optional
        By joint, the lines as they should be, as far as they are known.

    Yields
    ------
    Replayed
        Every assessment in the order of the stamps, joint by joint within some thousand messages; then each joint's
        last one.
    """
    known, sound = identifiers or {}, baselines or {}
    channels = [_Channel(plan, known.get(plan.joint), sound.get(plan.joint)) for plan in plans]
    topics = {topic for plan in plans for topic in plan.topics.values()}
    pause = min(round(plan.settings.input.timeout * NANOSECONDS) for plan in plans)
    for window in bag.windows(topics, pause=pause):
        for channel in channels:
            yield from channel.feed(window)
        if progress is not None:
            progress(window)
    for channel in channels:
        yield channel.finish()

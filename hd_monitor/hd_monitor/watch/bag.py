"""The source for a recording: its inputs go through the same core as in the node, or its own statuses are shown."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from dataclasses import replace
from pathlib import Path
from typing import Protocol

from .. import contract
from ..assessment import Assessment
from ..cdr import Diagnostics, ReceivedStatus, decode_diagnostics
from ..diagnosis.status import Status, input_status_of, status_of
from ..errors import LayoutError
from ..offline.bag import Bag
from ..offline.plan import Request, plan
from ..offline.replay import replay
from .curves import NAMES, Curve, curve_from, curve_of, topic_of
from .state import Key, View

_AT_ONCE = 0.1
"""Seconds of work between two looks at the keyboard; a window of messages is judged without one."""
_NEEDED = "sensor_msgs/msg/JointState"
"""Type of topic without which nothing can be replayed."""


class BagSource:
    """Reads a recording piece by piece, so that the screen lives meanwhile.

    Parameters
    ----------
    path : Path
    request : Request

    Raises
    ------
    BagError, ParameterError
        If it can neither be replayed nor holds statuses.
    """

    pause = 0.02

    def __init__(self, path: Path, request: Request) -> None:
        with ExitStack() as stack:
            self._bag = stack.enter_context(Bag(path, request.chunk_limit))
            types = {topic.name: topic.type for topic in self._bag.topics if topic.messages}
            recorded = _NEEDED not in types.values() and contract.DIAGNOSTICS in types
            self._what = "recorded statuses" if recorded else "replayed"
            self._work: _Work = (
                _Recorded(self._bag, set(types), self._note) if recorded else _Replay(self._bag, request, self._note)
            )
            self._stack = stack.pop_all()  # nothing has failed: the recording stays open
        self._statuses = iter(self._work)
        self._read = 0.0

    def begin(self) -> View:
        """Return the view of nothing yet."""
        return View(
            source=f"{self._bag.path.name}, {self._what}",
            awaiting="Wait: the recording is being read",
            live=False,
            progress=0.0,
        )

    def update(self, view: View, now: float) -> View:
        """Read on for a while."""
        view = replace(view, now=now)
        if view.progress == 1.0:
            return view
        until, ended = time.monotonic() + _AT_ONCE, True
        for message in self._statuses:
            view = view.with_diagnostics(message)
            self._note(message.stamp)
            if time.monotonic() > until:
                ended = False
                break
        view = view.with_curves(self._work.curves(view))
        return replace(view, progress=1.0 if ended else self._read, notes=tuple(self._bag.notes))

    def _note(self, instant: int) -> None:
        """Note how far the recording has been read: to this time [ns], if it is one of the recording."""
        first, last = self._bag.span or (0, 0)
        if first < instant <= last:
            # A little is left until the end has been judged.
            self._read = max(self._read, min((instant - first) / (last - first), 0.99))

    def close(self) -> None:
        """Close the recording."""
        self._stack.close()


class _Work(Protocol):
    def __iter__(self) -> Iterator[Diagnostics]: ...

    def curves(self, view: View) -> list[tuple[Key, str, Curve]]: ...


class _Replay:
    """The recorded inputs through one monitor a joint."""

    def __init__(self, bag: Bag, request: Request, note: Callable[[int], None]) -> None:
        self._bag, self._note = bag, note
        self._plans = plan(bag, request)
        self._newest: dict[Key, Assessment] = {}

    def __iter__(self) -> Iterator[Diagnostics]:
        node = self._bag.path.name
        for said in replay(self._bag, self._plans, lambda window: self._note(window.end)):
            joint, assessment = said.plan.joint, said.assessment
            self._newest[Key(node, joint)] = assessment
            both = (status_of(assessment, joint), input_status_of(assessment, joint))
            yield Diagnostics(assessment.stamp, tuple(_received(status, node) for status in both))

    def curves(self, view: View) -> list[tuple[Key, str, Curve]]:
        """Return the newest curves of the joints heard of since the last call."""
        found = []
        for key, assessment in self._newest.items():
            if zoom := assessment.zoom:
                found.append((key, contract.ZOOM_SPECTRUM, curve_of(zoom.frequencies, zoom.amplitude)))
            rpm, rms = [point.rpm for point in assessment.rms_curve], [point.rms for point in assessment.rms_curve]
            found.append((key, contract.RMS_CURVE, curve_of(rpm, rms)))
        self._newest = {}
        return found


class _Recorded:
    """The recorded statuses, with the curves recorded beside them."""

    def __init__(self, bag: Bag, topics: set[str], note: Callable[[int], None]) -> None:
        self._bag, self._note = bag, note
        self._topics = {topic for topic in topics if topic.endswith(tuple(f"/{name}" for name in NAMES))}
        self._newest: dict[str, bytes] = {}

    def __iter__(self) -> Iterator[Diagnostics]:
        for window in self._bag.windows([contract.DIAGNOSTICS, *sorted(self._topics)]):
            self._newest |= {topic: window.messages[topic][-1] for topic in self._topics & set(window.messages)}
            for message in window.messages.get(contract.DIAGNOSTICS, ()):
                try:
                    yield decode_diagnostics(message)
                except LayoutError:
                    continue  # damaged, as the rest of the recording need not be
            self._note(window.end)

    def curves(self, view: View) -> list[tuple[Key, str, Curve]]:
        """Return the newest curves of the joints that are known."""
        found = []
        for key in view.joints:
            for name in NAMES:
                if topic := topic_of(self._newest, key.node, key.joint, name):
                    with suppress(LayoutError):  # another program's topic has the same name
                        found.append((key, name, curve_from(self._newest[topic], name)))
        return found


def _received(status: Status, node: str) -> ReceivedStatus:
    return ReceivedStatus(
        f"{node}: {status.subject}", status.level, status.message, status.hardware_id, dict(status.values)
    )

"""Hostile inputs and the check that a reader survives them: only the project's own errors, bounded time and memory.

Every run of the tests tries the same few thousand inputs; ``coverage_guided.py`` tries a million others.
"""

import os
import signal
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hd_monitor.errors import HdMonitorError

PROCESSOR_SECONDS = 5.0
"""Processor time that one input may take [s]: a guard against endless work, not a measure of speed."""
MEMORY = 256 * 2**20
"""Memory that one input may add [bytes]; no input here holds more than some kilobytes."""

_STATUS, _CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
_TREACHEROUS = (0, 1, 0x7F, 0x80, 0xFF, 0x7FFF_FFFF, 0x8000_0000, 0xFFFF_FFFF, 2**63 - 1, 2**63, 2**64 - 1)


class EndlessWork(BaseException):
    """An input took longer than it may; no ``except Exception`` of the code under test swallows it."""


def damaged(*whole: bytes) -> st.SearchStrategy[bytes]:
    """Strategy of inputs that were whole once: bytes changed, cut out, doubled, set to treacherous numbers."""
    place = st.floats(0.0, 1.0, exclude_max=True)
    number = st.tuples(st.sampled_from(_TREACHEROUS), st.sampled_from((1, 2, 4, 8))).map(
        lambda drawn: (drawn[0] % 2 ** (8 * drawn[1])).to_bytes(drawn[1], "little")
    )
    change = st.tuples(st.sampled_from(("set", "insert", "cut", "double")), place, st.binary(max_size=8) | number)
    return st.builds(_change, st.sampled_from(whole), st.lists(change, min_size=1, max_size=6)) | st.binary(max_size=64)


def _change(data: bytes, changes: list[tuple[str, float, bytes]]) -> bytes:
    for kind, place, new in changes:
        at = int(place * len(data))
        match kind:
            case "set":
                data = data[:at] + new + data[at + len(new) :]
            case "insert":
                data = data[:at] + new + data[at:]
            case "cut":
                data = data[:at] + data[at + 1 + int(place * 997) % len(data) :] if data else data
            case "double":
                data = data[:at] + data[at : at + 64] + data[at:]
    return data


def survive[T](reader: Callable[[T], object], inputs: st.SearchStrategy[T], *, weight: int = 1) -> None:
    """Give a reader inputs, `weight` times as many as the profile of hypothesis says.

    Raises
    ------
    Exception
        Whatever the reader raised for the smallest input found, unless it is an error of the project.
    AssertionError
        If an input took more memory than `MEMORY`.
    EndlessWork
        If an input took more processor time than `PROCESSOR_SECONDS`.
    """

    @settings(max_examples=weight * settings().max_examples, suppress_health_check=list(HealthCheck))
    @given(inputs)
    def check(value: T) -> None:
        with bounded(), suppress(HdMonitorError):
            reader(value)

    check()


@contextmanager
def bounded() -> Iterator[None]:
    """Limit processor time and memory of what is done within."""
    former = signal.signal(signal.SIGVTALRM, _stop)
    _CLEAR.write_text("5")  # forgets the peak so far
    before = _resident("VmRSS")
    signal.setitimer(signal.ITIMER_VIRTUAL, PROCESSOR_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, former)
    taken = _resident("VmHWM") - before
    assert taken < MEMORY, f"an input took {taken / 2**20:.0f} MiB of memory"


def _stop(_signal: int, _frame: FrameType | None) -> None:
    raise EndlessWork(f"an input took more than {PROCESSOR_SECONDS:g} s of processor time in process {os.getpid()}")


def _resident(key: str) -> int:
    """Read resident memory [bytes], now (VmRSS) or at its peak (VmHWM)."""
    (line,) = (line for line in _STATUS.read_text().splitlines() if line.startswith(key))
    return int(line.split()[1]) * 1024


def trusts_a_count(data: bytes) -> None:
    """Believe a number in the input: a fault that the check must find."""
    if len(data) >= 8:
        struct.unpack_from("<I", data, struct.unpack_from("<I", data, 4)[0])

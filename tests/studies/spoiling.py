"""Ways to spoil a simulated rig's messages and bags, beyond those that the simulator offers as parameters."""

import math
import struct
from collections.abc import Callable, Sequence

import numpy as np

from hd_monitor.arrays import FloatArray
from hd_monitor.contract import NANOSECONDS

BLOCK_SIZE = 50
"""Samples in a block of the simulator."""

Change = Callable[[int, bytes], Sequence[bytes]]
"""Turns the message of this number [from 0] into what is sent in its place."""


def samples(change: Callable[[FloatArray, int], object]) -> Change:
    """Change the samples of blocks in place, given with the block's number."""
    return _numbers(lambda data: np.frombuffer(data, "<f8", BLOCK_SIZE, len(data) - 8 * BLOCK_SIZE), change)


def joint(change: Callable[[FloatArray, int], object]) -> Change:
    """Change (position, velocity, effort) of joint states in place, given with the message's number."""
    return _numbers(lambda data: np.frombuffer(data, "<f8", 5, len(data) - 40)[::2], change)  # between them counts


def _numbers(view: Callable[[bytearray], FloatArray], change: Callable[[FloatArray, int], object]) -> Change:
    def changed(number: int, data: bytes) -> Sequence[bytes]:
        copy = bytearray(data)
        change(view(copy), number)
        return [bytes(copy)]

    return changed


def stamp(change: Callable[[int, int], int]) -> Change:
    """Change the stamp [ns] of joint states, given with the message's number."""

    def changed(number: int, data: bytes) -> Sequence[bytes]:
        seconds, nanoseconds = struct.unpack_from("<iI", data, 4)
        return [
            data[:4]
            + struct.pack("<iI", *divmod(change(seconds * NANOSECONDS + nanoseconds, number), NANOSECONDS))
            + data[12:]
        ]

    return changed


def until(second: float, rate: float, then: Callable[[bytes], Sequence[bytes]] = lambda _: []) -> Change:
    """Leave messages of this rate [Hz] alone until a time [s]; then drop them, unless told otherwise."""
    return lambda number, data: [data] if number < second * rate else then(data)


def replaced(old: bytes, new: bytes) -> Change:
    """Replace bytes in each message."""
    return lambda _, data: [data.replace(old, new)]


def joint_twice(_: int, data: bytes) -> Sequence[bytes]:
    """Name the joint twice, the second time with other values."""
    names = struct.pack("<II6s2xI6s2x", 2, 6, b"joint", 6, b"joint")
    position, velocity, effort = (
        struct.pack("<dd", value, value + 1.0) for value in struct.unpack_from("<d8xd8xd", data, len(data) - 40)
    )
    count, padding = struct.pack("<I", 2), bytes(4)
    return [data[:20] + names + count + position + count + padding + velocity + count + padding + effort]


def second_publisher(number: int, data: bytes) -> Sequence[bytes]:
    """Send each block once more with samples of another sensor, as a second publisher of the topic does."""
    return [data, *samples(lambda values, _: np.negative(values, out=values))(number, data)]


def half_a_period_later(number: int, data: bytes) -> Sequence[bytes]:
    """Send each single sample of 1 kHz once more half a period later with the values of another sensor."""
    (later,) = stamp(lambda time, _: time + NANOSECONDS // 2000)(number, data)
    values = np.frombuffer(later, "<f8", 6, len(later) - 48)
    return [data, later[:-48] + (-0.5 * values).tobytes()]


def mains(values: FloatArray, number: int) -> None:
    values += 3.0 * np.cos(math.tau * 50.0 * (number * BLOCK_SIZE + np.arange(BLOCK_SIZE)) / 1000.0)


def not_a_number(values: FloatArray, _: int) -> None:
    values[:] = math.nan


def hole(values: FloatArray, number: int) -> None:
    values[number % BLOCK_SIZE] = math.nan


def degrees(values: FloatArray, _: int) -> None:
    values[:2] = np.degrees(values[:2])


def jumping(values: FloatArray, number: int) -> None:
    values[0] += number % 7


def cut(content: bytearray) -> bytes:
    return bytes(content[: len(content) * 2 // 3])


def scratched(content: bytearray) -> bytes:
    content[len(content) // 2 : len(content) // 2 + 200] = b"\xff" * 200
    return bytes(content)

"""What the buffer behind the snapshots takes for a joint: memory, and processor time a message.

python tests/benchmarks/snapshot_cost.py
"""

import time
import tracemalloc
from collections.abc import Callable, Iterator, Mapping

from hd_monitor.history.snapshot import SECONDS, RecentMessages
from hd_monitor.sources import Quantity

DRAINS = 20
"""Looks into the queues in a second."""
BLOCK, SAMPLE, IMU, STATE = 8 * 54 + 60, 124, 340, 300
"""Bytes of a serialised block of 50 samples, of an AccelStamped, of an Imu, and of joint states of six joints."""
RATES = {"blocks of 1 kHz": (20, BLOCK), "single samples of 1 kHz": (1000, SAMPLE), "an IMU of 1 kHz": (1000, IMU)}


def batches(rate: int, size: int) -> Iterator[Mapping[Quantity, list[bytes]]]:
    """Yield what two minutes of messages bring, look by look."""
    for _ in range(2 * SECONDS * DRAINS):
        vibration = [bytes(size) for _ in range(rate // DRAINS)]
        yield {Quantity.VIBRATION: vibration, Quantity.MOTION: [bytes(STATE) for _ in range(5)]}


def held(rate: int, size: int) -> float:
    """Bytes that the buffer holds after two minutes."""
    tracemalloc.start()
    recent = RecentMessages()
    for look, messages in enumerate(batches(rate, size)):
        recent.add(look * 1_000_000_000 // DRAINS, messages)
    del messages
    size = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    return size


def spent(rate: int, size: int) -> float:
    """Processor time of a second's messages [s]."""
    recent, looks = RecentMessages(), list(batches(rate, size))
    start = time.process_time()
    for look, messages in enumerate(looks):
        recent.add(look * 1_000_000_000 // DRAINS, messages)
    return (time.process_time() - start) / (2 * SECONDS)


def main(show: Callable[[str], None] = print) -> None:
    """Print a row for each form of the vibration."""
    show("| vibration | held for a joint | of one processor |\n|---|---|---|")
    for name, (rate, size) in RATES.items():
        show(f"| {name} | {held(rate, size) / 1e6:.1f} MB | {100 * spent(rate, size):.3f} % |")


if __name__ == "__main__":
    main()

"""How a process of ours treats its machine: both nodes and hd-monitor begin with this."""

import os


def set_up_process() -> None:
    """Keep linear algebra on one thread, and freed memory mapped; call it before numpy is imported.

    Matrices of a few dozen columns gain nothing by a second thread, and on a processor that has other work, as a
    robot's does, the threads wait for each other: a replay then takes three times as long. One thread also makes the
    last digits, and with them a verdict, independent of the number of cores. ``OPENBLAS_NUM_THREADS`` in the
    environment has the last word. To see what more threads cost, set it to 2 and run
    ``tests/benchmarks/replay_speed.py``.

    The C library of Linux gives back to the system what an array of more than 128 kB occupied, and the next array has
    its pages mapped and cleared again. It stops doing so for sizes of which one has been freed before.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    bytes(8_000_000)  # freed at once, and never touched; the arrays of a stretch have up to a few million bytes

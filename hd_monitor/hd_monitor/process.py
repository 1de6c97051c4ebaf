"""How many threads linear algebra may take: one, in both nodes and in hd-monitor."""

import os

_VARIABLE = "OPENBLAS_NUM_THREADS"


def use_one_thread() -> None:
    """Keep linear algebra on one thread, unless the environment says otherwise; call it before numpy is imported.

    Matrices of a few dozen columns gain nothing by a second thread, and on a processor that has other work, as a
    robot's does, the threads wait for each other: a replay then takes three times as long. One thread also makes the
    last digits, and with them a verdict, independent of the number of cores. To see what more threads cost, set
    ``OPENBLAS_NUM_THREADS=2`` and run ``tests/benchmarks/replay_speed.py``.
    """
    os.environ.setdefault(_VARIABLE, "1")

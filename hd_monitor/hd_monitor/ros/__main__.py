"""The executable ``hd_monitor_node``."""

import sys
from collections.abc import Callable

from ..offline.parameters import check_files
from ..process import guard, set_up_process


def main(args: list[str] | None = None) -> int:
    """Run the node; return its exit status."""
    set_up_process()

    def load() -> Callable[[], int]:
        check_files(sys.argv if args is None else args, "--params-file")
        from .node import main as run  # imports numpy

        return lambda: run(args)

    return guard("hd_monitor_node", load)


if __name__ == "__main__":
    sys.exit(main())

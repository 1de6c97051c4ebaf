"""The executable ``hd_monitor_node``."""

import sys

from ..process import set_up_process


def main(args: list[str] | None = None) -> int:
    """Run the node; return its exit status."""
    set_up_process()
    from .node import main as run  # imports numpy

    return run(args)


if __name__ == "__main__":
    sys.exit(main())

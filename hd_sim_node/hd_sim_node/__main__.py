"""The executable ``hd_sim_node``."""

import sys

from hd_monitor.threads import use_one_thread


def main(args: list[str] | None = None) -> int:
    """Run the node; return its exit status."""
    use_one_thread()
    from .node import main as run  # it brings numpy along

    return run(args)


if __name__ == "__main__":
    sys.exit(main())

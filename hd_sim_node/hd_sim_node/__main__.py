"""The executable ``hd_sim_node``."""

import sys

from hd_monitor.process import guard, set_up_process


def main(args: list[str] | None = None) -> int:
    """Run the node; return its exit status."""
    set_up_process()

    def work() -> int:
        from .node import main as run  # imports numpy

        return run(args)

    return guard("hd_sim_node", work)


if __name__ == "__main__":
    sys.exit(main())
